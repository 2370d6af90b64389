"""Arrays of .npz files: written, and of a run folder's read and checked against the lists of runs.format.

Whatever is missing, damaged or foreign raises RunFolderError: one line that names the file and says what is wrong."""

import io
import math
import os
import tokenize
import zipfile
import zlib
from contextlib import contextmanager
from typing import NamedTuple

import numpy as np

# numpy's letters of the types that may stand for a quantity's kind, and what to call them.
_TYPES = {"f": ("fiu", "numbers"), "i": ("iu", "integers"), "b": ("biu", "true or false")}

# What numpy and zipfile raise for a damaged .npz file, found by flipping each bit of one: RuntimeError for a bit that says
# "encrypted", TokenError for a header that numpy cannot parse, MemoryError for a shape that is too large.
UNREADABLE = (
    OSError,
    ValueError,
    KeyError,
    TypeError,
    EOFError,
    AttributeError,
    RuntimeError,
    MemoryError,
    OverflowError,
    SyntaxError,
    tokenize.TokenError,
    zipfile.BadZipFile,
    zlib.error,
)


LARGEST = 1e100  # of a value in SI units: squares and sums of what a run can hold are finite
MOST_UNPACKED, UNPACKING = 2**26, 20  # bytes that any file may hold, and times its own size: what we write is not even compressed


class Header(NamedTuple):
    """What an array is like, before it is read."""

    shape: tuple
    dtype: np.dtype


class RunFolderError(Exception):
    """A run folder that cannot be analysed; the message is one line: which file, and what is wrong."""


def npz(**arrays):
    """Content (a buffer) of an .npz file with these arrays."""
    content = io.BytesIO()
    np.savez(content, **arrays)
    return content.getbuffer()


def array_names(file):
    """Names of the arrays of an .npz file; RunFolderError when it is missing or damaged."""
    with _opened(file) as archive:
        return list(archive.files)


def read_arrays(file, names, optional=(), require=lambda headers: None, texts=()):
    """The named arrays of an .npz file by name, read-only; those of `optional` where the file has them; those of `texts` as str.

    require({name: Header}): called before any array is read. RunFolderError when the file or an array is missing or damaged, or
    an array does not hold numbers, or a text."""
    with _opened(file) as archive:
        absent = [name for name in (*names, *texts) if name not in archive.files]
        if absent:
            raise RunFolderError(f"{file}: lacks the array " + ", ".join(f"'{name}'" for name in absent))
        headers = read_headers(file, archive, [name for name in (*names, *optional, *texts) if name in archive.files])
        for name, header in headers.items():
            if header.dtype.kind not in ("U" if name in texts else "biuf") or (name in texts and header.shape):
                what = "a text" if name in texts else "numbers"
                raise RunFolderError(f"{file}: '{name}' must hold {what}, it holds {header.dtype}")
        require(headers)
        arrays = {name: archive[name] for name in headers}
    for array in arrays.values():
        array.flags.writeable = False
    return {name: str(array) if name in texts else array for name, array in arrays.items()}


def read_headers(file, archive, names):
    """{name: Header} of arrays in an open .npz file (what np.load gives); nothing of them is unpacked.

    RunFolderError where one is not as long as its header says, or they are far larger than the file; one of UNREADABLE where a header
    is damaged."""
    headers, unpacked = {}, 0
    for name in names:
        with archive.zip.open(f"{name}.npy") as member:
            read = {(1, 0): np.lib.format.read_array_header_1_0, (2, 0): np.lib.format.read_array_header_2_0}
            shape, _, dtype = read[np.lib.format.read_magic(member)](member)
            if dtype.hasobject:  # whose length no header tells
                raise ValueError("Object arrays cannot be loaded when allow_pickle=False")
            length, expected = archive.zip.getinfo(f"{name}.npy").file_size - member.tell(), math.prod(shape) * dtype.itemsize
        if length != expected:
            raise RunFolderError(f"{file}: damaged: '{name}' has {length} bytes, by its header {expected:.6g}")
        headers[name], unpacked = Header(shape, dtype), unpacked + length
    if unpacked > max(MOST_UNPACKED, UNPACKING * os.path.getsize(file)):
        raise RunFolderError(f"{file}: {unpacked:.3g} bytes when unpacked; must be at most {UNPACKING} times as large as the file")
    return headers


