"""What the packings alone say of the place where two aggregates meet: how many grains are there."""

import numpy as np

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
