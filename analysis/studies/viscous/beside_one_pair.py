"""Lines beside a paper that has one pair of aggregates."""

from ...report.beside_paper import line_of_runs


def beside_one_pair(quantity, unit, mean, error, pairs, theirs, note=""):
    """Line of our mean over pairs of aggregates, with its standard error (None: not known), beside the paper's number
    (None: it gives none)."""
    return line_of_runs(quantity, unit, (mean, error), pairs, theirs, 1, note)


def beside_range(quantity, unit, mean, error, pairs, low, high, note=""):
    """The same beside a range from low to high that the paper gives: beside the end that is nearer, and beside none within
    it."""
    end = None if mean is None or low <= mean <= high else low if mean < low else high
    return beside_one_pair(quantity, unit, mean, error, pairs, end, note)
