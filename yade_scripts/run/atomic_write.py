"""Files that are either whole or not there."""

import os
import tempfile

UNFINISHED = ".unfinished"


def write_atomically(path, write):
    """Call write(binary file) on a temporary file beside path, then rename it to path.

    A run that is killed in between leaves the file as it was before, never half a file.
    Raises OSError when the folder can't be written.
    """
    folder, name = os.path.split(os.path.abspath(path))
    handle, temporary = tempfile.mkstemp(prefix="." + name + ".", suffix=UNFINISHED, dir=folder)
    try:
        with os.fdopen(handle, "wb") as file:
            write(file)
        os.chmod(temporary, 0o666 & ~_umask())  # mkstemp makes files that only their owner can read
        os.replace(temporary, path)
    except BaseException:
        os.unlink(temporary)
        raise


def remove_unfinished(folder):
    """Remove the temporary files that a writer killed in between has left in a folder."""
    for name in os.listdir(folder):
        if name.startswith(".") and name.endswith(UNFINISHED):
            os.unlink(os.path.join(folder, name))


def _umask():
    mask = os.umask(0)
    os.umask(mask)
    return mask
