"""The study of K13's compressions: which quantities the runs tell. A cluster, named by its seed, is compressed in several sets of its size."""

import pandas

from ...runs.collect import Scene
from ...runs.format import COMPRESSION
from ...theory.aggregates import bcca_coordination
from ...theory.compression import compressive_strength_dense, strength_scale, tensile_strength
from ..definition import Quantity, Study
from ..grains import OF_GRAINS
from ..runs import Runs, along, finite, ratios, select, together
from .measure import DIMENSIONS, ENERGIES, ENERGY_FILLINGS, MEASURED, NUMBERS, TWISTING
from .strength import SET, VALID_TO, by_filling, exponent, furthest, level, named, with_bins

# K13's ice (section 3.1), of which one number is changed at a time.
FIDUCIAL = {
    "strain rate": ("strainRate", 3e-7),
    "damping": ("linearDamping", 0.01),
    "critical displacement": ("criticalRolling", 0.8e-9),
    "time step": ("stepFraction", 0.3),
    "number of grains": ("grains", 16_384),
}
ICE = {"material": "ice", "linearDamping": 0.01, "criticalRolling": 0.8e-9}
OF_ICE = ("stepFraction", "grains", "strainRate", "filling")
RATES = (3e-7, 1e-6, 3e-6, 1e-5)  # C_v over which clusters are averaged
WAYS = {
    "rolling": ("rollingDissipation",),
    "twisting": ("twistingDissipation",),
    "sliding": ("slidingDissipation",),
    "normal damping": ("drag",),
    "making and breaking contacts": ("connection", "disconnection"),
}
UNTIL = ENERGY_FILLINGS[1:]  # before, clusters of 1,024 grains are isolated
SPANS = [(0.0, filling) for filling in UNTIL] + list(zip(UNTIL, UNTIL[1:]))


def quantities(table):
    """Quantities of a table of runs (measure.MEASURED)."""
    table = named(table)
    clusters = furthest(table)
    runs = Runs(clusters, "seed", ("grains",))
    rows = runs.of(by_filling(clusters))
    settled = rows.where(lambda t: t.settled)
    over = rows.estimates("over", (*SET, "filling"))
    yield Quantity("strength", "pressure over K13 eq 25, (E_roll/r0^3) phi^3", over)
    yield from _power_law(settled.where(lambda t: t.shared & (t.filling <= VALID_TO)))
    yield from _any_filling(settled.where(**ICE))
    yield from _channels(runs)
    dimension = runs.parts(DIMENSIONS, SET, "filling")
    yield Quantity("dimension", "fractal dimension: slope of N(< r) between 3 and 10 grain radii", dimension)
    yield Quantity("filling_at_300", "filling factor at 300 Pa", runs.estimates("filling_at_300", SET))
    yield from _tension(runs.of(table[table.stretched_axes > 0]))


def _power_law(runs):
    """What follows from pressures at settled filling factors that K13 eq 25 is for."""
    by, of_ice = (*SET, "filling"), runs.where(**ICE)
    over = runs.estimates("over", by)
    fillings = over.index.get_level_values("filling")
    rates = ", ".join(f"{rate:g}" for rate in RATES)
    for name, fit, meaning in (("exponent", exponent, "n of P ~ phi^n"), ("level", level, "P0 r0^3/E_roll, n = 3")):
        yield Quantity(name, f"{meaning}, fitted up to {VALID_TO:g}", along(over, "filling", with_bins(fit)))
        begun = lambda start: along(over[fillings >= start], "filling", with_bins(fit, start))
        values = together({start: begun(start) for start in sorted(set(fillings))}, "start")
        yield Quantity(f"{name}_from", "the same, fitted from this filling factor on", finite(values))
    changes = {}
    for name, (column, value) in FIDUCIAL.items():
        others = tuple(own for own in by if own != column)
        own = runs.beside(column, value, "over", others, ratios, same_pairs=column != "grains")
        changes[name] = along(own, "filling", level)
    meaning = "P r0^3/E_roll over that with K13's value of what is changed, same clusters (but of other sizes) and filling factors to 0.1"
    yield Quantity("change", meaning, together(changes, "changed"))
    pooled = of_ice.over("strainRate", RATES).estimates("over", ("stepFraction", "grains", "filling"))
    yield Quantity("pooled", f"level of clusters averaged over C_v = {rates}", along(pooled, "filling", level))


def _any_filling(runs):
    """K13's ice beside formulae for any filling factor."""
    scale = lambda t: strength_scale(t.rolling_energy, t.grainRadius)
    dense = runs.estimates(lambda t: t.pressure / compressive_strength_dense(t.filling, scale(t)), OF_ICE)
    yield Quantity("dense", "pressure over (E_roll/r0^3) (1/phi - 1/0.74)^-3 (Tatsuuma et al. 2023)", dense)
    contacts = runs.estimates(lambda t: t.coordination - bcca_coordination(t.filling), OF_ICE)
    yield Quantity("contacts", "contacts of a grain less 2 + 9.38 phi^1.62 (A24 eq 45)", contacts)


def _channels(runs):
    """Where the work goes."""
    table, by = runs.table, (*SET, "since", "until")
    lost = lambda names, filling: sum(table[ENERGIES[name, filling]] for name in names) if filling else 0.0
    lost_between = lambda a, b: {way: lost(names, b) - lost(names, a) for way, names in WAYS.items()}
    spans = [table.assign(since=a, until=b, **lost_between(a, b)) for a, b in SPANS]
    rows = runs.of(pandas.concat(spans, ignore_index=True))
    shares = rows.shares({way: way for way in WAYS}, lambda t: sum(t[way] for way in WAYS), by, "channel")
    yield Quantity("shares", "part of all that is dissipated between two filling factors", shares, "%")
    twisting, rolling = (select(shares, channel=way, since=0.0, until=VALID_TO) for way in ("twisting", "rolling"))
    over = ratios(twisting, rolling)
    yield Quantity("twisting_over_rolling", f"dissipation by twisting over rolling, until {VALID_TO:g}", over)
    meaning = "filling factor from which on twisting has dissipated such a share of what rolling has"
    yield Quantity("twisting_from", meaning, runs.parts(TWISTING, SET, "share"))


def _tension(runs):
    """Cells that are stretched after the compression."""
    by, theirs = (*SET, "stretched_axes", "finalFilling"), lambda t: (t.largest_filling, t.surfaceEnergy, t.grainRadius)
    tensile = runs.estimates("tensile_strength", by)
    yield Quantity("tensile", "largest tension while a cell is stretched", tensile, "kPa")
    one = runs.where(stretched_axes=1).estimates(lambda t: t.tensile_strength / tensile_strength(*theirs(t)), by)
    yield Quantity("tensile_over", "the same along one axis over 0.6 MPa phi^1.8 (Tatsuuma et al. 2019)", one)


STUDY = Study(
    title="Kataoka et al. (2013): static compression of fluffy aggregates",
    question="Which pressure compresses a fluffy aggregate to a given filling factor, and on which properties of its grains does that depend?",
    # BCCA clusters in cells that shrink uniformly, without viscous drag.
    scene=Scene(
        name="the study of Kataoka et al. (2013)",
        values={"viscoelasticTime": 0.0, "packing": "bcca", "limit": "held"},
        numbers=NUMBERS,
        measured=(*OF_GRAINS, "initial_filling", "largest_filling", "last_filling", "stretched_axes"),
        kind=COMPRESSION.name,
    ),
    measured=MEASURED,
    quantities=quantities,
    independent="clusters",
)
