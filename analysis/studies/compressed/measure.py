"""One row of numbers for each collision."""

import numpy as np

from ...measures.coordination import mean_coordination
from ...measures.ledger import closure
from ...measures.of_run import derived_constants
from ...runs.arrays import RunFolderError
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
from ..definition import NotMeasured
from ..grains import COLUMNS as GRAIN_COLUMNS
from ..grains import grain_constants

COLUMNS = (
    Column("compressed", "", "1: cut out of a compressed cell, 0: CPE", kind="i"),
    Column("nominal", "", "filling factor that was asked for"),
    Column("filling", "", "filling factor N (r/R)^3, mean of both aggregates"),
    Column("radius", "m", "R, of the sphere that holds all centres"),
    Column("velocity", "m/s", "collision velocity"),
    Column("pair", "", "number of the pair: the packings' seed (CPE) or that of their cell", kind="i"),
    Column("step", "t0", "time step"),
    Column("material", "", "material of the grains", kind="O"),
    *GRAIN_COLUMNS,
    Column("coordination", "", "mean number of contacts of a grain at the start"),
    Column("d_max", "m", "largest compression length of the first compression, 2 R less the distance of the halves"),
    Column("d_touch", "m", "compression length at the first touch: surfaces are rough, and 2 R is from centres"),
    Column("compression", "m", "d_max less d_touch: how much nearer the halves come from the first touch on"),
    Column("t_max", "s", "time of d_max after the first touch"),
    Column("closure", "", "largest error of the energy ledger over K(0)"),
    *OUTCOME_COLUMNS,
    *RETURN_COLUMNS,
    *PARTITION_COLUMNS,
)


def measure(run):
    """{column: value} of a RunFolder that has ended. NotMeasured where the packings are no such spheres, or the aggregates
    have not met or not turned around; RunFolderError where something is missing."""
    history = run.history
    maximum, _ = largest_compression(run)
    scene, start = _scene(run), run.start
    returned = return_values(history, maximum.time)
    # A run's d is from the sphere around its centres, which is a little smaller than the one that was cut.
    shift = 2.0 * (scene["radius"] - derived_constants(run, {"R": "aggregateRadius"})["R"])
    touch = int(np.argmax(history["contacts_between"] > 0))
    d_max, d_touch = maximum.length + shift, float(history["d"][touch]) + shift
    return {
        **scene,
        "coordination": mean_coordination(len(start.radius), start.contact_pairs),
        "d_max": d_max,
        "d_touch": d_touch,
        "compression": d_max - d_touch,
        "t_max": maximum.time - float(history["time"][touch]),
        "closure": closure(history),
        **outcome_values(run, scene["velocity"]),
        **returned,
        **energy_partition(history, maximum.time, returned["return_time"]),
    }


def _scene(run):
    """The columns that say what collided."""
    constants = derived_constants(run, {"step": "timeStep", "unit": "timeUnit"})
    common = {
        "velocity": float(run.parameters["velocity"]),
        "step": constants["step"] / constants["unit"],
        "material": str(run.parameters["material"]),
        **grain_constants(run),
    }
    if run.parameters["packing"] == "cpe":
        filling, radius = float(run.parameters["filling"]), float(run.parameters["radius"]) * common["grainRadius"]
        pair = {"pair": int(run.parameters["seed"]), "nominal": filling}
        return {**common, "compressed": 0, **pair, "filling": filling, "radius": radius}
    abouts = [run.derived.get(f"{name}Packing") or {} for name in ("target", "projectile")]
    if run.parameters["packing"] != "file" or any(about.get("packing") != "compressed" for about in abouts):
        raise NotMeasured(f"{run.path}: neither CPE aggregates nor spheres cut out of compressed cells")
    try:
        found = [float(about["filling"]) for about in abouts]
        first = abouts[0]
        pair = {"pair": int(first["cell"]), "nominal": float(first["nominal"])}
        return {
            **common,
            "compressed": 1,
            **pair,
            "filling": sum(found) / 2,
            "radius": float(first["aggregateRadius"]),
        }
    except (KeyError, TypeError, ValueError) as error:
        raise RunFolderError(f"{run.path}: cannot be measured: {error} of its packings") from None
