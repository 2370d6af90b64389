"""What is measured of each collision of A24's: largest compression, packings, outcome and energy."""

import numpy as np

from ...measures.structure import DEPTH, WIDTH, inner_coordination, zone_filling
from ...runs.table import Column
from ..columns import COMPACT, GRAIN_RADIUS, SEED, VELOCITY, constant, group, largest_compression, one, parameter
from ..grains import require_papers_grains

# Grains deeper than this below the sphere that holds all centres have all their neighbours' sites in it.
SKIN = 2.0  # grain radii
ZONES = (
    f"grains per volume in the two zones that meet, {DEPTH:g} R deep and {WIDTH:g} R in radius about the contact poles, over that of the whole "
    "aggregates; mean of the two"
)


def _duration(run):
    return float(run.parameters.get("duration") or run.history["time"][-1])


def _compression(run, row):
    require_papers_grains(run)
    maximum, exceeded = largest_compression(run)
    offset = float(run.history["d"][0]) + 2.0 * row["grain_radius"]
    return offset, maximum.length, maximum.length_error, exceeded, maximum.time, maximum.time_error


def _packings(run, row):
    start, radius, grain_radius = run.start, row["radius"], row["grain_radius"]
    # The spheres stand at -+(R + r) on the collision axis (A24 section 3).
    centres = np.array([-1.0, 1.0])[start.aggregate, None] * (radius + grain_radius) * np.array([1.0, 0.0, 0.0])
    inside = inner_coordination(start.position, start.contact_pairs, centres, radius - SKIN * grain_radius)
    return inside, zones_that_meet(start.position, start.aggregate, radius, grain_radius)


def zones_that_meet(position, aggregate, radius, grain_radius):
    """Filling of the two zones that meet over that of the aggregates, mean of the two: positions (N,3) [m] before the aggregates, (N,) 0 or
    1, touch; radius of an aggregate and of a grain [m]; their centres stand at -+(R + r) on the x axis."""
    found = []
    for number, side in ((0, 1.0), (1, -1.0)):
        centre = np.array([-side * (radius + grain_radius), 0.0, 0.0])
        found.append(zone_filling(position[aggregate == number], centre, radius, side))
    return float(np.mean(found))


# What a run may have changed, and what A24 has: drag, grains outside the largest piece, overlap of neighbours at the start.
UNCHANGED = {"viscoelasticTime": 0.0, "removeLooseGrains": 0.0, "initialOverlap": 1.0}

MEASURED = (
    parameter("filling", "", "filling factor"),
    constant("radius", "m", "radius of an aggregate", "aggregateRadius"),
    VELOCITY,
    SEED,
    parameter("viscoelasticTime", "s", "T_vis of the viscous drag", usual=0.0),
    parameter("removeLooseGrains", "", "1: grains outside the largest piece are left out", usual=0.0),
    parameter("initialOverlap", "", "overlap of neighbours at the start, of that at rest", usual=1.0),
    one("duration", "s", "how long the collision is followed", _duration),
    GRAIN_RADIUS,
    constant("grain_density", "kg/m^3", "density of a grain", "density"),
    constant("pull_off_force", "N", "F_c", "pullOffForce"),
    constant("overlap", "m", "delta_0, the overlap at equilibrium", "equilibriumOverlap"),
    group(
        _compression,
        Column("offset", "m", "d(0) + 2 r, by which the centres of mass are closer than the spheres' by chance"),
        Column("d_max", "m", "largest compression length of the first compression"),
        Column("d_max_error", "m", "its error, see measures.compression.Maximum"),
        Column("exceeded", "", "whether d grows beyond it later", kind="b"),
        Column("t_max", "s", "time of d_max"),
        Column("t_max_error", "s", "its error"),
    ),
    group(
        _packings,
        Column("inner_coordination", "", f"mean number of contacts of grains {SKIN:g} r below the surface", gaps=True),
        Column("zone_filling", "", ZONES, gaps=True),
    ),
    *COMPACT,
)
