"""The study of A24's collisions: which quantities the runs tell. A pair of aggregates has a filling factor and a radius; it may collide at
several velocities, with one thing changed, or for longer, and counts once in every estimate."""

import numpy as np
import pandas

from ...measures.outcome import STICKING, UNDECIDED
from ...runs.collect import Scene
from ...theory.aggregates import bcca_strength, bulk_modulus, cpe_coordination, poisson_ratio
from ...theory.andrews import stress_if_rigid, young_if_elastic
from ..collisions import HEAD_ON_ICE, energy_quantities, outcome_quantities
from ..curves import power
from ..definition import Quantity, Study
from ..estimate import combine, exact
from ..runs import Runs, along, differences, each, finite, select, together
from . import andrews_fit as fits
from .measure import MEASURED, UNCHANGED
from .zones import FEWEST_PAIRS, zone_correlation

PAIR = ("filling", "radius")
POINT = (*PAIR, "velocity")
BY_SIZE, PAPERS, FREE = "A24's way", "A24's δ_offset", "all three free"  # how delta_offset is found
NUMBERS = ("σ", "1/E*", "δ_offset")
DEPTH_AND_TIME = (("d", "d_max", "r"), ("t_max", "t_max", "ns"))


def quantities(table):
    """Quantities of a table of runs (measure.MEASURED)."""
    table = in_grain_radii(table)
    same = np.logical_and.reduce([table[name] == usual for name, usual in UNCHANGED.items()])
    runs, grain = Runs(once(table[same]), "seed", PAIR), table.iloc[0]  # all of one material
    one_velocity = runs.where(velocity=fits.VELOCITY)
    yield Quantity("d_max", "largest compression length", runs.estimates("d", POINT), "r")
    yield Quantity("t_max", "its time", runs.estimates("t_max", POINT), "ns")
    yield from _sizes(one_velocity, grain)
    yield from _moduli(runs, grain)
    yield from _times(runs, grain)
    yield from _return(runs)
    yield from _packings(one_velocity)
    yield from _changes(table, same)


def in_grain_radii(table):
    """The table with radius and d (d_max) in grain radii; velocity and duration to the digits that tell them apart."""
    return table.assign(
        radius=(table.radius / table.grain_radius).round(3),
        d=table.d_max / table.grain_radius,
        velocity=table.velocity.round(6),
        duration=table.duration.round(8),
    )


def once(table):
    """Of a pair's runs at one velocity only that which was followed for longest."""
    return table.sort_values("duration", kind="stable").drop_duplicates([*POINT, "seed"], keep="last").sort_index()


def _sizes(runs, grain):
    """The straight line of d_max against size at A24's velocity, and what follows from its delta_max/R*."""
    several = runs.where(lambda t: t.groupby("filling").radius.transform("nunique") > 1)
    line = several.fit(fits.size_line, ("c1", "c2", "δ_offset", "δ_max/R*", "d_max at 60 r"), ("filling",), fitted=2)
    meaning = "d_max = c1 R - c2 at 3.2 m/s (A24 eq 14), δ_offset and δ_max/R* (eqs 18, 19); lengths in grain radii"
    yield Quantity("line", meaning, line)
    ends = {
        "σ, rigid-plastic": lambda x, rho: stress_if_rigid(x, fits.VELOCITY, rho),
        "E*, elastic": lambda x, rho: young_if_elastic(x, fits.VELOCITY, rho),
        "σ, from which elastic": lambda x, rho: fits.elastic_stress(x, young_if_elastic(x, fits.VELOCITY, rho)),
    }
    ratio = select(line, number="δ_max/R*")
    end = lambda f: each(ratio, lambda e, filling: combine(lambda x: f(x, filling * grain.grain_density), e))
    values = together({name: end(f) for name, f in ends.items()}, "end")
    yield Quantity("ends", "ends of the curve of (σ, E*) with that δ_max/R* (A24 Fig. 10)", values, "MPa")


def _moduli(runs, grain):
    """Yield stress, E* and delta_offset of Andrews's spheres."""
    ways = {BY_SIZE: fits.papers_way, PAPERS: fits.papers_offset, FREE: fits.fit_moduli}
    found = together({way: runs.fit(f, NUMBERS, ("filling",)) for way, f in ways.items()}, "fit")
    found = finite(found)
    stress, compliance, offset = (select(found, number=number) for number in NUMBERS)
    yield Quantity("stress", "yield stress σ", stress, "MPa")
    yield Quantity("compliance", "1/E*; 0: rigid-plastic", compliance, "1/GPa")
    yield Quantity("offset", "δ_offset", offset, "r")
    yield from _exponents(runs, grain, offset)
    yield from _constants(runs, grain, stress, compliance)
    yield from _of_fit(runs, grain, select(found, fit=FREE))
    yield from _restitution(runs, grain, select(found, fit=BY_SIZE))


