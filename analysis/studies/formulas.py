"""Strength and conductivity of compressed BCCA clusters beside the formulas that codes of discs and comets use.

A cluster is compressed in a periodic cell to a filling factor and then stretched along x until it breaks. T19: Tatsuuma
et al. (2019), tensile strength; T23: Tatsuuma et al. (2023), compressive strength; A19: Arakawa et al. (2017, 2019),
conductivity. The papers' texts were not at hand: these are their formulas as other codes and papers quote them."""

from functools import partial

import numpy as np

from ..figures.style import PAPER
from ..measures import periodic_cell as cells
from ..measures.conduction import conductivity
from ..measures.structure import mean_coordination
from ..runs.format import COMPRESSION
from ..runs.ledger import work_closure
from ..runs.measured import derived_constants
from ..theory import Material, aggregates, contact_radius, pair_constants
from ..theory.measured import MIDDLE
from .columns import OF_GRAINS, Column, constant, group, one
from .comparison import Row
from .compression import CLUSTER
from .estimates import Estimate, beside, estimate, estimates, mean, where
from .figures import curves
from .study import Study

FILLINGS = 0.03, 0.1, 0.2, 0.3, 0.4, 0.5
OF_LARGE = 0.03, 0.1, 0.3  # fillings of the clusters of 4,096 grains
SET = {"grains": 1024, "strainRate": 1e-6, "material": "ice"}
ICE = {**SET, "surfaceEnergy": 0.1, "grainRadius": 1e-7, "criticalRolling": 8e-10}
FITTED = 0.1, 0.4  # fillings between which: the conductivity was found to be no power law beyond; 0.03 was kept out
PRESSED = 1.05  # the pressure at the end of the compression is that from the final filling over this on

# What is measured of a run.


def _compressed(run, row):
    """Filling, pressure over T23's, coordination and k/k_mat at the end of the compression."""
    between, pressure = cells.pressures(run.history)
    over = pressure / aggregates.compressive_strength_dense(between, 1.0)
    largest = run.history["filling"].max()
    last = between > largest / PRESSED
    scale = aggregates.strength_scale(row["rolling_energy"], row["grainRadius"])
    state = run.states[run.states.nearest(run.history["time"][np.argmax(run.history["filling"])])]
    filling = cells.filling_factor(state.radius, state.cell_size)
    coordination = mean_coordination(len(state.radius), state.contact_pairs)
    return largest, over[last].mean() / scale, filling, coordination, _conductivity(run, state)


def _conductivity(run, state):
    """k/k_mat of a state, the mean of the three axes."""
    names = "young", "poisson", "density", "surfaceEnergy", "criticalRolling"
    material, radius = Material(*derived_constants(run, *names)), state.radius[0]
    first, second = state.contact_pairs.T
    apart = cells.nearest_image(state.position[first] - state.position[second], state.cell_size)
    overlap = 2.0 * radius - np.linalg.norm(apart, axis=1)
    touching = contact_radius(overlap, pair_constants(material, radius))
    return conductivity(state.position, state.contact_pairs, touching, state.cell_size).mean()


def _stretched(run, row):
    return cells.tensile_strength(run.history, cells.AVERAGED * row["time_unit"])


MEASURED = (
    *CLUSTER,
    constant("equilibrium_contact_radius", "m", "a0", "equilibriumContactRadius"),
    group(
        _compressed,
        Column("filling", "", "largest filling factor"),
        Column("pressed", "", "pressure at the end of the compression over T23's formula"),
        Column("conducting_filling", "", "filling factor of the state whose conductivity is measured"),
        Column("coordination", "", "its mean number of contacts of a grain"),
        Column("conductivity", "", "its k/k_mat, mean of the axes"),
    ),
    group(
        _stretched,
        Column("tensile_strength", "Pa", f"largest tension, over {cells.SMOOTHED:g} of the way to it"),
        Column("tensile_filling", "", "filling factor at which the tension is largest"),
    ),
    one("closure", "", "largest error of the ledger over the largest work", lambda run: work_closure(run.history)),
)


def prepared(runs):
    """The table with what is measured over the formulas."""
    strength = aggregates.tensile_strength(runs.filling, runs.surfaceEnergy, runs.grainRadius)
    formula = aggregates.conductivity(runs.conducting_filling, runs.equilibrium_contact_radius, runs.grainRadius)
    return runs.assign(
        pulled=runs.tensile_strength / strength,
        conducted=runs.conductivity / formula,
        widened=runs.tensile_filling / runs.filling,
    )


# Statistics.


def power_law(values, places="filling"):
    """Statistic: (value at the middle of the fillings, n) of values ~ filling^n, both columns; NaN with fewer than
    three fillings. Least squares of the logarithms of each filling's mean."""

    def of(runs):
        points = runs.groupby("finalFilling")[[values, places]].mean()
        if len(points) < 3:
            return np.nan, np.nan
        n, level = np.polyfit(np.log(points[places] / MIDDLE), np.log(points[values]), 1)
        return np.exp(level), n

    return of


def change(values, one, other, by):
    """Estimate of n in values ~ x^n between two sets of the same clusters, `by` the ratio of their x; not run where
    one is missing."""
    if not (len(one) and len(other)):
        return Estimate(np.nan, None)
    return beside(mean(values), one, other, lambda a, b: np.log(a / b) / np.log(by))


