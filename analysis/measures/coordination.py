"""Coordination numbers: how many contacts a grain has."""

import numpy as np

from ..arguments import COUNT, NOT_NEGATIVE, PAIRS, number, numbers, takes


@takes(grains=number(COUNT), contact_pairs=PAIRS)
def mean_coordination(grains, contact_pairs):
    """2 M/N for N = `grains` and contact_pairs (M,2).

    >>> mean_coordination(4, [[0, 1], [2, 3]])
    1.0
    """
    return 2.0 * len(contact_pairs) / grains


@takes(position=numbers("N,3"), contact_pairs=PAIRS, centre=numbers("3 or N,3"), reach=number(NOT_NEGATIVE))
def inner_coordination(position, contact_pairs, centre, reach):
    """Mean number of contacts of the grains whose centre, position (N,3), lies nearer than `reach` to `centre` (3,), or
    (N,3) with one for each grain; all in one unit, contact_pairs (M,2). NaN if there is no such grain.

    >>> inner_coordination([[0.0, 0, 0], [2, 0, 0], [4, 0, 0]], [[0, 1], [1, 2]], [2.0, 0, 0], 1.0)
    2.0
    """
    position = np.asarray(position, dtype=float)
    contacts = np.bincount(np.asarray(contact_pairs, dtype=np.intp).ravel(), minlength=len(position))
    place = position - centre
    inside = np.einsum("ij,ij->i", place, place) < reach**2
    return float(contacts[inside].mean()) if inside.any() else float("nan")
