"""A packing in a periodic cubic cell: how small the cell may be, and grains that touch across its boundaries."""

import numpy as np
from scipy.spatial import cKDTree

from yade_scripts.packings.packing import PackingError, contacts

GAP = 0.1  # grain radii between a packing and its images in the smallest cell that holds it whole


def smallest_edge(packing):
    """Edge [m] of the cubic cell as large as the packing in x, y or z (K13 section 2.3), and a tenth of a radius more."""
    radius = packing.radius.max()
    return float(np.ptp(packing.position, axis=0).max() + (2 + GAP) * radius)


def require_apart_from_images(packing, edge):
    """Raise PackingError when grains touch images of others in a cubic cell of that edge [m]."""
    inside = packing.position % edge
    inside[inside >= edge] = 0.0  # of -1e-20 % edge
    pairs = cKDTree(inside, boxsize=edge).query_pairs(2 * packing.radius.max(), output_type="ndarray")
    separation = inside[pairs[:, 0]] - inside[pairs[:, 1]]
    separation -= edge * np.round(separation / edge)
    touching = np.linalg.norm(separation, axis=1) <= packing.radius[pairs].sum(axis=1)
    across = int(np.count_nonzero(touching)) - len(contacts(packing))
    if across > 0:
        raise PackingError(
            f"{across} pairs of grains touch across the boundaries of a cell of {edge:.4g} m; must be none"
        )
