"""The repository's top on the path, so that tests import yade_scripts as users' scripts do."""
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))))
