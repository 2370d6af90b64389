"""One row of numbers for each collision."""

import numpy as np

from ...measures.contact_zone import DEPTH, WIDTH, zone_filling
from ...measures.coordination import inner_coordination
from ...measures.of_run import derived_constants
from ...runs.arrays import RunFolderError
from ...runs.table import Column
from ..collisions import COLLISION_COLUMNS, collision_values, largest_compression
from ..grains import require_papers_grains

# Grains deeper than this below the sphere that holds all centres have all their neighbours' sites in it.
SKIN = 2.0  # grain radii
# What a run may have changed, and what A24 has: drag, grains outside the largest piece, overlap of neighbours at the start.
UNCHANGED = {"viscoelasticTime": 0.0, "removeLooseGrains": 0.0, "initialOverlap": 1.0}

COLUMNS = (
    Column("filling", "", "filling factor"),
    Column("radius", "m", "radius of an aggregate"),
    Column("velocity", "m/s", "collision velocity"),
    Column("seed", "", "random seed of the pair of aggregates", kind="i"),
    Column("viscoelasticTime", "s", "T_vis of the viscous drag"),
    Column("removeLooseGrains", "", "1: grains outside the largest piece are left out"),
    Column("initialOverlap", "", "overlap of neighbours at the start, of that at rest"),
    Column("duration", "s", "how long the collision is followed"),
    Column("grain_radius", "m", "radius of a grain"),
    Column("grain_density", "kg/m^3", "density of a grain"),
    Column("pull_off_force", "N", "F_c"),
    Column("overlap", "m", "delta_0, the overlap at equilibrium"),
    Column("offset", "m", "d(0) + 2 r, by which the centres of mass are closer than the spheres' centres by chance"),
    Column("d_max", "m", "largest compression length of the first compression"),
    Column("d_max_error", "m", "its error, see measures.compression.Maximum"),
    Column("exceeded", "", "whether d grows beyond it later", kind="b"),
    Column("t_max", "s", "time of d_max"),
    Column("t_max_error", "s", "its error"),
    Column("inner_coordination", "", f"the same of the grains {SKIN:g} r below the surface", gaps=True),
    Column(
        "zone_filling",
        "",
        f"grains per volume in the two zones that meet, {DEPTH:g} R deep and {WIDTH:g} R in radius about the contact poles, "
        "over that of the whole aggregates; mean of the two",
        gaps=True,
    ),
    *COLLISION_COLUMNS,
)


def measure(run):
    """{column: value} of a RunFolder of A24's scene that has ended. NotMeasured where the grains are not A24's, or the
    aggregates never met or never turned around, RunFolderError where something is missing."""
    require_papers_grains(run)
    history = run.history
    maximum, exceeded = largest_compression(run)
    scene = _scene(run)
    start, radius, grain_radius = run.start, scene["radius"], scene["grain_radius"]
    # The spheres stand at -+(R + r) on the collision axis (A24 section 3).
    places = np.array([-1.0, 1.0])[start.aggregate] * (radius + grain_radius)
    centres = np.stack([places, 0.0 * places, 0.0 * places], axis=1)
    return {
        **scene,
        "offset": float(history["d"][0]) + 2.0 * grain_radius,
        "d_max": maximum.length,
        "d_max_error": maximum.length_error,
        "exceeded": exceeded,
        "t_max": maximum.time,
        "t_max_error": maximum.time_error,
        "inner_coordination": inner_coordination(
            start.position, start.contact_pairs, centres, radius - SKIN * grain_radius
        ),
        "zone_filling": zones_that_meet(start.position, start.aggregate, radius, grain_radius),
        **collision_values(run, scene["velocity"], maximum.time),
    }


def zones_that_meet(position, aggregate, radius, grain_radius):
    """Filling of the two zones that meet over that of the aggregates, mean of the two: positions (N,3) [m] before the aggregates, (N,) 0 or
    1, touch; radius of an aggregate and of a grain [m]; their centres stand at -+(R + r) on the x axis."""
    found = []
    for number, side in ((0, 1.0), (1, -1.0)):
        centre = np.array([-side * (radius + grain_radius), 0.0, 0.0])
        found.append(zone_filling(position[aggregate == number], centre, radius, side))
    return float(np.mean(found))


def _scene(run):
    """The columns that say what collided."""
    parameters = run.parameters
    names = {
        "radius": "aggregateRadius",
        "grain_radius": "grainRadius",
        "grain_density": "density",
        "pull_off_force": "pullOffForce",
        "overlap": "equilibriumOverlap",
    }
    constants = derived_constants(run, names)
    try:
        # Runs of earlier versions have no key for what was not there to be changed.
        changes = {name: float(parameters.get(name, usual)) for name, usual in UNCHANGED.items()}
        duration = float(parameters.get("duration") or run.history["time"][-1])
    except (TypeError, ValueError) as error:
        raise RunFolderError(f"{run.path}: cannot be measured: {error}") from None
    given = {"filling": float(parameters["filling"]), "velocity": float(parameters["velocity"])}
    return {**given, "seed": int(parameters["seed"]), **changes, "duration": duration, **constants}
