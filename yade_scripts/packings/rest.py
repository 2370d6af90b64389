"""Contacts brought to rest: positions near the given ones at which every contact has its equilibrium overlap.

Newton's method on the distances of the grains that touch: d_ij(x) = r_i + r_j - delta_ij, each step the smallest motion
that solves the linearised equations. Contacts without loops, and loops that once were at rest, have an exact solution;
where there are more contacts than the grains can obey at once, the steps lead to the least sum of k_ij (d_ij - ...)^2,
with k_ij the stiffness of the contact at rest: the minimum of the elastic energy, where forces balance."""

import numpy as np
from scipy.sparse import csr_matrix
from scipy.sparse.linalg import lsqr

from analysis.progress import progress
from yade_scripts.packings.packing import AT_REST, equilibrium_overlaps, surface_gaps, touching

MOST_MOVES = 20
# Of LSQR a step: more of them follow soft modes of dense packings, which are of no use before distances are nearly
# right (10,800 close-packed grains: 1 % left after 6 steps of 300, 4 % after 6 of 2000).
ITERATIONS = 300


def at_rest(position, radius, pairs, grain_radius, overlap):
    """Bring the contacts of pairs (M, 2) to rest; grains that come to overlap on the way are contacts too.

    position (N, 3), radius (N,); the overlap at rest is that of two grains of grain_radius. All lengths in m. Returns
    positions (N, 3), pairs (M, 2) of contacts, and how much deeper each (M,) is than at rest, in equilibrium overlaps.
    """
    moved = position.copy()
    for move in progress(range(MOST_MOVES + 1), "bringing contacts to rest", MOST_MOVES + 1):
        pairs = np.unique(np.sort(np.concatenate([pairs, touching(moved, radius)]), axis=1), axis=0)
        depth = equilibrium_overlaps(radius, pairs, grain_radius, overlap)
        missing = -surface_gaps(moved, radius, pairs) - depth
        deviation = missing / depth
        if move == MOST_MOVES or np.abs(deviation).max(initial=0.0) < AT_REST:
            return moved, pairs, deviation
        separation = moved[pairs[:, 0]] - moved[pairs[:, 1]]
        normal = separation / np.linalg.norm(separation, axis=1)[:, None]
        # k ~ a_0 ~ R^(2/3), as depth^2 (packing.touching_distance)
        moved = moved + _smallest_motion(normal, pairs, missing, depth / overlap, len(radius))


def _smallest_motion(normal, pairs, change, weight, grains):
    """Motion (N, 3) of least length that changes the distances of pairs (M, 2) by change (M,), to first order; where
    that is impossible, with the least sum of squares of weight (M,) times what is missing."""
    contacts = np.repeat(np.arange(len(pairs)), 3)
    axes = np.tile(np.arange(3), len(pairs))
    columns = [3 * np.repeat(pairs[:, side], 3) + axes for side in (0, 1)]
    of_first = (weight[:, None] * normal).ravel()
    data = np.concatenate([of_first, -of_first])
    rows = np.concatenate([contacts, contacts])
    matrix = csr_matrix((data, (rows, np.concatenate(columns))), shape=(len(pairs), 3 * grains))
    return lsqr(matrix, weight * change, atol=1e-9, btol=1e-9, iter_lim=ITERATIONS)[0].reshape(-1, 3)
