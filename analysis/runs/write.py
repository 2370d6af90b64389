"""Writing files, the one way of the analysis and the scripts: a file is whole or not there, and no link is followed.

The bytes go into a temporary file beside the place, .NAME.XXXXXXXX.unfinished, and onto the disk; then it takes the name.
A process that is killed in between leaves the file as it was, and its temporary one to the next that writes in the folder,
which removes it.
"""

import errno
import functools
import os
import re
import secrets
import stat
from contextlib import contextmanager, suppress

from ..signals import held

try:
    from fcntl import LOCK_EX, LOCK_NB, flock
except ImportError:  # not of POSIX: as a file system without locks
    LOCK_EX = LOCK_NB = 0

    def flock(file, _how):
        raise OSError(errno.ENOSYS, os.strerror(errno.ENOSYS), file.name)


_UNFINISHED = re.compile(r"\..+\.[0-9a-f]{8}\.unfinished(\.\w+)?")
_NO_LINKS = (errno.EPERM, errno.EOPNOTSUPP, errno.ENOSYS, errno.EMLINK)
_KINDS = {stat.S_IFDIR: "folder", stat.S_IFIFO: "FIFO", stat.S_IFSOCK: "socket"}


def write_text(path, text, **how):
    """Write a file of text, in UTF-8; how: see replacing()."""
    write_bytes(path, text.encode(), **how)


def write_bytes(path, content, **how):
    """Write a file of bytes, or of a buffer of them; how: see replacing()."""
    with replacing(path, **how) as file:
        file.write(content)


@contextmanager
def replacing(path, within=None, lasting=True, ending=""):
    """A binary file, open for writing, that takes the place of `path` when the block has come to its end.

    A program that writes by itself may be given its .name, which ends in `ending` (".mp4"). within: the folder out of which no
    link may lead, by default that of `path`. lasting: the file outlives a power loss from then on. Raises OSError, with
    .filename, where it can't be written or require_file() refuses it.
    """
    path = os.fspath(path)
    folder = os.path.dirname(path) or os.curdir
    before = require_file(path, within)
    _tidy(os.path.realpath(folder))
    with _about(path), unfinished(path, ending) as file:
        yield file
        file.flush()
        if before and before.st_mode != os.stat(file.name).st_mode:
            os.chmod(file.name, stat.S_IMODE(before.st_mode))
        if lasting:
            sync(file.name)  # not by its number: another program may have made a file of its own
        os.replace(file.name, path)
        if lasting:
            sync(folder)


def require_file(path, within=None, inputs=()):
    """os.stat() of a path that may be written, None when nothing is there.

    Raises OSError, with .filename, for a folder, a device, a FIFO, a link out of the folder `within`, a file that is
    write-protected, and one of the `inputs` (paths): what is read is never written over.
    """
    path = os.fspath(path)
    folder = os.path.dirname(path) or os.curdir
    outer, place = os.path.realpath(within or folder), os.path.realpath(path)
    if os.path.commonpath([outer, place if os.path.islink(path) else os.path.realpath(folder)]) != outer:
        raise _refusal(path, "is a link, or behind one, that leads to another folder; must be a file")
    if place in map(os.path.realpath, inputs):
        raise _refusal(path, "is what is read; must be another file")
    try:
        found = os.stat(path)
    except FileNotFoundError:
        return None
    if not stat.S_ISREG(found.st_mode):
        raise _refusal(path, f"is a {_KINDS.get(stat.S_IFMT(found.st_mode), 'device')}; must be a file")
    if not os.access(path, os.W_OK):
        raise OSError(errno.EACCES, os.strerror(errno.EACCES), path)
    return found


def make_folder(path):
    """Make a folder, and those that it is in, unless it is there. Raises OSError, with .filename."""
    if os.path.lexists(path) and not os.path.isdir(path):
        raise _refusal(os.fspath(path), "is a file; must be a folder")
    os.makedirs(path, exist_ok=True)


def make_new(path, content):
    """Make a file with its bytes at once; whether there was none. Of several that do so together one has made it."""
    with unfinished(path) as file:
        file.write(content)
        file.flush()
        try:
            os.link(file.name, path)
        except FileExistsError:
            return os.fstat(file.fileno()).st_nlink == 2  # the answer to a request that NFS had sent twice
        except OSError as error:
            if error.errno not in _NO_LINKS:
                raise
            return _made_without_link(path, content)
    return True


@contextmanager
def unfinished(path, ending=""):
    """A temporary file beside a path, open for writing, and locked; it goes when the block ends, unless it has been renamed."""
    file = None
    try:
        with held():  # a file that nobody knows would stay
            file = _locked_beside(path, ending)
        yield file
    finally:
        if file:
            _drop(file)


def _drop(file):
    if os.path.exists(file.name):
        with suppress(OSError):
            os.unlink(file.name)
    with suppress(OSError):  # what it has still to write is not wanted any more
        file.close()


def _locked_beside(path, ending):
    folder, name = os.path.split(path)
    while True:
        file = open(os.path.join(folder, f".{name}.{secrets.token_hex(4)}.unfinished{ending}"), "xb")
        with suppress(OSError):  # of a file system without locks
            flock(file, LOCK_EX)
        if os.fstat(file.fileno()).st_nlink:
            return file
        file.close()  # another process has taken it for one that was left


def remove_unfinished(folder):
    """Remove the temporary files that killed processes have left in a folder; those of others at work are locked."""
    with suppress(FileNotFoundError), os.scandir(folder) as entries:
        for entry in entries:
            if is_unfinished(entry.name) and entry.is_file(follow_symlinks=False):
                with suppress(OSError), open(entry.path, "r+b") as file:
                    flock(file, LOCK_EX | LOCK_NB)
                    os.unlink(entry.path)


def is_unfinished(name):
    """Whether a file of this name is a temporary one."""
    return bool(_UNFINISHED.fullmatch(name))


def sync(path):
    """Have a file's content, or the names in a folder, on the disk; raises OSError."""
    with _about(path):
        handle = os.open(path, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)


@functools.cache
def _tidy(folder):
    """remove_unfinished(), once for each folder in which this process writes."""
    with suppress(OSError):
        remove_unfinished(folder)


@contextmanager
def _about(path):
    """An OSError that names no file, or a temporary one, names the path."""
    try:
        yield
    except OSError as error:
        named = error.filename is not None and not is_unfinished(os.path.basename(str(error.filename)))
        if named or error.errno is None:
            raise
        raise OSError(error.errno, error.strerror, str(path)) from None


def _refusal(path, reason):
    return OSError(errno.EINVAL, reason, path)


def _made_without_link(path, content):
    """make_new() where the file system has no hard links: between two calls the file is empty."""
    try:
        with open(path, "xb") as file:
            file.write(content)
    except FileExistsError:
        return False
    return True
