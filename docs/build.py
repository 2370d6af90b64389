"""Builds the site inside YADE: yade -n -x docs/build.py SPHINX-OPTIONS SOURCE TARGET, as make docs calls it."""

import sys

from sphinx.cmd.build import main

sys.exit(main(sys.argv[1:]))
