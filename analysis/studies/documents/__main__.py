"""python3 -m analysis.studies.documents PDF: writes gallery/README.md and paper.md, and the paper as a PDF. Exit status: 0, or 2 with one
line on stderr."""

import sys
from pathlib import Path
from types import SimpleNamespace

from ...commands import FAILED, complain, in_one_line
from ...report.pdf import NoPdf
from . import write


def main(arguments):
    if len(arguments) != 1:
        complain("documents: must be called with the file of the PDF")
        return FAILED
    return in_one_line(SimpleNamespace(command=_write, out=Path(arguments[0])))


def _write(options):
    try:
        write(options.out)
    except NoPdf as error:
        raise NoPdf(f"{options.out}: {error}") from None
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
