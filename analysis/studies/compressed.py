"""The collision of Arakawa et al. (2024, A24) with compressed aggregates in place of close-packed and extracted (CPE)
ones: spheres cut out of compressed cells, as Oshiro et al. (2025) make theirs, at the same filling factor, size and
velocity."""

from functools import partial

import numpy as np

from ..measures.compression import largest_return_speed
from ..measures.structure import mean_coordination
from ..runs.files import RunFolderError
from ..runs.format import CHANNELS, HISTORY_FILE, LABELS
from ..runs.ledger import fractions_at, initial_kinetic_energy
from ..runs.measured import maximum_of_run, met
from ..theory import ICE
from ..theory.aggregates import bcca_strength
from ..theory.andrews import stress_if_rigid
from . import columns
from .columns import CLOSURE, OUTCOME, Column, NotMeasured, grains_text, group, one
from .comparison import Row
from .estimates import beside, estimate, mean
from .figures import curves
from .study import Study

KINDS = ("compressed", "CPE")


# ---- what this study and that of A24 have in common ----

AT_MAXIMUM = "{}_at_maximum"  # the column of a channel's change from the start to t_max
# Parameters of the collisions of Arakawa et al. (2024), but for the packing.
HEAD_ON_ICE = {"impact": 0.0, "viscoelasticTime": 0.0, "neck": 0.0, "planar": 0, "limit": "held", "material": "ice"}
HEAD_ON_ICE |= {"removeLooseGrains": 0, "initialOverlap": 1.0}


def largest_compression(run):
    """measures.compression.Maximum of a RunFolder's first compression. NotMeasured where the aggregates never met or
    never turned around, RunFolderError where they had no kinetic energy."""
    maximum = maximum_of_run(run)
    if maximum is None or not maximum.inside or not met(run):
        raise NotMeasured(f"{run.path}: the aggregates have not met, or not turned around")
    if not initial_kinetic_energy(run.history) > 0:
        raise RunFolderError(f"{run.path / HISTORY_FILE}: no kinetic energy at the start")
    return maximum


def _return(run, row):
    """NaN where the halves never part, or the record ends before their speed falls."""
    return largest_return_speed(run.history["time"], run.history["v"], largest_compression(run).time)


_contacts = lambda run: mean_coordination(len(run.start.radius), run.start.contact_pairs)
COMPACT = (  # without gaps last, so that a row that was cut short is noticed
    one("coordination", "", "mean number of contacts of a grain at the start", _contacts),
    CLOSURE,
    OUTCOME,
    group(
        _return,
        Column("return_speed", "m/s", "largest speed at which the halves part after t_max", gaps=True),
        Column("return_time", "s", "its time", gaps=True),
    ),
    group(
        lambda run, row: fractions_at(run.history, largest_compression(run).time).values(),
        *(
            Column(AT_MAXIMUM.format(c), "K(0)", f"{LABELS[c]}, change until t_max (kinetic: what is left)")
            for c in CHANNELS
        ),
    ),
)

# ---- what is this study's own ----


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
    maximum = largest_compression(run)
    return maximum.length - d, maximum.time - time


MEASURED = (
    group(
        _packings,
        Column("compressed", "", "1: cut out of a compressed cell, 0: CPE", kind="i"),
        Column("pair", "", "number of the pair: the packings' seed (CPE) or that of their cell", kind="i"),
        Column("nominal", "", "nominal filling factor"),
        Column("filling", "", "filling factor N (r/R)^3, mean of both aggregates"),
        Column("radius", "m", "R, of the sphere that holds all centres"),
    ),
    columns.VELOCITY,
    one("step", "t0", "time step", lambda run: float(run.derived["timeStep"]) / float(run.derived["timeUnit"])),
    columns.MATERIAL,
    *columns.GRAINS,
    group(
        _compression,
        Column("compression", "m", "d_max less d at the first touch: how much nearer the halves come"),
        Column("t_max", "s", "time of d_max after the first touch"),
    ),
    *COMPACT,
)


