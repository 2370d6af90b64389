"""Collide two dust aggregates and write a run folder.

    yade -n -x yade_scripts/collide.py                     Arakawa et al. (2024) at 20 grain radii
    yade -n -x yade_scripts/collide.py velocity=10 seed=3  any parameter by its name
    yade -n -x yade_scripts/collide.py table=yade_scripts/studies/seeds.table:4   one row of a table
    python3 yade_scripts/study.py yade_scripts/studies/seeds.table                all rows
    yade -n -x yade_scripts/collide.py --help              the parameters

Numbers may be written as arithmetic: velocity=10**0.5. A22 and A24 are Arakawa et al. (2022, 2024), S17 is
Sirono & Ueno (2017), W07 Wada et al. (2007); t0 is the time unit of the contact, K(0) the initial kinetic energy.

Exit status: 0 when the run came to its planned end, 2 for a wrong parameter (one line on stderr, and nothing was run),
1 when the run failed, 130 or 143 when Ctrl-C or SIGTERM stopped it. The last two leave a run folder that can be read,
with a checkpoint; a killed run leaves its last one. resume=1 resumes from it, and so does continue=FOLDER, which takes
all parameters from the run's folder; a run that is undecided goes on with duration=... beside.
"""

import os
import signal
import sys

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(sys.argv[0]))))  # the repository's top
from analysis.startup import end_quietly, require_libraries

end_quietly(signal.SIGINT)
require_libraries()
from yade_scripts.experiments.collision import KIND
from yade_scripts.run import script

if __name__ == "__main__":
    script.main(KIND, __doc__)
