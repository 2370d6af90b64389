"""Reading and writing files, the one way of the analysis and the scripts.

A file is written under a temporary name beside its place, .NAME.XXXXXXXX.unfinished, brought onto the disk and renamed:
a process that is killed leaves the old file or the new one, never a part. What is read is compared with its SHA-256
where there is one, and an array is only read if it is as long as its header says. Writing raises OSError with
.filename, reading RunFolderError.
"""

import errno
import hashlib
import io
import json
import math
import os
import re
import secrets
import warnings
import zipfile
from contextlib import contextmanager, suppress
from pathlib import Path

import numpy as np

_UNFINISHED = re.compile(r"\..+\.[0-9a-f]{8}\.unfinished(\.\w+)?")


class RunFolderError(Exception):
    """A run folder, or a file of one, that cannot be used; the message is one line: which file, and what is wrong."""


def write_file(path, content):
    """Write a file (path), which is whole or as it was before.

    content: str (written in UTF-8), bytes or a buffer."""
    with replacing(path) as file:
        file.write(content.encode() if isinstance(content, str) else content)


@contextmanager
def replacing(path, ending=""):
    """A binary file, open for writing, that takes the place of `path` when the block has come to its end.

    A program that writes by itself may be given its .name, which ends in `ending` (".mp4")."""
    path = os.fspath(path)
    require_output(path)
    temporary = _temporary(path, ending)
    try:
        with open(temporary, "xb") as file:
            yield file
        sync(temporary)
        os.replace(temporary, path)
        sync(os.path.dirname(path) or os.curdir)
    except BaseException as error:
        with suppress(OSError):
            os.unlink(temporary)
        if isinstance(error, OSError) and error.errno and error.filename in (None, temporary):
            raise OSError(error.errno, error.strerror, path) from None
        raise


def require_output(path, inputs=()):
    """Raise OSError for a path that is no file, is write-protected, or is one of the inputs (paths)."""
    path = os.fspath(path)
    if os.path.realpath(path) in map(os.path.realpath, inputs):
        raise OSError(errno.EINVAL, "is what is read; must be another file", path)
    if os.path.exists(path) and not os.path.isfile(path):
        raise OSError(errno.EINVAL, "is a folder or a device; must be a file", path)
    if os.path.exists(path) and not os.access(path, os.W_OK):
        raise OSError(errno.EACCES, os.strerror(errno.EACCES), path)


def make_folder(path):
    """Make a folder, and those that it is in, unless it is there."""
    if os.path.lexists(path) and not os.path.isdir(path):
        raise OSError(errno.ENOTDIR, "is a file; must be a folder", os.fspath(path))
    os.makedirs(path, exist_ok=True)


def _temporary(path, ending=""):
    folder, name = os.path.split(path)
    return os.path.join(folder, f".{name}.{secrets.token_hex(4)}.unfinished{ending}")


def is_unfinished(name):
    """Whether a file of this name is a temporary one."""
    return bool(_UNFINISHED.fullmatch(name))


def remove_unfinished(folder):
    """Remove the temporary files that killed processes have left in a folder, in which no other process may write."""
    with suppress(FileNotFoundError):
        for name in filter(is_unfinished, os.listdir(folder)):
            with suppress(OSError):
                os.unlink(os.path.join(folder, name))


def sync(path):
    """Have a file's content, or the names in a folder, on the disk."""
    handle = os.open(path, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)


def read_bytes(file, sha256=None):
    """Content of a file; sha256: what its SHA-256 must be, in hexadecimal digits (None: anything)."""
    try:
        content = Path(file).read_bytes()
    except FileNotFoundError:
        raise RunFolderError(f"{file}: missing") from None
    except OSError as error:
        raise RunFolderError(f"{file}: cannot be read: {error.strerror}") from None
    found = hashlib.sha256(content).hexdigest() if sha256 else None
    if found != sha256:
        must = f"must be {sha256[:12]}..., as in ended"
        raise RunFolderError(f"{file}: not as it was written: its SHA-256 is {found[:12]}..., {must}")
    return content


