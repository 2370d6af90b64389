"""What the packings alone say of the place where two aggregates meet: how many grains are there, how far rigid aggregates would
approach, how the lattice lies to the collision axis, and which grains are outside the largest piece."""

import numpy as np
from scipy.spatial import cKDTree

from .fragments import fragment_labels, fragment_sizes

# Depth below the contact pole and radius about the collision axis of the zone, in radii of the aggregate.
DEPTH = WIDTH = 0.25


def zone_volume(radius, depth=DEPTH, width=WIDTH):
    """Volume of the part of a sphere that lies within `depth` of its pole and within `width` of its axis (both in radii
    of the sphere): a cylinder below a cap; in the unit of radius^3.

    >>> f"{zone_volume(1.0, 2.0, 1.0) / (4 * np.pi / 3):.6f}"
    '1.000000'
    """
    cap = 1.0 - np.sqrt(1.0 - width**2)
    if depth <= cap:
        return np.pi * depth**2 * (1.0 - depth / 3.0) * radius**3
    rest = np.pi * width**2 * (depth - cap) if depth <= 2.0 - cap else None
    if rest is None:
        # Both caps, and the whole cylinder between them less what the far one lacks below `depth`.
        far = 2.0 - depth
        rest = np.pi * width**2 * (2.0 - 2.0 * cap) + np.pi * (cap**2 * (1 - cap / 3) - far**2 * (1 - far / 3))
    return (rest + np.pi * cap**2 * (1.0 - cap / 3.0)) * radius**3


def zone_filling(position, centre, radius, side, depth=DEPTH, width=WIDTH):
    """Number density of grains in the zone at one pole over that of the whole aggregate: 1 in the mean over packings.

    position (N,3) of the grains of one aggregate, centre (3,) of its sphere, radius of the sphere that holds the centres
    of its grains, one unit; side: +1 or -1, the pole at which it meets the other, along x. The zone holds the grains
    with centres less than depth*radius below the pole and less than width*radius from the axis through the centre."""
    place = np.asarray(position, dtype=float) - centre
    inside = (side * place[:, 0] > (1.0 - depth) * radius) & (np.hypot(place[:, 1], place[:, 2]) < width * radius)
    return float(inside.mean() * (4.0 / 3.0 * np.pi * radius**3) / zone_volume(radius, depth, width))


def rigid_approach(first, second, reach, number):
    """How far [m] two rigid aggregates can approach along x until `number` pairs of their grains are closer than `reach`
    (2 r: overlap) at least once. first (N,3), second (M,3): positions [m], the first on the side of smaller x.
    NaN where there are not so many pairs."""
    first, second = np.asarray(first, dtype=float), np.asarray(second, dtype=float)
    front = second[:, 0].min() - first[:, 0].max()
    depth, deepest = 4.0 * reach, max(np.ptp(first[:, 0]), np.ptp(second[:, 0])) + reach
    while True:
        # Grains deeper than this below the foremost one meet none before front + depth - reach.
        near = first[first[:, 0] >= first[:, 0].max() - depth], second[second[:, 0] <= second[:, 0].min() + depth]
        approach = np.sort(_approaches(*near, reach))
        if len(approach) >= number and approach[number - 1] <= front + depth - reach:
            return float(approach[number - 1])
        if depth >= deepest:
            return float(approach[number - 1]) if len(approach) >= number else float("nan")
        depth *= 2.0


def _approaches(first, second, reach):
    """The approaches (K,) along x at which pairs of points first come within reach of each other."""
    lists = cKDTree(first[:, 1:]).query_ball_tree(cKDTree(second[:, 1:]), reach)
    i = np.repeat(np.arange(len(first)), [len(own) for own in lists])
    j = np.array([k for own in lists for k in own], dtype=np.intp)
    aside = ((first[i, 1:] - second[j, 1:]) ** 2).sum(axis=1)
    return second[j, 0] - first[i, 0] - np.sqrt(np.maximum(reach**2 - aside, 0.0))


def bond_direction(position, contact_pairs):
    """Mean over contacts of cos^4 of the angle between contact and x axis: how a lattice lies to it. 1/5 for contacts of
    all directions; in a face-centred cubic lattice 1/6 along <100>, 5/24 along <110> and 2/9 along <111>. NaN without
    contacts. position (N,3), contact_pairs (M,2)."""
    pairs = np.asarray(contact_pairs, dtype=np.intp).reshape(-1, 2)
    between = np.asarray(position, dtype=float)[pairs[:, 0]] - np.asarray(position, dtype=float)[pairs[:, 1]]
    if not len(pairs):
        return float("nan")
    return float(np.mean((between[:, 0] ** 2 / np.einsum("ij,ij->i", between, between)) ** 2))


def loose_fraction(grains, contact_pairs):
    """Fraction of N = `grains` grains of one aggregate outside its largest piece, joined by contact_pairs (M,2).

    >>> loose_fraction(4, [[0, 1], [1, 2]])
    0.25
    """
    sizes = fragment_sizes(fragment_labels(grains, contact_pairs))
    return float(1.0 - sizes.max() / grains)
