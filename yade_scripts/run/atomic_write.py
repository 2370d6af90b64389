"""Files that are either whole or not there."""

import io
import os
import tempfile
from contextlib import suppress

UNFINISHED = ".unfinished"


def write_atomically(path, write, lasting=False):
    """Call write(binary file) in memory, put the bytes into a temporary file beside path, and rename it to path.

    A run that is killed in between leaves the file as it was before, never half a file. lasting: the file is on the disk
    when this returns, so that it outlives a power loss, too. Raises OSError, with the path, when it can't be written.
    """
    content = io.BytesIO()
    write(content)
    write_bytes_atomically(path, content.getbuffer(), lasting)


def write_bytes_atomically(path, content, lasting=False):
    """The same for bytes, or a buffer of them."""
    folder, name = os.path.split(os.path.abspath(path))
    try:
        handle, temporary = tempfile.mkstemp(prefix=f".{name}.", suffix=UNFINISHED, dir=folder)
        try:
            _write_all(handle, content, lasting)
            os.replace(temporary, path)
        except BaseException:
            with suppress(OSError):
                os.unlink(temporary)
            raise
        if lasting:
            sync(folder)
    except OSError as error:
        raise OSError(error.errno, error.strerror, str(path)) from None


def sync(path):
    """Have a file's content, or the names in a folder, on the disk; raises OSError."""
    handle = os.open(path, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)


def remove_unfinished(folder):
    """Remove the temporary files that a writer killed in between has left in a folder."""
    for name in os.listdir(folder):
        if is_unfinished(name):
            os.unlink(os.path.join(folder, name))


def is_unfinished(name):
    """Whether a file of this name is a temporary file of write_atomically."""
    return name.startswith(".") and name.endswith(UNFINISHED)


def _write_all(handle, content, lasting):
    """Write a buffer to an open file and close it."""
    try:
        left = memoryview(content).cast("B")
        while len(left):
            left = left[os.write(handle, left) :]
        os.fchmod(handle, 0o666 & ~_umask())  # mkstemp makes files that only their owner can read
        if lasting:
            os.fsync(handle)
    finally:
        os.close(handle)


def _umask():
    mask = os.umask(0)
    os.umask(mask)
    return mask
