"""CPE aggregates beside spheres cut out of compressed cells (Oshiro et al. 2025), at the same filling factor, size and velocity."""

import numpy as np

from ...measures.of_run import derived_constants
from ...runs.collect import Scene
from ...runs.format import LOST_CHANNELS
from ...runs.table import Column
from .. import collisions, grains
from ..definition import NotMeasured, Quantity, Study
from ..runs import Runs, ratios, select

COLUMNS = (
    Column("compressed", "", "1: cut out of a compressed cell, 0: CPE", kind="i"),
    Column("pair", "", "number of the pair: the packings' seed (CPE) or that of their cell", kind="i"),
    Column("nominal", "", "filling factor that was asked for"),
    Column("filling", "", "filling factor N (r/R)^3, mean of both aggregates"),
    Column("radius", "m", "R, of the sphere that holds all centres"),
    Column("velocity", "m/s", "collision velocity"),
    Column("step", "t0", "time step"),
    Column("material", "", "material of the grains", kind="O"),
    *grains.COLUMNS,
    Column("compression", "m", "d_max less d at the first touch: how much nearer the halves come"),
    Column("t_max", "s", "time of d_max after the first touch"),
    *collisions.COLLISION_COLUMNS,
)
BY = ("of", "step", "nominal", "velocity", "kind")


def measure(run):
    """{column: value} of a RunFolder that has ended. NotMeasured where the packings are no such spheres, or the aggregates have not met
    or not turned around; RunFolderError where something is missing."""
    history, scene = run.history, _scene(run)
    maximum, _ = collisions.largest_compression(run)
    d, time = (float(history[name][np.argmax(history["contacts_between"] > 0)]) for name in ("d", "time"))
    values = collisions.collision_values(run, scene["velocity"], maximum.time)
    return {**scene, "compression": maximum.length - d, "t_max": maximum.time - time, **values}


def _scene(run):
    """The columns that say what collided."""
    given, own = run.parameters, grains.grain_constants(run)
    constants = derived_constants(run, {"step": "timeStep", "unit": "timeUnit"})
    abouts = [run.derived.get(f"{name}Packing") or {} for name in ("target", "projectile")]
    if given["packing"] == "cpe":
        radius, filling = given["radius"] * own["grainRadius"], given["filling"]
        abouts = 2 * [{"cell": given["seed"], "nominal": filling, "filling": filling, "aggregateRadius": radius}]
    try:
        return {
            "compressed": int(given["packing"] != "cpe"),
            "pair": int(abouts[0]["cell"]),
            "nominal": float(abouts[0]["nominal"]),
            "filling": sum(float(about["filling"]) for about in abouts) / 2,
            "radius": float(abouts[0]["aggregateRadius"]),
            "velocity": float(given["velocity"]),
            "step": constants["step"] / constants["unit"],
            "material": str(given["material"]),
            **own,
        }
    except (KeyError, TypeError, ValueError):
        raise NotMeasured(f"{run.path}: neither CPE aggregates nor spheres cut out of compressed cells") from None


def quantities(table):
    """Quantities of a table of runs (COLUMNS): both kinds of aggregates side by side."""
    kind = np.where(table.compressed == 1, "compressed", "CPE")
    of, r = [grains.grains_text(row) for row in table.to_dict("records")], table.grainRadius
    lost = sum(table[collisions.at_maximum(channel)] for channel in LOST_CHANNELS)
    runs = Runs(table.assign(kind=kind, of=of, lost=lost, compression=table.compression / r), "pair", ("kind",))
    compression = runs.estimates("compression", BY)
    over = ratios(select(compression, kind="compressed"), select(compression, kind="CPE"))
    yield Quantity("contacts", "contacts of a grain", runs.estimates("coordination", BY))
    yield Quantity("compression", "compression from the first touch to d_max", compression, "r")
    yield Quantity("compression_ratio", "the same, compressed over CPE", over)
    yield Quantity("t_max", "time of d_max after the first touch", runs.estimates("t_max", BY), "ns", 1e-9)
    yield Quantity("lost", "dissipated until t_max, of K(0)", runs.estimates("lost", BY), "%", 0.01)
    until = "change of each channel until t_max, of K(0)"
    yield collisions.channel_quantity(runs, BY, collisions.at_maximum, "channels", until)
    yield from collisions.return_quantities(runs, BY)
    yield from collisions.outcome_quantities(runs, BY)


STUDY = Study(
    title="Collisions of close-packed and of compressed aggregates",
    question="Were close-packed and extracted (CPE) aggregates a fair stand-in for compressed ones in Arakawa et al. (2024)?",
    scene=Scene(
        name="A24's scene, or one of compressed aggregates",
        values=dict(collisions.HEAD_ON_ICE),
        numbers=("velocity",),
        measured=("compressed", "nominal", "radius", "pair", "step", *grains.OF_GRAINS),
    ),
    columns=COLUMNS,
    measure=measure,
    quantities=quantities,
)
