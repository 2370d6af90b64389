"""Static compression of fluffy aggregates in shrinking periodic cells, beside Kataoka et al. (2013, K13)."""

from functools import partial

import numpy as np
import pandas

from ..figures.style import PAPER
from ..measures import periodic_cell as cells
from ..measures.network import spanned_axes
from ..measures.structure import fractal_dimension, grains_within
from ..runs.format import COMPRESSION, LOST_CHANNELS
from ..runs.ledger import work_closure
from ..theory import aggregates as theory
from .columns import GRAINS, MATERIAL, OF_GRAINS, Column, NotMeasured, constant, grains_text, group, parameter
from .comparison import Row
from .estimates import beside, estimate, exponent, mean, where
from .figures import curves
from .study import Study

# Filling factors of the pressure: eight a decade from 0.001 to 0.24, where a bin reaches half-way to its neighbours.
# Above, pressure rises too steeply for bins as wide: these are narrow, and the last are those that runs to 0.5 and
# 0.64 cover.
LOOSE = 10.0 ** (np.arange(-24, -4) / 8.0)
DENSE = np.array([0.30, 0.35, 0.40, 0.45, 0.49, 0.55, 0.60, 0.625])
FILLINGS = np.concatenate([LOOSE, DENSE])
# A bin is from its filling factor over this to that times this.
HALF_BINS = np.concatenate([np.full(len(LOOSE), 10.0 ** (1.0 / 16.0)), np.full(len(DENSE), 1.02)])
ENERGY_FILLINGS = (0.01, 0.03, 0.1, 0.3, 0.4, 0.5, 0.6)
# Columns of values at filling factors: {place: name}.
PRESSURES = {filling: f"P_{filling:.4f}" for filling in FILLINGS}
ENERGIES = {(name, filling): f"{name}_{filling:g}" for filling in ENERGY_FILLINGS for name in LOST_CHANNELS}
DIMENSIONS = {filling: f"D_{filling:g}" for filling in (0.003, 0.01, 0.03, 0.1)}  # K13 Fig. 11
ENDS = "initial_filling", "largest_filling"
VALID_TO = 0.1  # the filling factor up to which K13 eq 25 holds
ROUNDING = 1.0 + 1e-9
# What the clusters of a set have in common, with K13's ice (section 3.1); seeds and the ends of the compressions
# differ.
ICE = {"material": "ice", "stepFraction": 0.3, "linearDamping": 0.01, "criticalRolling": 8e-10}
SET = (*ICE, "grains", "strainRate")

# What is measured of a run.


def pressure_at(history):
    """Pressure (K,) [Pa] at FILLINGS: the mean, over the time that the cell spends in the bin around each, of the
    pressure over that of Tatsuuma et al. (2023), times that at the filling factor itself, so that the bin's width
    leaves no bias where the pressure rises as theirs does. NaN where the run does not cover the bin."""
    between, pressure = cells.pressures(history)
    ratio = pressure / theory.compressive_strength_dense(between, 1.0)
    return theory.compressive_strength_dense(FILLINGS, 1.0) * _binned(history, between, ratio)


def _binned(history, places, values):
    """Means (K,) of values (M,) at filling factors `places` (M,) over the bins; NaN where the run does not cover
    one."""
    first, last = history["filling"][0], history["filling"].max()
    found = np.full(len(FILLINGS), np.nan)
    for k, (low, high) in enumerate(zip(FILLINGS / HALF_BINS, FILLINGS * HALF_BINS)):
        inside = (places >= low) & (places < high)
        if inside.any() and first <= low and last >= high * (1.0 - 1e-9):
            found[k] = values[inside].mean()
    return found


def _reached(run, row):
    filling = run.history["filling"]
    at_300 = cells.filling_at_pressure(run.history, 300.0, cells.AVERAGED * row["time_unit"])  # K13 section 3.7
    return float(filling[0]), float(filling.max()), _spanned_from(run), at_300, work_closure(run.history) or 0.0


def _spanned_from(run):
    """Filling factor of the loosest state from which on every state of the compression spans its cell along all axes;
    inf where the densest does not, NaN without states."""
    found = float("inf") if len(run.states) else float("nan")
    last = run.history["time"][cells.compressing(run.history)][-1]
    for state in reversed(run.states):
        if state.time > last * ROUNDING:
            continue
        if state.cell_size is None or spanned_axes(state.position, state.contact_pairs, state.cell_size) < 3:
            return found
        found = _filling_of(run, state)
    return found


