"""Arrays of .npz files: written, and of a run folder's read and checked against the lists of runs.format.

Whatever is missing, damaged or foreign raises RunFolderError: one line that names the file and says what is wrong."""

import io
import os
import tokenize
import zipfile
import zlib
from contextlib import contextmanager

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
    SyntaxError,
    tokenize.TokenError,
    zipfile.BadZipFile,
    zlib.error,
)


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


def read_arrays(file, names, optional=()):
    """The named arrays of an .npz file by name, read-only; those of `optional` where the file has them.

    RunFolderError when the file or an array is missing or damaged, or an array does not hold numbers."""
    with _opened(file) as archive:
        absent = [name for name in names if name not in archive.files]
        if absent:
            raise RunFolderError(f"{file}: lacks the array " + ", ".join(f"'{name}'" for name in absent))
        arrays = {name: archive[name] for name in (*names, *optional) if name in archive.files}
    for name, array in arrays.items():
        if array.dtype.kind not in "biuf":
            raise RunFolderError(f"{file}: '{name}' must hold numbers, it holds {array.dtype}")
        array.flags.writeable = False
    return arrays


def require_regular(file):
    """Raise RunFolderError when a path is something else than a file: reading a pipe would never end."""
    if os.path.exists(file) and not os.path.isfile(file):
        raise RunFolderError(f"{file}: is no regular file; must be one")


@contextmanager
def _opened(file):
    """The archive; whatever goes wrong while it is read is a RunFolderError."""
    require_regular(file)
    try:
        archive = np.load(file, allow_pickle=False)
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
    expected = [q for q in quantities if q.since <= file_format]
    arrays = read_arrays(
        file, [q.name for q in expected if not q.optional], [q.name for q in expected if q.optional]
    )
    sizes = _sizes(expected, arrays)
    for quantity in expected:
        if quantity.name in arrays:
            _check(file, quantity, arrays[quantity.name], sizes)
    for quantity in quantities:
        if quantity.since > file_format and not quantity.optional:
            arrays[quantity.name] = np.zeros([sizes.get(n, n) for n in quantity.shape])
            arrays[quantity.name].flags.writeable = False
    return arrays


def _sizes(quantities, arrays):
    """{letter: size}, from the first array that has no other axis."""
    sizes = {}
    for quantity in quantities:
        if quantity.name in arrays and len(quantity.shape) == 1 and isinstance(quantity.shape[0], str):
            sizes.setdefault(quantity.shape[0], arrays[quantity.name].size)
    return sizes


def _check(file, quantity, array, sizes):
    name, shape = quantity.name, tuple(sizes.get(n, n) for n in quantity.shape)
    if not shape and array.size != 1:
        raise RunFolderError(f"{file}: '{name}' must be one number, its shape is {array.shape}")
    if shape and array.shape != shape:
        raise RunFolderError(f"{file}: '{name}' has the shape {array.shape}, expected {shape}")
    kinds, words = _TYPES[quantity.kind]
    if array.dtype.kind not in kinds:
        raise RunFolderError(f"{file}: '{name}' must be {words}, it is {array.dtype}")
    if not quantity.gaps and not np.all(np.isfinite(array)):
        where = f", first at index {int(np.argmin(np.isfinite(array)))}" if array.ndim == 1 else ""
        raise RunFolderError(f"{file}: '{name}' holds a value that is not finite{where}")
    if quantity.positive and not np.all(array > 0):
        at = int(np.argmin(np.asarray(array) > 0))
        raise RunFolderError(f"{file}: '{name}' is {array[at]:g} at index {at}; must be > 0")
