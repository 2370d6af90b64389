"""Which runs a mean counts: those of pairs of aggregates that have all of its points.

A pair that has run at some offsets only would move the mean at these by what differs from pair to pair, and its error
would come from these alone: with pair 1 at 13 offsets and pair 2 head-on 0.03 m/s of v_fra, from whole pairs 1.3 m/s."""

import numpy as np

DIGITS = 9  # of B_off^2


def offset_squares(runs):
    """B_off^2 (runs,) of a table of runs, to rounding."""
    return (runs.impact.to_numpy(dtype=float) ** 2).round(DIGITS)


def most_used(sets, allowed=lambda points: True):
    """Of the sets of points {pair: frozenset}, that with which the most points count when every pair that has all of it is
    taken; the larger of two such. () where none is allowed.

    >>> sorted(most_used({1: frozenset({0, 1, 2}), 2: frozenset({0, 1, 2}), 3: frozenset({0, 2})}))
    [0, 1, 2]
    """
    candidates = sorted({points for points in sets.values() if allowed(sorted(points))}, key=sorted)
    if not candidates:
        return frozenset()
    return max(candidates, key=lambda own: (len(own) * sum(own <= each for each in sets.values()), len(own)))


def whole_pairs(runs, points, cells, allowed=lambda points: True):
    """(the runs that count, their points (tuple, rising)): of a table of runs with points (runs,) (offsets, say) those of the
    points that most_used tells, of each of the cells (runs,) (a pair at one velocity, say) that has all of them."""
    cells, points = list(cells), np.asarray(points)
    sets = {cell: frozenset(points[[own == cell for own in cells]].tolist()) for cell in dict.fromkeys(cells)}
    chosen = most_used(sets, allowed)
    counts = [point in chosen and chosen <= sets[cell] for cell, point in zip(cells, points.tolist())]
    return runs[np.array(counts, dtype=bool)], tuple(sorted(chosen))
