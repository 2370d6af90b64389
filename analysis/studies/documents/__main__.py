"""python3 -m analysis.studies.documents PDF: writes gallery/README.md and paper.md, and the paper as a PDF."""

import sys
from pathlib import Path

from . import write

if __name__ == "__main__":
    write(Path(sys.argv[1]))