def read_text(file, sha256=None):
    """Text of a file in UTF-8."""
    try:
        return read_bytes(file, sha256).decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise RunFolderError(f"{file}: damaged: {error}") from None


def read_json(file, sha256=None):
    """What a JSON file holds; NaN and Infinity are no JSON."""
    try:
        return json.loads(read_text(file, sha256), parse_constant=_refuse_constant)
    except RecursionError:
        raise RunFolderError(f"{file}: not valid JSON: nested too deeply") from None
    except ValueError as error:
        raise RunFolderError(f"{file}: not valid JSON: {error}") from None


def _refuse_constant(text):
    raise ValueError(f"{text} is no number of JSON")


def json_text(content):
    """A dictionary as JSON; ValueError for what JSON can't hold."""
    return json.dumps(content, indent=2, allow_nan=False) + "\n"


def npz(**arrays):
    """Content (a buffer) of an .npz file with these arrays."""
    content = io.BytesIO()
    np.savez(content, **arrays)
    return content.getbuffer()


def array_names(file):
    """Names of the arrays of an .npz file."""
    with _opened(file, read_bytes(file)) as archive:
        return _names(archive)


def read_arrays(file, names, optional=(), texts=(), sha256=None):
    """{name: read-only array, or str} of an .npz file: arrays of numbers that must be there (names), and that may be
    (optional), and texts that must be there; sha256 as of read_bytes()."""
    with _opened(file, read_bytes(file, sha256)) as archive:
        there = set(_names(archive))
        absent = [name for name in (*names, *texts) if name not in there]
        if absent:
            raise RunFolderError(f"{file}: lacks the array " + ", ".join(f"'{name}'" for name in absent))
        wanted = [name for name in (*names, *optional, *texts) if name in there]
        arrays = {name: _read_array(file, archive, name) for name in wanted}
    for name, array in arrays.items():
        if array.dtype.kind not in ("U" if name in texts else "biuf") or (name in texts and array.shape):
            what = "a text" if name in texts else "numbers"
            raise RunFolderError(f"{file}: '{name}' must hold {what}, it holds {array.dtype}")
        array.flags.writeable = False
    return {name: str(array) if name in texts else array for name, array in arrays.items()}


@contextmanager
def _opened(file, content):
    """The archive in these bytes of a file; whatever goes wrong while it is read is a RunFolderError."""
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive, warnings.catch_warnings():
            warnings.simplefilter("ignore")  # what numpy warns of in a damaged header
            yield archive
    except RunFolderError:
        raise
    except Exception as error:  # zipfile and numpy raise a dozen kinds, by which bit is damaged
        reason = str(error).splitlines()[0] if str(error) else type(error).__name__
        raise RunFolderError(f"{file}: damaged, or not an .npz file: {reason}") from None


def _names(archive):
    return [name.removesuffix(".npy") for name in archive.namelist() if name.endswith(".npy")]


def _read_array(file, archive, name):
    """The array, after its length has been compared with what its header says."""
    read = {(1, 0): np.lib.format.read_array_header_1_0, (2, 0): np.lib.format.read_array_header_2_0}
    with archive.open(f"{name}.npy") as member:
        shape, _, dtype = read[np.lib.format.read_magic(member)](member)
        length, expected = archive.getinfo(f"{name}.npy").file_size - member.tell(), math.prod(shape) * dtype.itemsize
    if length != expected and not dtype.hasobject:  # objects, whose length no header says, are refused below
        raise RunFolderError(f"{file}: damaged: '{name}' has {length} bytes, by its header {expected:.6g}")
    with archive.open(f"{name}.npy") as member:
        return np.lib.format.read_array(member, allow_pickle=False)


def read_sums(file):
    """{name: SHA-256} of a file as sha256sum prints it; lines that begin with # (formats before 5) are passed over."""
    lines = [line.split("  ") for line in read_text(file).splitlines() if line and not line.startswith("#")]
    if not all(len(line) == 2 and re.fullmatch("[0-9a-f]{64}", line[0]) for line in lines):
        raise RunFolderError(f"{file}: damaged: holds other lines than sums, as sha256sum prints them")
    return {name: digits for digits, name in lines}
