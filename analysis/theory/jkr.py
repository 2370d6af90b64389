"""JKR normal motion: contact radius, force and energy as functions of the overlap (A22 eqs 2-11, A24 eqs 5-7).

With u = (a/a0)^(1/2) the overlap in units of delta0 is D = 3 u^4 - 2 u (A22 eq 2). A contact lives on the branch u >=
u_c = 6^(-1/3), where D = -(9/16)^(1/3) is the pull-off (A22 eq 3). Measured from there, with w = u - u_c,

    D + (9/16)^(1/3) = w^2 (18 u_c^2 + 12 u_c w + 3 w^2)

exactly: no term is negative, so the root w is found to the last digits even where D(u) is flat.
"""

import numpy as np

from ..arrays import numbers

U_PULL_OFF = 6.0 ** (-1.0 / 3.0)
ENERGY_SCALE = 4.0 * 6.0 ** (1.0 / 3.0)


# (9/16)^(1/3) as a sum of two doubles: beside the pull-off one is too coarse.
PULL_OFF_OVERLAP, _PULL_OFF_REST = 0.8254818122236567, -1.4776601947357812e-17
# An overlap of -delta_c, divided by delta0, may round to just beyond the pull-off: that much is not a separation.
_ROUNDING = 4e-16


def _distance_from_pull_off(normalised_overlap):
    distance = (numbers("overlap", normalised_overlap, gaps=True) + PULL_OFF_OVERLAP) + _PULL_OFF_REST
    return np.where((distance < 0) & (distance > -_ROUNDING), 0.0, distance)


def _root_from_distance(distance):
    """u for D + (9/16)^(1/3) = distance >= 0 (NaN below), any shape."""
    c2, c3, c4 = 18.0 * U_PULL_OFF**2, 12.0 * U_PULL_OFF, 3.0
    with np.errstate(invalid="ignore"):
        s = np.sqrt(distance)
    # s = w (c2 + c3 w + c4 w^2)^(1/2) is convex and rises: Newton's steps from above come down to the root and stay.
    w = np.minimum(s / np.sqrt(c2), np.sqrt(s / np.sqrt(c4)))
    for _ in range(6):
        q = np.sqrt(c2 + w * (c3 + w * c4))
        w = w - (w * q - s) / (q + w * (c3 + 2 * c4 * w) / (2 * q))
    return U_PULL_OFF + w


def contact_radius_root(normalised_overlap):
    """u = (a/a0)^(1/2) for an overlap D = delta/delta0 (any shape); NaN where D is beyond the pull-off. A22 eq 2,
    inverted."""
    return _root_from_distance(_distance_from_pull_off(normalised_overlap))


def normalised_force(normalised_overlap):
    """F_E/F_c (positive = repulsive) for D = delta/delta0 (any shape); 0 where the grains are apart. A22 eq 5."""
    u = contact_radius_root(normalised_overlap)
    return np.where(np.isnan(u), 0.0, 4.0 * u**3 * (u - 1.0) * (u * u + u + 1.0))[()]


def normalised_energy(normalised_overlap):
    """U_n/(F_c delta_c) for D = delta/delta0 (any shape); 0 where the grains are apart. A22 eq 8."""
    u = contact_radius_root(normalised_overlap)
    return np.where(np.isnan(u), 0.0, ENERGY_SCALE * u**4 * (0.8 * u**6 - 4.0 / 3.0 * u**3 + 1.0 / 3.0))[()]


def contact_radius(overlap, pair):
    """Contact radius a [m] for an overlap [m] (any shape) of a PairConstants; 0 where the grains are apart. A22 eq
    2."""
    u = contact_radius_root(_normalised(overlap, pair))
    return np.where(np.isnan(u), 0.0, pair.equilibrium_contact_radius * u * u)[()]


def normal_force(overlap, pair):
    """Elastic normal force F_E [N], positive = repulsive, for an overlap [m] (any shape). A22 eq 5."""
    return pair.pull_off_force * normalised_force(_normalised(overlap, pair))


def normal_energy(overlap, pair):
    """JKR potential U_n [J] for an overlap [m] (any shape), 0 where the grains are apart. A22 eq 8."""
    return pair.pull_off_force * pair.pull_off_overlap * normalised_energy(_normalised(overlap, pair))


def _normalised(overlap, pair):
    return numbers("overlap", overlap, gaps=True) / pair.equilibrium_overlap
