"""Loops of a packing: how many there are, and which grains belong to one (Sirono & Ueno 2017, section 5.4)."""

import numpy as np

from .network import contact_network, depths, spanning_forest


def loops(grains, pairs):
    """(independent loops, grains in loops) of N = `grains` grains joined by pairs (M,2) int, each pair once.

    Independent are M - N + pieces: 0 for trees, one more for each contact that a tree needn't have. A grain is in a loop if
    a way of contacts leads from it back to it without using one twice.

    >>> loops(5, [[0, 1], [1, 2], [2, 0], [2, 3], [3, 4]])
    (1, 3)
    """
    pairs = np.asarray(pairs, dtype=np.intp).reshape(-1, 2)
    order, parent = spanning_forest(contact_network(grains, pairs))
    depth = depths(order, parent)
    inside = np.zeros(grains, dtype=bool)
    for i, j in pairs[(parent[pairs[:, 0]] != pairs[:, 1]) & (parent[pairs[:, 1]] != pairs[:, 0])]:
        while i != j:  # up the tree to where both ways meet
            inside[[i, j]] = True
            i, j = (parent[i], j) if depth[i] >= depth[j] else (i, parent[j])
        inside[i] = True
    return len(pairs) - grains + int((parent < 0).sum()), int(inside.sum())
