"""Filling factors of the lattices, and how many grains a filling factor means."""

from math import pi, sqrt

from analysis.theory.aggregates import fcc_filling


def maximum_filling(grain_radius, overlap, planar=False):
    """Filling factor of the whole lattice, pi/(3 sqrt 2) [2r/(2r-overlap)]^3 (A24 eq 40); lengths in m.

    planar: fraction of the area, pi/(2 sqrt 3) [2r/(2r-overlap)]^2.
    """
    if planar:
        return pi / (2 * sqrt(3)) * (2 * grain_radius / (2 * grain_radius - overlap)) ** 2
    return fcc_filling(grain_radius, overlap)


def grain_number(filling, relative_radius, planar=False):
    """N = filling (R/r)^3, rounded (A24 section 3), or filling (R/r)^2 in a plane; relative_radius = R/r."""
    return round(filling * relative_radius ** (2 if planar else 3))
