"""One row of numbers for each collision."""

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

COLUMNS = (
    Column("compressed", "", "1: cut out of a compressed cell, 0: CPE", kind="i"),
    Column("nominal", "", "filling factor that was asked for"),
    Column("filling", "", "filling factor N (r/R)^3, mean of both aggregates"),
    Column("radius", "m", "R, of the sphere that holds all centres"),
    Column("velocity", "m/s", "collision velocity"),
    Column("pair", "", "number of the pair: the packings' seed (CPE) or that of their cell", kind="i"),
    Column("grain_radius", "m", "radius of a grain"),
    Column("coordination", "", "mean number of contacts of a grain at the start"),
    Column("d_max", "m", "largest compression length of the first compression, 2 R less the distance of the halves"),
    Column("t_max", "s", "its time after the first touch"),
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
    touch = float(history["time"][history["contacts_between"] > 0][0])
    return {
        **scene,
        "coordination": mean_coordination(len(start.radius), start.contact_pairs),
        "d_max": maximum.length + shift,
        "t_max": maximum.time - touch,
        "closure": closure(history),
        **outcome_values(run, scene["velocity"]),
        **returned,
        **energy_partition(history, maximum.time, returned["return_time"]),
    }


def _scene(run):
    """The columns that say what collided."""
    grain_radius = derived_constants(run, {"r": "grainRadius"})["r"]
    common = {"velocity": float(run.parameters["velocity"]), "grain_radius": grain_radius}
    if run.parameters["packing"] == "cpe":
        filling, radius = float(run.parameters["filling"]), float(run.parameters["radius"]) * grain_radius
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