def _filling_of(run, state):
    return float(np.interp(state.time, run.history["time"], run.history["filling"]))


def _pressures(run, row):
    pressure = pressure_at(run.history)
    if not np.isfinite(pressure).any():
        raise NotMeasured(f"{run.path}: covers no bin of the filling factor")
    return pressure


def _dimension(run, filling):
    """Fractal dimension between 3 and 10 grain radii of the state nearest to a filling factor while the cell shrinks;
    NaN where none is within 15 % of it."""
    part = cells.compressing(run.history)
    time = run.history["time"][part][np.argmin(np.abs(np.log(run.history["filling"][part] / filling)))]
    state = run.states[run.states.nearest(time)] if len(run.states) else None
    if state is None or state.cell_size is None or abs(_filling_of(run, state) / filling - 1.0) > 0.15:
        return float("nan")
    distance = np.array([3.0, 10.0]) * state.radius.mean()
    return float(fractal_dimension(distance, grains_within(state.position, distance, state.cell_size, 2000))[0])


def _at_places(names, unit, meaning):
    return (Column(name, unit, meaning.format(place), gaps=True) for place, name in names.items())


_OF_CELL = {"strainRate": ("1/t0", "C_v"), "linearDamping": ("", "k_n"), "stepFraction": ("t0", "time step")}
_OF_CELL["finalFilling"] = "", "filling factor at which the compression was to end"
CLUSTER = (  # of every study of compressed cells
    MATERIAL,
    parameter("grains", "", "number of grains N", "i"),
    *(parameter(name, *of) for name, of in _OF_CELL.items()),
    parameter("seed", "", "random seed of the cluster", "i"),
    *GRAINS,
    constant("rolling_energy", "J", "E_roll (K13 eq 1)", "rollingEnergy"),
    constant("grain_mass", "kg", "mass of a grain", "grainMass"),
    constant("time_unit", "s", "t0", "timeUnit"),
)
MEASURED = (
    *CLUSTER,
    group(
        _reached,
        Column("initial_filling", "", "filling factor of the first cell"),
        Column("largest_filling", "", "largest filling factor that was reached"),
        Column("spanned_from", "", "filling factor from which on contacts span the cell along all axes", gaps=True),
        Column("filling_at_300", "", "filling factor at 300 Pa", gaps=True),
        Column("closure", "", "largest error of the energy ledger over the largest work of the boundaries"),
    ),
    group(_pressures, *_at_places(PRESSURES, "Pa", "pressure at the filling {:.4f}, by the work")),
    group(
        lambda run, row: [cells.at_filling(run.history, *of) for of in ENERGIES],
        *_at_places(ENERGIES, "J", "{0[0]} until the filling {0[1]:g}"),
    ),
    group(
        lambda run, row: [_dimension(run, filling) for filling in DIMENSIONS],
        *_at_places(DIMENSIONS, "", "fractal dimension at 3 to 10 r0, filling {:g}"),
    ),
)


def prepared(runs):
    """A row a cluster of each set, of several compressions that which went furthest; materials named by what differs
    from K13's grains (xi_crit left out)."""
    named = runs.assign(material=[grains_text(row, but=("criticalRolling",)) for row in runs.to_dict("records")])
    named = named.sort_values("largest_filling", kind="stable")
    return named.drop_duplicates([*SET, "seed"], keep="last").sort_index()


def by_filling(clusters):
    """A row a cluster and filling factor `filling`: its `pressure` [Pa], that `over` K13 eq 25 and over that of
    Tatsuuma et al. (2023), `dense`; of each set the filling factors at which all clusters that went so far have a
    pressure.

    `settled`: every cluster of the set is denser than a free one (K13 eq 24) there, boundaries are slower than sound
    (eqs 26, 27), and contacts connect the cell with its images along all axes. `shared`: all clusters of the set came
    there, so that a fit along the filling factor is of the same clusters everywhere."""
    of_run = clusters.grainRadius, clusters.time_unit, clusters.rolling_energy, clusters.grain_mass
    static = theory.static_from(clusters.strainRate, clusters.grains, *of_run)
    static = np.maximum(theory.bcca_filling(clusters.grains), static)
    scale = theory.strength_scale(clusters.rolling_energy, clusters.grainRadius)
    of_set, spanned, parts = [clusters[name] for name in SET], clusters.spanned_from.fillna(0.0), []
    for filling, half, column in zip(FILLINGS, HALF_BINS, PRESSURES.values()):
        there, pressure = clusters.largest_filling * ROUNDING >= filling * half, clusters[column]
        own = clusters.assign(
            filling=filling,
            pressure=pressure,
            over=pressure / theory.compressive_strength(filling, scale),
            dense=pressure / theory.compressive_strength_dense(filling, scale),
            shared=there.groupby(of_set).transform("all"),
            settled=(filling * ROUNDING >= static) & (filling / half * ROUNDING >= spanned),
        )
        parts.append(own[there])
    rows = pandas.concat(parts, ignore_index=True)
    sets = rows.groupby([*SET, "filling"])
    rows["settled"] = sets.settled.transform("all")
    return rows[sets.pressure.transform("count") == sets.pressure.transform("size")]


