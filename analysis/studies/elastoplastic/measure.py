"""One row of numbers for each collision: what the fits, tables and figures are made of."""

import numpy as np

from ...measures.compression import compression_by_aggregate, compression_length
from ...measures.coordination import inner_coordination, mean_coordination
from ...measures.ledger import closure
from ...measures.of_run import derived_constants
from ...runs.table import Column
from ..collision_points import (
    OUTCOME_COLUMNS,
    PARTITION_COLUMNS,
    RETURN_COLUMNS,
    energy_partition,
    largest_compression,
    outcome_values,
    return_values,
)
from ..grains import require_papers_grains
from .start import COLUMNS as START_COLUMNS
from .start import start_values

# Grains deeper than this below the sphere that holds all centres have all their neighbours' sites in it.
SKIN = 2.0  # grain radii

COLUMNS = (
    Column("filling", "", "filling factor"),
    Column("radius", "m", "radius of an aggregate"),
    Column("velocity", "m/s", "collision velocity"),
    Column("seed", "", "random seed of the pair of aggregates", kind="i"),
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
    Column("label_d_max", "m", "d_max with each aggregate's own grains in place of A24's x > 0 and x < 0", gaps=True),
    *OUTCOME_COLUMNS,
    Column("coordination", "", "mean number of contacts of a grain at the start"),
    Column("inner_coordination", "", f"the same of the grains {SKIN:g} r below the surface", gaps=True),
    Column("closure", "", "largest error of the energy ledger over K(0)"),
    *START_COLUMNS,
    *RETURN_COLUMNS,
    *PARTITION_COLUMNS,
)


def measure(run):
    """{column: value} of a RunFolder of A24's scene that has ended. NotMeasured where the grains are not A24's, or the
    aggregates never met or never turned around, RunFolderError where something is missing."""
    require_papers_grains(run)
    history = run.history
    maximum, exceeded = largest_compression(run)
    scene = _scene(run)
    start, r = run.start, scene["grain_radius"]
    returned = return_values(history, maximum.time)
    return {
        **scene,
        "offset": float(history["d"][0]) + 2.0 * r,
        "d_max": maximum.length,
        "d_max_error": maximum.length_error,
        "exceeded": exceeded,
        "t_max": maximum.time,
        "t_max_error": maximum.time_error,
        "label_d_max": maximum.length + _label_difference(run, maximum.time, scene["radius"]),
        **outcome_values(run, scene["velocity"]),
        "coordination": mean_coordination(len(start.radius), start.contact_pairs),
        "inner_coordination": _inner_coordination(start, scene["radius"], r),
        "closure": closure(history),
        **start_values(start.position, start.aggregate, start.contact_pairs, scene["radius"], r),
        **returned,
        **energy_partition(history, maximum.time, returned["return_time"]),
    }


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
    given = {"filling": float(parameters["filling"]), "velocity": float(parameters["velocity"])}
    return {**given, "seed": int(parameters["seed"]), **constants}


def _label_difference(run, time, radius):
    """What d by the label has over d by the sign of x at `time` [m]: between the states before and after it."""
    times = run.states.times
    after = int(np.clip(np.searchsorted(times, time), 1, len(times) - 1)) if len(times) > 1 else 0
    around = sorted({max(after - 1, 0), after})
    differences = []
    for k in around:
        arrays = run.states.arrays(k, ("position", "aggregate"))
        x = arrays["position"][:, 0]
        differences.append(compression_by_aggregate(x, arrays["aggregate"], radius) - compression_length(x, radius))
    return float(np.interp(time, times[around], differences))


def _inner_coordination(start, radius, grain_radius):
    # The spheres stand at -+(R + r) on the collision axis (A24 section 3).
    x = np.where(start.aggregate == 1, 1.0, -1.0) * (radius + grain_radius)
    centres = np.stack([x, 0.0 * x, 0.0 * x], axis=1)
    return inner_coordination(start.position, start.contact_pairs, centres, radius - SKIN * grain_radius)