def _exponents(runs, grain, offset):
    """How tau_max goes with the velocity: rigid-plastic spheres have 0, elastic ones -1/5 (A24 eqs 32, 33); and with the size."""
    times, found, of_size = runs.estimates("t_max", POINT), {}, {}
    for way in offset.index.unique("fit"):
        own = select(offset, fit=way)
        contact = lambda filling, v: combine(lambda x: fits.time_of_contact(x, v, grain.grain_radius), own[filling])
        tau = each(_at_fillings_of(own, times), lambda t, filling, radius, v: t - contact(filling, v))
        found[way] = along(tau, "velocity", power)
        of_size[way] = along(select(tau, velocity=fits.VELOCITY), "radius", power)
    meaning = "exponent of τ_max as a power of the velocity, by how δ_offset is found; 0: rigid-plastic, -0.2: elastic"
    yield Quantity("trend", meaning, finite(together(found, "fit", ("filling",))))
    meaning = "exponent of τ_max at 3.2 m/s as a power of the radius, by how δ_offset is found; 1: proportional (A24 section 4.2.1)"
    yield Quantity("size_trend", meaning, finite(together(of_size, "fit", ("filling",))))


def _constants(runs, grain, stress, compliance):
    """What A24's section 5 makes of sigma and E*."""
    ratio = each(stress, lambda e, filling, fit: e / bcca_strength(filling))
    yield Quantity("over_quasistatic", "σ over that of quasistatic compression of BCCA aggregates (A24 eq 44)", ratio)
    counted = runs.estimates("inner_coordination", ("filling",))
    lengths = grain.grain_radius, grain.overlap
    sites = lambda filling: cpe_coordination(filling, *lengths)
    bulk = lambda filling: bulk_modulus(filling, sites(filling), *lengths, grain.pull_off_force)
    both = {"counted inside": counted, "A24 eq 39": each(counted, lambda _, filling: exact(sites(filling)))}
    yield Quantity("coordination", "contacts of a grain", together(both, "how"))
    modulus = each(counted, lambda _, filling: exact(bulk(filling)))
    yield Quantity("bulk_modulus", "K_agg (A24 eq 41)", modulus, "MPa")
    ratio = lambda e, filling, fit: combine(lambda k: poisson_ratio(1.0 / np.maximum(k, 1e-15), bulk(filling)), e)
    yield Quantity("poisson", "ν_agg from E* and K_agg (A24 eq 42)", each(compliance, ratio))


def _of_fit(runs, grain, fit):
    """What a fit (Series of NUMBERS by filling) leaves of the runs."""
    for k, (column, name, unit) in enumerate(DEPTH_AND_TIME):
        less = lambda e, filling, *place: _of_spheres(lambda model, y: y - model.at(*place)[k], grain, fit, filling, e)
        values = each(_at_fillings_of(fit, runs.estimates(column, POINT)), less)
        yield Quantity(f"{name}_beyond", f"{name} less that of Andrews's spheres, {FREE}", values, unit)


def _restitution(runs, grain, fit):
    """The coefficient of restitution of Andrews's spheres as in a fit, and with the moduli of A24."""
    points = runs.estimates("d", ("filling", "velocity"))
    ours = lambda _, filling, v: _of_spheres(lambda model: model.restitution(v), grain, fit, filling)
    theirs = lambda _, filling, v: exact(fits.printed(filling, grain).restitution(v))
    printed = select(points, filling=tuple(fits.PRINTED))
    e = together({BY_SIZE: each(_at_fillings_of(fit, points), ours), "A24's σ, E*": each(printed, theirs)}, "fit")
    yield Quantity("andrews", "restitution of Andrews's spheres, and its square", together({"e": e, "e²": e * e}, "of"))


def _at_fillings_of(fit, series):
    return select(series, filling=tuple(fit.index.unique("filling")))


def _of_spheres(f, grain, fit, filling, *more):
    """Estimate of f(Aggregates as fitted at a filling, numbers of other estimates)."""
    density = filling * grain.grain_density
    g = lambda *numbers: f(fits.Aggregates(*numbers[:3], density, grain.grain_radius), *numbers[3:])
    return combine(g, *select(fit, filling=filling), *more)