# Statistics of rows by filling factor.


def power(rows):
    """n of P ~ phi^n (K13 eq 23)."""
    over = rows.groupby("filling").over.mean()
    return 3.0 + exponent(over.index, over)


def level(rows):
    """P0 r0^3/E_roll with n = 3 (K13 eq 25): the geometric mean of P over eq 25; NaN with fewer than three bins."""
    over = rows.groupby("filling").over.mean()
    return geometric_mean(over) if len(over) > 2 else np.nan


def geometric_mean(values):
    return float(np.exp(np.log(values.where(values > 0)).mean(skipna=False))) if len(values) else np.nan


def change(one, other):
    """Estimate of P over that of other rows: geometric mean over the filling factors, of the same clusters."""
    ratio = lambda of_one, of_other: geometric_mean((of_one / of_other).dropna())
    return beside(lambda rows: rows.groupby("filling").over.mean(), one, other, ratio)


def twisting_over_rolling(clusters):
    """Dissipation by twisting over rolling until the filling 0.1."""
    lost = clusters[["twistingDissipation_0.1", "rollingDissipation_0.1"]].mean()
    return lost.iloc[0] / lost.iloc[1]


def rows(runs):
    """K13's numbers, of ten clusters, beside ours, then those that are ours alone."""
    K13, bins = partial(Row, runs=10), by_filling(runs)
    fitted = bins[bins.settled & bins.shared & (bins.filling <= VALID_TO)]
    ice = lambda table, grains, rate, **place: where(table, **{**ICE, "grains": grains, "strainRate": rate, **place})
    over = mean("over")
    cubic, agreement = ((2.8, 3.2), "3: to 0.2"), ((0.69, 1.44), "1: to 13 % in φ")
    yield K13("n of P ∝ φⁿ, 16,384 grains", estimate(power, ice(fitted, 16_384, 3e-7)), *cubic, "3.1")
    yield K13("P over eq 25 (n = 3), 16,384 grains", estimate(level, ice(fitted, 16_384, 3e-7)), *agreement, "3.1")
    for k, rate, source in ((-8, 3e-7, "3.1"), (-12, 3e-7, "3.1"), (-19, 3e-7, "3.1"), (-23, 1e-7, "5")):
        filling = 10.0 ** (k / 8.0)
        found = estimate(over, ice(bins, 16_384, rate, filling=filling))
        yield K13(f"P over eq 25 at φ = {filling:.4g}, 16,384 grains, C_v = {rate:g}", found, *agreement, source)
    yield K13("n of P ∝ φⁿ, 1,024 grains", estimate(power, ice(fitted, 1024, 3e-7)), *cubic, "3.3")
    for grains in (1024, 4096):
        found = estimate(level, ice(fitted, grains, 3e-7))
        yield K13(f"P over eq 25 (n = 3), {grains:,} grains", found, *agreement, "3.3")
    few, slow = partial(ice, fitted, 1024, 1e-6), ice(fitted, 1024, 3e-7)
    yield K13("P, C_v = 1e-5 over 3e-7, 1,024 grains", change(ice(fitted, 1024, 1e-5), slow), *agreement, "5")
    yield K13("P, 1,024 over 16,384 grains", change(slow, ice(fitted, 16_384, 3e-7)), *agreement, "3.3, 5")
    damped = change(few(linearDamping=0.1), few())
    yield Row("P, damping k_n = 0.1 over 0.01, 1,024 grains", damped, *agreement, "3.4, 5", runs=1)
    for rolling, source in ((2, "5"), (4, "3.5")):
        found = change(few(criticalRolling=rolling * 1e-10), few())
        yield K13(f"P/E_roll, ξ_crit = {rolling} over 8 Å, 1,024 grains", found, *agreement, source)
    for rolling in (16, 32):
        found = change(few(criticalRolling=rolling * 1e-10), few())
        yield K13(f"P/E_roll, ξ_crit = {rolling} over 8 Å, 1,024 grains", found, None, "“deviation”", "3.5")
    silicate = runs[runs.material == "silicate"]
    found = estimate(mean("filling_at_300"), where(silicate, grains=16_384))
    yield K13("φ of silicate at 300 Pa, 16,384 grains", found, 0.24, "0.24", "3.7")
    twisting, what = partial(estimate, twisting_over_rolling), "lost by twisting over rolling until φ = 0.1, ξ_crit"
    found = twisting(ice(runs, 16_384, 3e-7, criticalRolling=3.2e-9))
    yield K13(f"{what} = 32 Å, 16,384 grains", found, (1, None), "above 1", "3.5")
    yield K13(f"{what} = 8 Å, 16,384 grains", twisting(ice(runs, 16_384, 3e-7)), (None, 1), "below 1", "3.5")
    for rolling, printed in ((16, "“comparable”, 16,384 grains"), (32, "above 1, 16,384 grains")):
        found = twisting(ice(runs, 1024, 1e-6, criticalRolling=rolling * 1e-10))
        yield K13(f"{what} = {rolling} Å, 1,024 grains", found, None, printed, "3.5")
    found = estimate(mean("D_0.003"), ice(runs, 16_384, 3e-7))
    yield Row("fractal dimension at φ = 0.003", found, (1.85, 2.15), "N ∝ r²: 1.85 to 2.15", "3.6", runs=1)
    yield from _new(bins, silicate, few)