QUANTITIES = {  # column over the formula: (what it is, paper)
    "pulled": ("tensile strength over 0.6 MPa (γ/0.1 J/m²)(0.1 µm/r) φ^1.8", "T19"),
    "pressed": ("compressive strength over E_roll/((1/φ − 1/0.74) r)³", "T23"),
    "conducted": ("k/k_mat over 2 (a0/r) φ^2.09", "A19"),
}
VALUES = {  # that are fitted, against which filling: (what it is, exponent of the paper)
    "tensile_strength": ("filling", "tensile strength [Pa]", (1.8, "1.8", "T19")),
    "conductivity": ("conducting_filling", "conductivity, k/k_mat", (2.34 / 1.12, "2.09", "A19")),
}


def rows(runs):
    """What the formulas give beside what these clusters have."""
    ice = where(runs, **ICE)
    for name, (what, paper) in QUANTITIES.items():
        for filling in FILLINGS:
            own = where(ice, finalFilling=filling)
            yield Row(f"{what}, φ = {filling}", estimate(mean(name), own), 1.0, "1", paper)
    for filling in FILLINGS:
        found = estimate(mean("widened"), where(ice, finalFilling=filling))
        yield Row(f"φ where the tension is largest over that before, φ = {filling}", found, 0.5, "about half", "T19")
        found = estimate(mean("coordination"), where(ice, finalFilling=filling))
        yield Row(f"contacts of a grain, φ = {filling}", found)
    for name, (places, words, paper) in VALUES.items():
        level, n = estimates(power_law(name, places), ice[ice.finalFilling.between(*FITTED)])
        yield Row(f"{words} at φ = {MIDDLE}, fit", level)
        yield Row(f"n of {words} ∝ φⁿ", n, *paper)
    yield from _dependences(runs, ice)


def _dependences(runs, ice):
    """On grains, rate and size."""
    middle = where(ice, finalFilling=0.2)
    of = {
        "γⁿ": (dict(surfaceEnergy=0.02), 0.2, (1.0, "1", "T19")),
        "rⁿ, 0.05 over 0.1 µm": (dict(grainRadius=5e-8), 0.5, (-1.0, "−1", "T19")),
        "rⁿ, 1 over 0.1 µm": (dict(grainRadius=1e-6), 10.0, (-1.0, "−1", "T19")),
        "rⁿ, 1 over 0.1 µm, one ξ_crit/r": (dict(grainRadius=1e-6, criticalRolling=8e-9), 10.0, (-1.0, "−1", "T19")),
        "ξ_critⁿ, 2 over 8 Å": (dict(criticalRolling=2e-10), 0.25, ()),
        "ξ_critⁿ, 32 over 8 Å": (dict(criticalRolling=3.2e-9), 4.0, ()),
    }
    for what, (other_grains, by, paper) in of.items():
        other = where(runs, **{**ICE, **other_grains, "finalFilling": 0.2})
        yield Row(f"n of tensile strength ∝ {what}", change("tensile_strength", other, middle, by), *paper)
        more = change("pressed", other, middle, by)
        yield Row(f"n of compressive strength over its formula ∝ {what}", more, 0.0, "0", "T23")
    for name, (what, _) in QUANTITIES.items():
        word = what.split(" over")[0]
        slow = where(runs, **{**ICE, "strainRate": 5e-7, "finalFilling": 0.2})
        ratio = partial(beside, mean(name), of=np.divide)
        yield Row(f"{word}, rate 5e-7 over 1e-6, φ = 0.2", ratio(slow, middle))
        for filling in OF_LARGE:
            large = where(runs, **{**ICE, "grains": 4096, "finalFilling": filling})
            yield Row(f"{word}, 4,096 over 1,024 grains, φ = {filling}", ratio(large, where(ice, finalFilling=filling)))
        silicate = runs[(runs.material == "silicate") & np.isclose(runs.finalFilling, 0.2)]
        yield Row(f"{what}, silicate of 0.6 µm, φ = 0.2", estimate(mean(name), silicate))


def figures(runs):
    """All three over their formulas."""
    ice = where(runs, **{name: value for name, value in ICE.items() if name != "grains"}, stepFraction=0.25)
    ice = ice.assign(size=[f"{grains:,} grains" for grains in ice.grains])
    formula = lambda axes, panel: axes.axhline(1.0, color=PAPER, ls="--", lw=1.2, zorder=0)
    for name, (what, _) in QUANTITIES.items():
        look = {"paper": formula, "x_label": r"$\phi$", "y_label": what.split(" over")[0] + " over the formula"}
        figure = curves(ice, partial(estimate, mean(name)), "finalFilling", "size", **look)
        yield name, f"{what[0].upper()}{what[1:]}, of BCCA clusters of ice grains.", figure


STUDY = Study(
    title="Strength and conductivity of compressed aggregates",
    question="How strong are compressed aggregates, and how well do they conduct heat, beside the formulas in use?",
    kind=COMPRESSION.name,
    values={"viscoelasticTime": 0.0, "packing": "bcca", "limit": "held", "stretch": "x", "linearDamping": 0.01},
    key=("grains", "strainRate", "finalFilling", "seed", "stepFraction", *OF_GRAINS),
    measured=MEASURED,
    pair=("grains", "seed"),
    rows=rows,
    figures=figures,
    prepared=prepared,
    independent="clusters",
)
