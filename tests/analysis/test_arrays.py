"""What the converter of arrays lets through, and what it refuses."""

import numpy as np
import pandas
import pytest

from analysis.arrays import numbers, pairs

REFUSED = (None, "x", b"x", True, 1j, [None], [[1], [2, 3]], {}, object(), pandas.NA, [1.0, float("nan")], [np.inf, 1])


@pytest.mark.parametrize("value", [*REFUSED, np.zeros((2, 2)), np.ma.masked_array([1.0, 2.0], [0, 1]), [-1.0]], ids=str)
def test_what_is_no_array_of_positive_numbers_is_one_line_that_names_the_argument(value):
    with pytest.raises(ValueError, match="^radius: [^\n]*$"):
        numbers("radius", value, (None,), positive=True)


def test_numbers_are_floats_whole_ones_integers_and_gaps_may_be_allowed():
    assert numbers("x", [1, 2], (2,)).dtype == float and numbers("n", [1.0, 2.0], whole=True).dtype == np.intp
    assert np.isnan(numbers("d", [1.0, np.nan], gaps=True)[1]) and numbers("p", [], (None, 3)).shape == (0, 3)
    assert pairs("contact_pairs", [], 5).shape == (0, 2) and pairs("contact_pairs", [[0, 4]], 5).tolist() == [[0, 4]]
    for wrong in ([[0, 5]], [[-1, 0]], [[0.5, 1]], [[0, 1, 2]]):
        with pytest.raises(ValueError, match="^contact_pairs: "):
            pairs("contact_pairs", wrong, 5)
