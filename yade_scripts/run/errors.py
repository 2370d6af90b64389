"""Wrong input ends a script with one line on stderr and exit status 2."""

import sys
from contextlib import contextmanager

from yade_scripts.packings.packing import PackingError
from yade_scripts.parameters import ParameterError
from yade_scripts.run.checkpoint import CheckpointError
from yade_scripts.run.folder import RunFolderError


@contextmanager
def one_line_errors(script):
    """Within it, an error of the user's input, or a plugin that isn't built, becomes one line and exit 2."""
    try:
        yield
    except (ParameterError, PackingError, RunFolderError, CheckpointError, ImportError, MemoryError) as error:
        sys.stderr.write(f'{script}: {" ".join(str(error).split()) or type(error).__name__}\n')
        sys.exit(2)