def _times(runs, grain):
    """t_max beside A24's fitted model."""
    parts = []
    for filling, own in runs.table[runs.table.filling.isin(fits.PRINTED)].groupby("filling"):
        model = fits.printed(filling, grain)
        d, t = model.at(own.radius, own.velocity)
        parts.append(own.assign(deeper=own.d - d, late=own.t_max - t))
    beside = runs.of(pandas.concat(parts) if parts else runs.table[:0].assign(deeper=0.0, late=0.0))
    yield Quantity("deeper", "d_max less that of A24's fitted model", beside.estimates("deeper", POINT), "r")
    yield Quantity("late", "t_max less that of A24's fitted model", beside.estimates("late", POINT), "ns")
    means = "as they are", "with A24's d_max"
    line = beside.where(velocity=fits.VELOCITY).fit(lateness, means, ("filling",))
    yield Quantity("late_mean", "the same at 3.2 m/s, mean over the pairs of all sizes", line, "ns")


def lateness(rows, weights):
    """(B, 2): means of late, as it is and where deeper is 0: by a straight line through all pairs."""
    late = rows.late.to_numpy()
    _, with_papers_depth = fits.straight_line(rows.deeper.to_numpy(), late, weights)
    return np.stack([weights @ late / weights.sum(axis=1), with_papers_depth], axis=1)


def _return(runs):
    """What comes back after the largest compression, how collisions end, and where the energy has gone until t_max."""
    share = {"e": lambda t: t.return_speed / t.velocity, "e²": lambda t: (t.return_speed / t.velocity) ** 2}
    meaning = "largest speed at which the halves part over the collision velocity, and its square, the kinetic energy over K(0); the first runs don't have it"
    yield Quantity("rebound", meaning, runs.parts(share, POINT, "of"))
    yield Quantity("return_time", "its time", runs.estimates("return_time", POINT), "ns")
    ended = (*POINT, "duration")
    yield from (own for own in outcome_quantities(runs, ended) if own.name in ("sticking", "restitution"))
    together_at_end = runs.fractions(lambda t: t.outcome.isin((STICKING, UNDECIDED)), ended)
    yield Quantity("in_one_piece", "runs in one piece when they end (A24: at 1 µs)", together_at_end)
    yield from energy_quantities(runs, POINT, "dissipated", "energy")


def _packings(runs):
    """How far the filling of the zones that meet, which the packings alone give, tells d_max."""
    names, known = ("correlation", "slope", "explained"), runs.table[runs.table.zone_filling.notna()]
    for name, by, sizes in (("zones", ("filling",), known.radius.nunique()), ("zones_by_size", PAIR, 1)):
        enough = known.groupby(list(by)).seed.transform("size") >= sizes + FEWEST_PAIRS
        values = runs.of(known[enough]).fit(zone_correlation, names, by, fitted=sizes + 1)
        meaning = "d_max against R times the filling of the zones that meet, about the means of the sizes"
        yield Quantity(name, meaning, finite(values))


def _changes(table, same):
    """Runs with one thing changed less the same pairs without."""
    words = [change(*own) for own in table[list(UNCHANGED)].itertuples(index=False)]
    table = table.assign(changed=words)
    both = Runs(pandas.concat([once(table[same]), table[~same]]), "seed", PAIR)
    meaning = "with one thing changed less that of the same pairs without"
    for column, name, unit in DEPTH_AND_TIME:
        values = both.beside("changed", "", column, POINT, differences, same_pairs=True).sort_index()
        yield Quantity(f"{name}_change", f"{name} {meaning}", values, unit)


def change(drag, remove, overlap):
    """What differs from A24's collisions (values of UNCHANGED), in words.

    >>> change(3e-12, 0.0, 1.0), change(0.0, 1.0, 0.5)
    ('drag, T_vis = 3 ps', 'loose grains left out, neighbours with 0.5 of the overlap')
    """
    parts = [f"drag, T_vis = {drag * 1e12:g} ps"] if drag else []
    parts += ["loose grains left out"] if remove else []
    parts += [f"neighbours with {overlap:g} of the overlap"] if overlap != 1 else []
    return ", ".join(parts)


STUDY = Study(
    title="Arakawa et al. (2024): collisions of elastoplastic aggregates",
    question="Do equal close-packed aggregates that collide head on compress like elastoplastic spheres (Andrews 1930), and with which yield "
    "stress and elastic modulus?",
    # Head-on collisions of CPE aggregates without bonds, springs held at their limits.
    scene=Scene(
        name="the study of Arakawa et al. (2024)",
        values={"packing": "cpe", **{name: value for name, value in HEAD_ON_ICE.items() if name not in UNCHANGED}},
        numbers=("filling", "radius", "velocity", "seed"),
        measured=(*UNCHANGED, "duration"),
    ),
    measured=MEASURED,
    quantities=quantities,
)
