"""Which collisions bounce: runs beside S17's chain model (section 5.4, Fig. 17)."""

import numpy as np

from ...theory import ICE
from ...theory.chains import chain_of_contacts, grains_of_chain, sticking_ratio
from . import paper

RADIUS = 1e-7  # R [m]
MASS = 4.0 / 3.0 * np.pi * ICE.density * RADIUS**3
STIFFEST = 3.0  # chains of so many grains or fewer have no stiffness in the model (S17 eq 17 diverges)


def chain_grains(point):
    """N of a results.Point: from its contacts (S17 eq 16) for compacted aggregates, from L = 100 R (eq 14) for BCCA ones."""
    if not point.growth_velocity:
        return grains_of_chain(paper.BASE, 1.0)
    return float(chain_of_contacts(point.means["contacts"][0]))


def predicted_ratio(point, grains=None):
    """F_c/F_max of a results.Point (S17 eq 19; below 1: bouncing), for chains of `grains`, else of chain_grains. 0 where they
    are so short that eq 17 diverges; NaN without necks."""
    grains = chain_grains(point) if grains is None else grains
    if not point.neck:
        return float("nan")
    if grains <= STIFFEST:
        return 0.0
    return float(sticking_ratio(point.velocity, grains, point.neck, RADIUS, ICE.young, MASS, ICE.surface_energy))
