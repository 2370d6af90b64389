"""CPE aggregates beside spheres cut out of compressed cells (Oshiro et al. 2025), at the same filling factor, size and velocity."""

import numpy as np

from ...runs.collect import Scene
from ...runs.table import Column
from ...theory import ICE
from ...theory.aggregates import bcca_strength
from ...theory.andrews import stress_if_rigid
from .. import collisions, grains
from ..columns import MATERIAL, VELOCITY, group, one
from ..definition import NotMeasured, Quantity, Study
from ..estimate import combine
from ..runs import Runs, each, ratios, select

BY = ("of", "step", "nominal", "radius", "velocity", "kind")
KEY = ("compressed", "nominal", "radius", "pair", "step", *grains.OF_GRAINS)


def _packings(run, row):
    """NotMeasured where the packings are no such spheres."""
    given, abouts = run.parameters, [run.derived.get(f"{name}Packing") or {} for name in ("target", "projectile")]
    try:
        if given["packing"] == "cpe":
            radius, filling = given["radius"] * float(run.derived["grainRadius"]), float(given["filling"])
            return 0, int(given["seed"]), filling, filling, radius
        cell, nominal, radius = (abouts[0][name] for name in ("cell", "nominal", "aggregateRadius"))
        return 1, int(cell), float(nominal), sum(float(about["filling"]) for about in abouts) / 2, float(radius)
    except (KeyError, TypeError, ValueError):
        raise NotMeasured(f"{run.path}: neither CPE aggregates nor spheres cut out of compressed cells") from None


def _compression(run, row):
    """From the first touch on."""
    d, time = (float(run.history[name][np.argmax(run.history["contacts_between"] > 0)]) for name in ("d", "time"))
    maximum, _ = collisions.largest_compression(run)
    return maximum.length - d, maximum.time - time


MEASURED = (
    group(
        _packings,
        Column("compressed", "", "1: cut out of a compressed cell, 0: CPE", kind="i"),
        Column("pair", "", "number of the pair: the packings' seed (CPE) or that of their cell", kind="i"),
        Column("nominal", "", "filling factor that was asked for"),
        Column("filling", "", "filling factor N (r/R)^3, mean of both aggregates"),
        Column("radius", "m", "R, of the sphere that holds all centres"),
    ),
    VELOCITY,
    one("step", "t0", "time step", lambda run: float(run.derived["timeStep"]) / float(run.derived["timeUnit"])),
    MATERIAL,
    *grains.GRAINS,
    group(
        _compression,
        Column("compression", "m", "d_max less d at the first touch: how much nearer the halves come"),
        Column("t_max", "s", "time of d_max after the first touch"),
    ),
    *collisions.COMPACT,
)


def quantities(table):
    """Quantities of a table of runs (MEASURED): both kinds of aggregates side by side."""
    kind = np.where(table.compressed == 1, "compressed", "CPE")
    of, r = [grains.grains_text(row) for row in table.to_dict("records")], table.grainRadius
    in_radii = {"compression": table.compression / r, "radius": (table.radius / r).round(6)}
    runs = Runs(table.assign(kind=kind, of=of, **in_radii), "pair", ("kind",))
    compression = runs.estimates("compression", BY)
    over = ratios(select(compression, kind="compressed"), select(compression, kind="CPE"))
    yield Quantity("contacts", "contacts of a grain", runs.estimates("coordination", BY))
    yield Quantity("compression", "compression from the first touch to d_max", compression, "r")
    yield Quantity("compression_ratio", "the same, compressed over CPE", over)
    yield from _stresses(compression, over * over)
    yield Quantity("t_max", "time of d_max after the first touch", runs.estimates("t_max", BY), "ns")
    yield from collisions.energy_quantities(runs, BY, "lost", "channels")
    meaning = "kinetic energy in the relative motion of the halves at its largest after t_max, of K(0)"
    yield Quantity("returned", meaning, runs.estimates(lambda t: (t.return_speed / t.velocity) ** 2, BY), "%")
    yield Quantity("return_time", "its time", runs.estimates("return_time", BY), "ns")
    yield from collisions.outcome_quantities(runs, BY)


def _stresses(compression, of_kind):
    """Yield stresses of rigid-plastic spheres in place of aggregates of ice: what the collision adds to them, and the kind of aggregate."""

    def over_static(depth, step, filling, radius, velocity, kind):
        stress = lambda d: stress_if_rigid(d / (0.5 * radius), velocity, filling * ICE.density)
        return combine(lambda d: stress(d) / bcca_strength(filling), depth)

    over = each(select(compression, of="ice"), over_static)
    meaning = "yield stress, were they rigid-plastic spheres (A24 eq 31), over that of quasistatic compression of BCCA aggregates (eq 44)"
    yield Quantity("over_static", meaning, over)
    yield Quantity("stress_ratio", "the same, CPE over compressed: the square of compression_ratio", of_kind)
    of_collision = select(over, kind="compressed")
    meaning = "over_static of compressed aggregates over stress_ratio: above 1 where the collision raises the yield stress more than the kind does"
    yield Quantity("collision_over_kind", meaning, ratios(of_collision, select(of_kind, of="ice")))


STUDY = Study(
    title="Collisions of close-packed and of compressed aggregates",
    question="Do compressed aggregates collide as close-packed and extracted (CPE) ones of the same filling factor do?",
    scene=Scene("the study of CPE and compressed aggregates", collisions.HEAD_ON_ICE, ("velocity",), measured=KEY),
    measured=MEASURED,
    quantities=quantities,
)