def _new(bins, silicate, few):
    """Beyond a filling factor of 0.1, and what the time step changes."""
    ice = partial(where, bins[bins.settled], **ICE, grains=1024)
    for filling in (0.1, 0.4, 0.49, 0.625):
        what = f"P over that of Tatsuuma et al. (2023) at φ = {filling}, 1,024 grains, C_v = 1e-06"
        yield Row(what, estimate(mean("dense"), ice(filling=filling, strainRate=1e-6)))
    yield Row("P, time step 0.1 over 0.3 t0, 1,024 grains", change(few(stepFraction=0.1), few()))
    yield Row("φ of silicate at 300 Pa, 4,096 grains", estimate(mean("filling_at_300"), where(silicate, grains=4096)))


def figures(runs):
    """K13's Figs 4 to 6, 9 and 12."""
    bins = by_filling(runs[runs.material == "ice"])
    bins = bins[bins.settled & (bins.filling < 0.31)].sort_values(["grains", "strainRate", "criticalRolling"])

    def paper(axes, panel):
        """Eq 25, and what counts as agreement with it where K13 says that it holds."""
        axes.axhline(1.0, color=PAPER, ls="--", lw=1.2, zorder=0)
        axes.fill_between([0.01, VALID_TO], 0.69, 1.44, color=PAPER, alpha=0.1, lw=0)

    look = {"log": "xy", "paper": paper, "x_label": r"$\phi$", "y_label": r"$P$ over eq 25", "limits": (0.25, 6.0)}
    of = partial(estimate, mean("over"))
    ice = where(bins, **ICE)
    words = {
        "size": [f"{grains:,} grains" for grains in ice.grains],
        "rate": [f"$C_v$ = {v:g}" for v in ice.strainRate],
    }
    figure = curves(ice.assign(**words), of, "filling", "rate", "size", **look)
    yield "fig04_strength", "Pressure over K13 eq 25 where contacts span every cell; shaded: agreement.", figure
    rolling = where(bins, grains=1024, strainRate=1e-6, stepFraction=0.3, linearDamping=0.01)
    words = [rf"$\xi_{{crit}}$ = {value * 1e10:g} Å" for value in rolling.criticalRolling]
    figure = curves(rolling.assign(of=words), of, "filling", "of", **look)
    yield "fig09_rolling", "K13 Fig. 9 with 1,024 grains.", figure


STUDY = Study(
    title="Kataoka et al. (2013): static compression of fluffy aggregates",
    question="Which pressure compresses a fluffy aggregate to a given filling factor, and on which properties of its "
    "grains does that depend?",
    # BCCA clusters in cells that shrink uniformly, without viscous drag.
    kind=COMPRESSION.name,
    values={"viscoelasticTime": 0.0, "packing": "bcca", "limit": "held"},
    key=("grains", *_OF_CELL, "seed", *OF_GRAINS, *ENDS),
    measured=MEASURED,
    pair=("grains", "seed"),
    rows=rows,
    figures=figures,
    prepared=prepared,
    independent="clusters",
)
