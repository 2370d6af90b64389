"""Two answers of a study, alike but for the last bits that a library may round either way."""

import numbers

import matplotlib.image
import numpy as np

ROUNDING = 1e-6  # [-] a fit that was minimised stands on fewer digits than its data


def differences(one, other, place="answer"):
    """Where two answers (as json.loads gives them) differ: a list of lines; numbers to a relative ROUNDING."""
    if isinstance(one, dict) and isinstance(other, dict) and list(one) == list(other):
        return [line for key in one for line in differences(one[key], other[key], f"{place}/{key}")]
    if isinstance(one, list) and isinstance(other, list) and len(one) == len(other):
        return [line for n, pair in enumerate(zip(one, other)) for line in differences(*pair, f"{place}/{n}")]
    if isinstance(one, numbers.Number) and isinstance(other, numbers.Number):
        same = abs(one - other) <= ROUNDING * max(abs(one), abs(other)) or one != one and other != other
    else:
        same = one == other
    return [] if same else [f"{place}: {one!r} and {other!r}"]


def image_difference(one, other):
    """Root mean square of the difference of two PNG files, where 1 is from black to white."""
    one, other = matplotlib.image.imread(one), matplotlib.image.imread(other)
    return np.inf if one.shape != other.shape else float(np.sqrt(np.mean((one - other) ** 2)))
