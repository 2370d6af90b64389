"""Two aggregates of any shape on their way to each other, with an impact parameter (A22 section 2.4)."""

from dataclasses import dataclass

import numpy as np

from yade_scripts.packings.approach import first_touch
from yade_scripts.packings.packing import Packing, characteristic_radius, extent, moved

START_GAP = 2.0  # radii of the largest grain that the aggregates move against each other until they first touch


@dataclass(frozen=True)
class Placed:
    """A packing in its place, and its velocity (3,) [m/s]."""

    packing: Packing
    velocity: np.ndarray


def offset_pair(target, projectile, velocity, impact):
    """(Placed target, Placed projectile), in the frame of their common centre of mass, which is the origin.

    target, projectile: Packings around their centres of mass. The projectile comes along -x with the relative velocity
    [m/s]; the centres are offset in y by impact (r_c,tar + r_c,pro) (A22 eq 27, r_c: packing.characteristic_radius).
    A22 doesn't say how far apart its aggregates start: here so that they first touch after START_GAP; those that pass
    each other start where the spheres around them touch in x.
    """
    mass = np.array([(packing.radius**3).sum() for packing in (target, projectile)])
    largest = max(target.radius.max(), projectile.radius.max())
    offset = impact * (characteristic_radius(target) + characteristic_radius(projectile))
    ahead = extent(target) + extent(projectile) + 2 * largest
    far = moved(projectile, (ahead, offset, 0.0))
    until_touch = first_touch(target, far, np.array([-1.0, 0.0, 0.0]))
    if until_touch is not None:
        ahead += START_GAP * largest - until_touch
    apart, approach = np.array([ahead, offset, 0.0]), np.array([-velocity, 0.0, 0.0])
    of_target, of_projectile = -mass[1] / mass.sum(), mass[0] / mass.sum()
    return tuple(
        Placed(moved(packing, part * apart), part * approach)
        for packing, part in ((target, of_target), (projectile, of_projectile))
    )
