"""The aggregate that a run's parameters ask for."""

from yade_scripts.bcca import bcca, extent
from yade_scripts.packings import cpe


def make(values, grain_radius, overlap, index):
    """Aggregate number index of a run, around the origin; values: as parameters.parse() gives them, lengths in m."""
    if values["packing"] == "bcca":
        return bcca(values["grains"], grain_radius, overlap, values["seed"], index, bool(values["planar"]))
    return cpe(
        values["filling"],
        values["radius"] * grain_radius,
        grain_radius,
        overlap,
        values["seed"],
        index,
        bool(values["planar"]),
    )


def bcca_radius(grains, relative_overlap, seed, planar):
    """Radius, in grain radii, that holds the centres of both BCCA aggregates of a seed; overlap in grain radii."""
    return max(extent(bcca(grains, 1.0, relative_overlap, seed, index, bool(planar))) for index in (0, 1))