def require_regular(file):
    """Raise RunFolderError when a path is something else than a file: reading a pipe would never end."""
    if os.path.exists(file) and not os.path.isfile(file):
        raise RunFolderError(f"{file}: is no regular file; must be one")


@contextmanager
def _opened(file):
    """The archive; whatever goes wrong while it is read is a RunFolderError."""
    require_regular(file)
    try:
        archive = np.load(file, mmap_mode="r", allow_pickle=False)  # of a single array nothing is read
        if isinstance(archive, np.ndarray):
            raise RunFolderError(f"{file}: damaged, or not an .npz file: it holds a single array")
        with archive:
            yield archive
    except FileNotFoundError:
        raise RunFolderError(f"{file}: missing") from None
    except UNREADABLE as error:
        reason = str(error).splitlines()[0] if str(error) else type(error).__name__
        raise RunFolderError(f"{file}: damaged, or not an .npz file: {reason}") from None


def read_quantities(file, quantities, file_format):
    """The arrays of the quantities (runs.format.Quantity) by name, checked: shape, type, finite unless it may have
    gaps. Zeros stand for those that the folder's format did not have yet; optional ones may be left out."""
    expected, sizes = [q for q in quantities if q.since <= file_format], {}

    def require(headers):
        sizes.update(_sizes(expected, headers))
        for quantity in expected:
            if quantity.name in headers:
                _check_header(file, quantity, headers[quantity.name], sizes)

    names = [[q.name for q in expected if q.optional == optional] for optional in (False, True)]
    arrays = read_arrays(file, *names, require)
    for quantity in expected:
        if quantity.name in arrays:
            require_values(file, quantity, arrays[quantity.name])
    for quantity in quantities:
        if quantity.since > file_format and not quantity.optional:
            arrays[quantity.name] = np.zeros([sizes.get(n, n) for n in quantity.shape])
            arrays[quantity.name].flags.writeable = False
    return arrays


def _sizes(quantities, headers):
    """{letter: size}, from the first array that has no other axis."""
    sizes = {}
    for quantity in quantities:
        if quantity.name in headers and len(quantity.shape) == 1 and isinstance(quantity.shape[0], str):
            sizes.setdefault(quantity.shape[0], math.prod(headers[quantity.name].shape))
    return sizes


def _check_header(file, quantity, header, sizes):
    name, shape = quantity.name, tuple(sizes.get(n, n) for n in quantity.shape)
    if not shape and math.prod(header.shape) != 1:
        raise RunFolderError(f"{file}: '{name}' must be one number, its shape is {header.shape}")
    if shape and header.shape != shape:
        raise RunFolderError(f"{file}: '{name}' has the shape {header.shape}, expected {shape}")
    kinds, words = _TYPES[quantity.kind]
    if header.dtype.kind not in kinds:
        raise RunFolderError(f"{file}: '{name}' must be {words}, it is {header.dtype}")


def require_values(file, quantity, array):
    """Raise RunFolderError unless the values of a quantity's array are what they may be."""
    name, sound = quantity.name, np.abs(array) < LARGEST
    if quantity.gaps:
        sound |= np.isnan(array)
    if not np.all(sound):
        where = f", first at index {int(np.argmin(sound))}" if array.ndim == 1 else ""
        what = f"beyond {LARGEST:g}" if np.isfinite(array[~sound]).all() else "not finite"
        raise RunFolderError(f"{file}: '{name}' holds a value that is {what}{where}")
    if quantity.positive and not np.all(array > 0):
        at = int(np.argmin(np.asarray(array) > 0))
        raise RunFolderError(f"{file}: '{name}' is {array[at]:g} at index {at}; must be > 0")
