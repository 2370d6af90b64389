"""Lines beside a paper that has one pair of aggregates and states no errors: its number is taken to scatter as one of our
pairs, so that p is of both."""

from ...report.beside_paper import Line


def beside_one_pair(quantity, unit, mean, error, pairs, theirs, note=""):
    """Line of our mean over pairs of aggregates, with its standard error (None: not known), beside the paper's number
    (None: it gives none)."""
    scatter = None if error is None or theirs is None else error * pairs**0.5
    return Line(quantity, unit, mean, error, theirs, scatter, note, pairs - 1, shared=True)


def beside_range(quantity, unit, mean, error, pairs, low, high, note=""):
    """The same beside a range from low to high that the paper gives: beside the end that is nearer, and beside none within
    it."""
    end = None if mean is None or low <= mean <= high else low if mean < low else high
    return beside_one_pair(quantity, unit, mean, error, pairs, end, note)