def prepared(runs):
    """The table with the kind of aggregates, and lengths in grain radii."""
    return runs.assign(
        kind=np.where(runs.compressed == 1, *KINDS),
        of=[grains_text(row) for row in runs.to_dict("records")],
        radius=(runs.radius / runs.grainRadius).round(6),
        step=runs.step.round(9),
        depth=runs.compression / runs.grainRadius,
    )


def over_static(runs):
    """Yield stress, were they rigid-plastic spheres (A24 eq 31, R* = R/2), over that of quasistatic compression of BCCA
    aggregates (eq 44)."""
    place = runs.iloc[0] if len(runs) else dict.fromkeys(("radius", "velocity", "nominal"), np.nan)
    ratio = mean("depth")(runs) / (0.5 * place["radius"])
    density = place["nominal"] * ICE.density
    return stress_if_rigid(ratio, place["velocity"], density) / bcca_strength(place["nominal"])


def rows(runs):
    """Both kinds of aggregates at each place: what the collision adds to the static yield stress, and what the kind
    does."""
    for (of, step, nominal, radius, velocity), own in runs.groupby(["of", "step", "nominal", "radius", "velocity"]):
        kinds = [own[own.kind == kind] for kind in KINDS]
        usual = of == "ice" and np.isclose(step, 0.2) and np.isclose(radius, 20)
        place = f"φ = {nominal:g}, {velocity:.3g} m/s" + ("" if usual else f", {of}, R = {radius:g} r, {step:g} t0")
        ratio = beside(mean("depth"), *kinds, of=np.divide)
        yield Row(f"compression, compressed over CPE, {place}", ratio)
        square = beside(mean("depth"), *kinds, of=lambda a, b: (a / b) ** 2)
        yield Row(f"yield stress, CPE over compressed (the square), {place}", square)
        for kind, each in zip(KINDS, kinds):
            what = f"{kind}, {place}"
            if of == "ice":
                yield Row(f"yield stress over A24's static one, {what}", estimate(over_static, each))
            yield Row(f"compression from the first touch to d_max, {what} [r]", estimate(mean("depth"), each))
            yield Row(f"contacts of a grain, {what}", estimate(mean("coordination"), each))
            for way in ("sliding", "rolling", "twisting"):
                lost = mean(lambda r: 100 * r[AT_MAXIMUM.format(f"{way}Dissipation")])
                yield Row(f"lost by {way} until d_max, {what} [% of K(0)]", estimate(lost, each))


def figures(runs):
    """How much softer compressed aggregates are, and where the work goes."""
    ice = runs[(runs.of == "ice") & np.isclose(runs.radius, 20) & np.isclose(runs.step, 0.2)]
    ice = ice.assign(filling=[f"φ = {own:g}" for own in ice.nominal])
    look = {"log": "x", "x_label": "$v$ [m/s]"}

    def ratio(own):
        return beside(mean("depth"), *(own[own.kind == kind] for kind in KINDS), of=np.divide)

    figure = curves(ice, ratio, "velocity", "filling", y_label="compressed over CPE", level=1.0, **look)
    yield "ratio", "Compression from the first touch to d_max, compressed over CPE aggregates.", figure
    depth = partial(estimate, mean("depth"))
    figure = curves(ice, depth, "velocity", "kind", "filling", y_label="compression [$r$]", **look)
    yield "compression", "Compression from the first touch to d_max of both kinds.", figure


STUDY = Study(
    title="Collisions of close-packed and of compressed aggregates",
    question="Do compressed aggregates collide as close-packed and extracted (CPE) ones of the same filling factor do?",
    values=HEAD_ON_ICE,
    key=("velocity", "compressed", "nominal", "radius", "pair", "step", *columns.OF_GRAINS),
    measured=MEASURED,
    pair=("compressed", "pair"),
    rows=rows,
    figures=figures,
    prepared=prepared,
)
