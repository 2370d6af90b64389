"""CPE aggregates beside spheres cut out of compressed cells (Oshiro et al. 2025), at the same filling factor, size and velocity."""

import numpy as np

from ...measures.coordination import mean_coordination
from ...measures.ledger import closure
from ...measures.of_run import derived_constants
from ...runs.arrays import RunFolderError
from ...runs.collect import Scene
from ...runs.format import LOST_CHANNELS
from ...runs.table import Column
from .. import collisions, grains
from ..definition import NotMeasured, Quantity, Study
from ..runs import Runs, ratios, select, together

COLUMNS = (
    Column("compressed", "", "1: cut out of a compressed cell, 0: CPE", kind="i"),
    Column("nominal", "", "filling factor that was asked for"),
    Column("filling", "", "filling factor N (r/R)^3, mean of both aggregates"),
    Column("radius", "m", "R, of the sphere that holds all centres"),
    Column("velocity", "m/s", "collision velocity"),
    Column("pair", "", "number of the pair: the packings' seed (CPE) or that of their cell", kind="i"),
    Column("step", "t0", "time step"),
    Column("material", "", "material of the grains", kind="O"),
    *grains.COLUMNS,
    Column("coordination", "", "mean number of contacts of a grain at the start"),
    Column("compression", "m", "d_max less d at the first touch: how much nearer the halves come"),
    Column("t_max", "s", "time of d_max after the first touch"),
    Column("closure", "", "largest error of the energy ledger over K(0)"),
    *collisions.OUTCOME_COLUMNS,
    *collisions.RETURN_COLUMNS,
    *collisions.PARTITION_COLUMNS,
)
BY = ("of", "step", "nominal", "velocity", "kind")


def measure(run):
    """{column: value} of a RunFolder that has ended. NotMeasured where the packings are no such spheres, or the aggregates have not met or not
    turned around; RunFolderError where something is missing."""
    (maximum, _), history, scene = collisions.largest_compression(run), run.history, _scene(run)
    touch, returned = int(np.argmax(history["contacts_between"] > 0)), collisions.return_values(history, maximum.time)
    return {
        **scene,
        "coordination": mean_coordination(len(run.start.radius), run.start.contact_pairs),
        "compression": maximum.length - float(history["d"][touch]),
        "t_max": maximum.time - float(history["time"][touch]),
        "closure": closure(history),
        **collisions.outcome_values(run, scene["velocity"]),
        **returned,
        **collisions.energy_partition(history, maximum.time, returned["return_time"]),
    }


def _scene(run):
    given, constants = run.parameters, derived_constants(run, {"step": "timeStep", "unit": "timeUnit"})
    abouts = [run.derived.get(f"{name}Packing") or {} for name in ("target", "projectile")]
    step, own = constants["step"] / constants["unit"], grains.grain_constants(run)
    common = {"velocity": float(given["velocity"]), "step": step, "material": str(given["material"]), **own}
    if given["packing"] == "cpe":
        filling, radius = float(given["filling"]), float(given["radius"]) * own["grainRadius"]
        found = {"compressed": 0, "pair": int(given["seed"]), "nominal": filling, "filling": filling, "radius": radius}
    elif given["packing"] == "file" and all(about.get("packing") == "compressed" for about in abouts):
        try:
            filling = sum(float(about["filling"]) for about in abouts) / 2
            nominal, radius = (float(abouts[0][name]) for name in ("nominal", "aggregateRadius"))
            pair = int(abouts[0]["cell"])
        except (KeyError, TypeError, ValueError) as error:
            raise RunFolderError(f"{run.path}: cannot be measured: {error} of its packings") from None
        found = {"compressed": 1, "pair": pair, "nominal": nominal, "filling": filling, "radius": radius}
    else:
        raise NotMeasured(f"{run.path}: neither CPE aggregates nor spheres cut out of compressed cells")
    return {**common, **found}


def quantities(table):
    """Quantities of a table of runs (COLUMNS), CPE and compressed aggregates side by side."""
    kind = np.where(table.compressed == 1, "compressed", "CPE")
    table = table.assign(kind=kind, of=[grains.grains_text(row) for row in table.to_dict("records")])
    runs = Runs(table, "pair", ("kind",))
    until = lambda t: sum(t[collisions.at_maximum(channel)] for channel in LOST_CHANNELS)
    for name, meaning, values, unit, scale in (
        ("contacts", "contacts of a grain", "coordination", "", 1.0),
        ("compression", "compression from the first touch to d_max", lambda t: t.compression / t.grainRadius, "r", 1.0),
        ("t_max", "time of d_max after the first touch", "t_max", "ns", 1e-9),
        ("lost", "dissipated until t_max, of K(0)", until, "%", 0.01),
    ):
        found = runs.estimates(values, BY)
        yield Quantity(name, meaning, found, unit, scale)
        over = ratios(select(found, kind="compressed"), select(found, kind="CPE"))
        yield Quantity(f"{name}_ratio", f"{meaning}: compressed over CPE", over)
    meaning = "change of each channel until t_max, of K(0)"
    yield collisions.channel_quantity(runs, BY, collisions.at_maximum, "channels", meaning)
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
