"""Arrays that come from outside: one converter that public functions call on their arguments."""

import numpy as np


def numbers(name, value, shape=None, *, positive=False, least=None, most=None, whole=False, gaps=False):
    """Array of numbers of a given shape, of float, or of numpy.intp where whole.

    Parameters
    ----------
    name : str
        Name of the argument, with which the line of a ValueError begins.
    value : array_like
        Numbers. Nothing missing (None, NA, masked values), no text, no True or False.
    shape : tuple, optional
        Length of each axis, None for any length; () for one number. Any shape if left out.
    positive, least, most, whole : bool, float, float, bool
        Whether all must be above 0, bounds that are allowed themselves, whether all must be whole numbers.
    gaps : bool
        Whether NaN and infinite values are allowed.

    Examples
    --------
    >>> numbers("radius", [1, -2.5], (None,), positive=True)
    Traceback (most recent call last):
    ValueError: radius: must be > 0, found -2.5
    """
    array = _plain(name, value)
    if shape is not None:
        if array.size == 0 and 0 in (wanted := [0 if n is None else n for n in shape]):
            array = array.reshape(wanted)  # [] is an empty array of any shape
        if len(shape) != array.ndim or any(n not in (None, found) for n, found in zip(shape, array.shape)):
            wanted = "(" + ", ".join("any" if n is None else str(n) for n in shape) + ")"
            raise ValueError(f"{name}: must have the shape {wanted}, has {array.shape}")
    for applies, words, right in (
        (not gaps, "finite", np.isfinite),
        (positive, "> 0", lambda x: ~(x <= 0)),
        (least is not None, f">= {least}", lambda x: ~(x < least)),
        (most is not None, f"<= {most}", lambda x: ~(x > most)),
        (whole, "whole", lambda x: x == np.floor(x)),
    ):
        if applies and not np.all(right(array)):
            raise ValueError(f"{name}: must be {words}, found {array[~right(array)].flat[0]}")
    return array.astype(np.intp if whole else float, copy=False)


def pairs(name, value, grains=None):
    """Pairs of grains (M, 2) as an array of numpy.intp; an empty list is none. With the number of grains their rows
    must be below it."""
    return numbers(name, value, (None, 2), least=0, most=None if grains is None else grains - 1, whole=True)


def _plain(name, value):
    """The value as an array of real numbers, without gaps that numpy would fill in silence."""
    if np.ma.is_masked(value) or (isinstance(value, (list, tuple)) and any(map(np.ma.is_masked, value))):
        raise ValueError(f"{name}: must have no masked values")
    try:
        array = np.asarray(value)
    except ValueError:  # lists of unequal length
        raise ValueError(f"{name}: must be an array, not lists of unequal length") from None
    if array.dtype.kind not in "fiu":
        raise ValueError(f"{name}: must be numbers, found {array.dtype.name} values")
    return array
