"""In YADE: run a script (argv[2]) as YADE would, every JKRWadaEngine with the instruction set argv[1]."""

import os
import runpy
import sys

here = os.path.dirname(os.path.abspath(sys.argv[0]))
sys.path[:0] = [os.path.dirname(os.path.dirname(here)), os.path.dirname(here)]
instructions, script = sys.argv[1:3]
sys.argv = sys.argv[2:]
import contact_law

made = contact_law.JKRWadaEngine.__init__


def of_this_set(self, *arguments, **options):
    made(self, *arguments, **{"instructions": instructions, **options})


contact_law.JKRWadaEngine.__init__ = of_this_set
runpy.run_path(script, init_globals=globals(), run_name="__main__")
