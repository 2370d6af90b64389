"""python3 -m analysis.studies.documents PDF: writes gallery/README.md and paper.md, and the paper as a PDF. Exit status: 0, or 2 with one
line on stderr."""

import sys
from pathlib import Path

from ...commands import FAILED, complain
from ...report.pdf import NoPdf
from ...runs.arrays import RunFolderError
from ..analyse import NothingToAnalyse
from ..paper import PaperError
from . import write


def main(arguments):
    if len(arguments) != 1:
        complain("documents: must be called with the file of the PDF")
        return FAILED
    try:
        write(Path(arguments[0]))
    except OSError as error:
        complain(f"{error.filename or arguments[0]}: {error.strerror}")
    except NoPdf as error:
        complain(f"{arguments[0]}: {error}")
    except (NothingToAnalyse, PaperError, RunFolderError) as error:
        complain(error)
    else:
        return 0
    return FAILED


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
