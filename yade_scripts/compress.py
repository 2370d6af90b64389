"""Compress an aggregate in a periodic cell whose edges shrink, as in Kataoka et al. (2013), and write a run folder.

    yade -n -x yade_scripts/compress.py                      1024 grains of ice, to a filling of 0.5
    yade -n -x yade_scripts/compress.py grains=4096 seed=3   any parameter by its name
    yade -n -x yade_scripts/compress.py finalPressure=1e4    to a pressure [Pa]
    yade -n -x yade_scripts/compress.py finalFilling=0.3 stretch=x    and then stretched along x: tensile strength
    python3 yade_scripts/study.py compression-desk           all rows of a study's table
    yade -n -x yade_scripts/compress.py table=yade_scripts/studies/compression-desk.table:6    one of them
    yade -n -x yade_scripts/compress.py --help               the parameters

Numbers may be written as arithmetic: strainRate=3*10**-7. K13 is Kataoka et al. (2013), A22 Arakawa et al. (2022),
S17 Sirono & Ueno (2017), W07 Wada et al. (2007); t0 is the time unit of the contact.

Exit status, resume=1 and continue=FOLDER: as of collide.py.
"""

import os
import signal
import sys

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(sys.argv[0]))))  # the repository's top
from analysis.startup import end_quietly, require_libraries

end_quietly(signal.SIGINT)
require_libraries()
from yade_scripts.experiments.compression import KIND
from yade_scripts.run import script

if __name__ == "__main__":
    script.main(KIND, __doc__)
