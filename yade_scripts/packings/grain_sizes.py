"""Grains of unlike size: radii drawn from a distribution, and how far apart two grains are that touch at rest."""

from math import exp

import numpy as np

EQUAL, TWO, LOGNORMAL = SIZES = ("equal", "two", "lognormal")
WIDEST = 2.5  # standard deviations of ln r at which a log-normal distribution is cut off on both sides


def radii(sizes, grains, grain_radius, stream, ratio=None, fraction=0.5, spread=None):
    """Radii (grains,) [m] in random order.

    sizes: "equal", all of grain_radius [m]; "two", of which round(fraction * grains) have ratio * grain_radius;
    "lognormal", ln(r/grain_radius) normal with standard deviation `spread`, cut off at WIDEST of it.
    """
    if sizes == EQUAL:
        return np.full(grains, float(grain_radius))
    if sizes == TWO:
        found = np.full(grains, float(grain_radius))
        found[: round(fraction * grains)] *= ratio
        return stream.permutation(found)
    deviations = stream.normal(size=grains)
    while (outside := np.abs(deviations) > WIDEST).any():
        deviations[outside] = stream.normal(size=np.count_nonzero(outside))
    return grain_radius * np.exp(spread * deviations)


def radius_range(sizes, grain_radius, ratio=None, spread=None):
    """(smallest, largest) radius [m] that radii() may draw."""
    if sizes == TWO:
        return grain_radius * min(1.0, ratio), grain_radius * max(1.0, ratio)
    width = exp(WIDEST * spread) if sizes == LOGNORMAL else 1.0
    return grain_radius / width, grain_radius * width


def touching_distance(first, second, grain_radius, overlap):
    """Distance [m] of the centres of grains of radii first, second [m] (any shape) at rest against each other.

    overlap: of two grains of grain_radius at equilibrium [m]. It goes with the reduced radius R as R^(1/3), since
    delta_0 = a_0^2/(3 R) and a_0^3 ~ R^2 (A22 eq 1 and after eq 2).
    """
    return first + second - overlap * np.cbrt(2 * first * second / ((first + second) * grain_radius))
