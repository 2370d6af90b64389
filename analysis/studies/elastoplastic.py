"""Head-on collisions of close-packed aggregates as elastoplastic spheres, beside Arakawa et al. (2024, A24)."""

from dataclasses import dataclass
from functools import partial
from math import nan

import numpy as np
from scipy.optimize import least_squares
from scipy.special import digamma

from ..figures.style import PAPER
from ..measures.outcome import STICKING, UNDECIDED
from ..measures.structure import DEPTH, zone_filling
from ..theory import ICE, andrews, pair_constants
from ..theory.aggregates import bcca_strength, bulk_modulus, cpe_coordination, poisson_ratio
from . import columns
from .columns import Column, constant, group, one, parameter
from .comparison import Row
from .compressed import COMPACT, HEAD_ON_ICE, largest_compression
from .estimates import Estimate, beside, estimate, estimates, exponent, fraction, mean, where
from .figures import curves, snapshots
from .study import GALLERY, Study

VELOCITY = 10**0.5  # m/s, at which A24 compares sizes; printed as 3.2 m/s
ZONES = f"grains per volume in the two zones that meet, {DEPTH:g} R deep and wide, over that of the aggregates"
# What a run may have changed, and what A24 has: drag, grains outside the largest piece, overlap at the start.
UNCHANGED = {"viscoelasticTime": 0.0, "removeLooseGrains": 0.0, "initialOverlap": 1.0}
# What A24 prints, by filling: sigma, E* [Pa] (eqs 34, 35), delta_offset [grain radii] (18, 20), delta_max/R* (19, 21).
PRINTED = {0.4: (2.25e6, 15.7e6, 0.271, 0.113), 0.3: (0.428e6, 4.96e6, -0.010, 0.199)}
GRAIN_RADIUS, START = 1e-7, (15.0, 3.0)  # m, of all runs; where fits start: ln sigma [Pa], 100 delta_crit/R*


def _compression(run, row):
    columns.require_papers_grains(run)
    maximum = largest_compression(run)
    return float(run.history["d"][0]) + 2.0 * row["grain_radius"], maximum.length, maximum.time


def zones_that_meet(position, aggregate, radius, grain_radius):
    """Filling of the two zones that meet over that of the aggregates, mean of the two: positions (N,3) [m] before the
    aggregates, (N,) 0 or 1, touch; radius of an aggregate and of a grain [m]."""
    centre = lambda side: np.array([-side * (radius + grain_radius), 0.0, 0.0])
    of = lambda number, side: zone_filling(position[aggregate == number], centre(side), radius, side)
    return 0.5 * (of(0, 1.0) + of(1, -1.0))


def _zones(run, row):
    return (zones_that_meet(run.start.position, run.start.aggregate, row["radius"], row["grain_radius"]),)


_duration = lambda run: float(run.parameters.get("duration") or run.history["time"][-1])
MEASURED = (
    parameter("filling", "", "filling factor"),
    constant("radius", "m", "radius of an aggregate", "aggregateRadius"),
    columns.VELOCITY,
    columns.SEED,
    parameter("viscoelasticTime", "s", "T_vis of the viscous drag", usual=0.0),
    parameter("removeLooseGrains", "", "1: grains outside the largest piece are left out", usual=0.0),
    parameter("initialOverlap", "", "overlap of neighbours at the start, of that at rest", usual=1.0),
    one("duration", "s", "how long the collision is followed", _duration),
    columns.GRAIN_RADIUS,
    group(
        _compression,
        Column("offset", "m", "d(0) + 2 r, by which the centres of mass are closer than the spheres' by chance"),
        Column("d_max", "m", "largest compression length of the first compression"),
        Column("t_max", "s", "time of d_max"),
    ),
    group(_zones, Column("zone_filling", "", ZONES, gaps=True)),
    *COMPACT,
)


def prepared(runs):
    """The table with radius and `d` (d_max) in grain radii, t_max in ns, what is returned, and what is changed."""
    return runs.assign(
        radius=(runs.radius / runs.grain_radius).round(3),
        d=runs.d_max / runs.grain_radius,
        t=runs.t_max * 1e9,
        returned=(runs.return_speed / runs.velocity) ** 2,
        duration=runs.duration.round(8),
        changed=(runs[list(UNCHANGED)] != list(UNCHANGED.values())).any(axis=1),
    )


def once(runs):
    """Of a pair's runs at one velocity only that which was followed for longest."""
    rows = runs.sort_values("duration", kind="stable")
    return rows.drop_duplicates(["pair", "velocity"], keep="last").sort_index()


@dataclass(frozen=True)
class Aggregates:
    """Andrews's spheres in place of aggregates: sigma_plastic [Pa], 1/E* [1/Pa] (0: rigid-plastic), delta_offset [grain
    radii], density. With R* = (R + delta_offset)/2 (A24 sections 4.2, 4.3) d_max = delta_max(v, R*) - 2 delta_offset,
    t_max = tau_max(v, R*) + 2 (r - delta_offset)/v."""

    stress: float
    compliance: float
    offset: float
    density: float

    def at(self, radius, velocity):
        """(d_max [grain radii], t_max [ns]) at a radius [grain radii] and a velocity [m/s]."""
        spheres = self._spheres(0.5 * (radius + self.offset))  # everything in the model is proportional to R*
        depth = andrews.largest_compression(velocity, spheres)
        time = andrews.time_of_largest_compression(velocity, spheres) * GRAIN_RADIUS * 1e9
        return depth - 2.0 * self.offset, time + time_of_contact(self.offset, velocity)

    def returned(self, velocity):
        """Square of the coefficient of restitution (A24 section 5.3), the same for every size."""
        return float(andrews.restitution(velocity, self._spheres(1.0)) ** 2)

    def _spheres(self, reduced_radius):
        young = 1.0 / self.compliance if self.compliance > 0 else np.inf
        return andrews.Spheres(reduced_radius, self.density, self.stress, young)


def time_of_contact(offset, velocity):
    """t_col [ns], when surfaces that start 2 r - 2 delta_offset apart meet (A24 after eq 21); offset [grain radii]."""
    return 2.0 * (1.0 - offset) * GRAIN_RADIUS * 1e9 / velocity


def printed(filling):
    """Aggregates with the values that A24 prints for a filling factor."""
    stress, young, offset, _ = PRINTED[filling]
    return Aggregates(stress, 1.0 / young, offset, filling * ICE.density)


def size_line(runs):
    """c1, c2 of d_max = c1 R - c2 (A24 eq 14) at one velocity, delta_offset that makes delta_max proportional to R* (eq
    18), delta_max/R* (19), d_max at R = 60 r. Eq 18 prints 2 - c1/2, but its number 0.271 is c2/(2 - c1)."""
    if runs.radius.nunique() < 2:
        return [nan] * 5
    c1, intercept = np.polyfit(runs.radius, runs.d, 1)
    return c1, -intercept, -intercept / (2.0 - c1), 2.0 * c1, 60.0 * c1 + intercept


def smoothed_scatter(x, scatter, number):
    """Standard deviations (K,) of one run that follow a power of x, from each point's own (K,), x (K,) and the number
    of runs (K,): ln s^2 against ln x by least squares, weighted with the degrees of freedom and freed of its bias
    (digamma). A constant for less than four points; NaN without any point of two runs.

    Weights 1/s^2 of three runs each would vary by orders of magnitude by chance alone."""
    # A point of two equal numbers has no logarithm.
    known = (number > 1) & (scatter > 0)
    if not known.any():
        return np.full(len(scatter), np.nan)
    freedom = number[known] - 1.0
    log = 2.0 * np.log(scatter[known]) - digamma(freedom / 2.0) + np.log(freedom / 2.0)
    x = np.log(x)
    degree = 1 if known.sum() >= 4 and np.ptp(x[known]) > 0 else 0
    return np.exp(0.5 * np.polyval(np.polyfit(x[known], log, degree, w=np.sqrt(freedom)), x))


def fit_moduli(runs, offset, start=START):
    """ln sigma_plastic [Pa] and 100 delta_crit/R* of Andrews's spheres that fit d_max and t_max at all sizes and
    velocities of runs (one filling) best, with delta_offset [grain radii]; NaN with fewer than three velocities.

    A run counts by 1/s^2, s its scatter, a power of the velocity that is common to all sizes: A24 does not say. In
    these two numbers the model is smooth up to the rigid-plastic limit, which counts where it fits as well."""
    points = runs.groupby(["radius", "velocity"])[["d", "t"]]
    means, number = points.mean(), points.size().to_numpy()
    radius, velocity = (means.index.get_level_values(name).to_numpy() for name in ("radius", "velocity"))
    scatter = points.std().fillna(0.0).to_numpy().T
    scatter = np.where(scatter < 1e-12 * np.abs(means.to_numpy().T), 0.0, scatter)
    error = [smoothed_scatter(velocity, own, number) / np.sqrt(number) for own in scatter]
    if len(np.unique(velocity)) < 3 or not np.isfinite([offset, *np.ravel(error)]).all():
        return nan, nan
    density = runs.filling.iloc[0] * ICE.density

    def residuals(x):
        model = Aggregates(*moduli(x), offset, density).at(radius, velocity)
        return np.concatenate([(own - mean) / s for own, mean, s in zip(model, means.to_numpy().T, error)])

    bounds = ([np.log(1e3), 0.0], [np.log(1e13), 1000.0])
    free = least_squares(residuals, start, bounds=bounds, method="dogbox", xtol=1e-12, ftol=1e-14, gtol=1e-14)
    rigid = least_squares(lambda x: residuals([x[0], 0.0]), free.x[:1], xtol=1e-12)
    return (rigid.x[0], 0.0) if rigid.cost <= free.cost else free.x


def moduli(x):
    """(sigma_plastic [Pa], 1/E* [1/Pa]) of what fit_moduli found: delta_crit/R* = (pi sigma/(2 E*))^2, A24 eq 24."""
    stress = np.exp(x[0])
    return stress, 2.0 / np.pi * np.sqrt(0.01 * x[1]) / stress


def papers_way(runs, start=START):
    """fit_moduli() and delta_offset [grain radii] as A24 finds them: the offset from d_max against size at one
    velocity, the moduli from the sizes that have several velocities (section 4.3.3)."""
    offset = size_line(where(runs, velocity=VELOCITY))[2]
    several = runs.groupby("radius").velocity.transform("nunique") >= 3
    return (*fit_moduli(runs[several], offset, start), offset)


def power_of(runs, column):
    """Exponent of tau_max, with A24's delta_offset, as a power of a column (velocity, radius); runs of one filling."""
    offset = PRINTED[runs.filling.iloc[0]][2] if len(runs) else nan
    means = (runs.t - time_of_contact(offset, runs.velocity)).groupby(runs[column]).mean()
    return exponent(means.index, means)


def zone_correlation(runs):
    """Correlation of d_max with R times the filling of the zones that meet, about the means of the sizes."""
    known = runs[runs.zone_filling.notna()].assign(zone=runs.radius * runs.zone_filling)
    away = known[["zone", "d"]] - known.groupby("radius")[["zone", "d"]].transform("mean")
    return away.corr().iloc[0, 1]


def rows(runs):
    """A24's numbers beside ours, then those that are ours alone."""
    plain = once(runs[~runs.changed])
    yield from _sizes(plain)
    yield from _moduli(plain)
    yield from _velocities(plain)
    yield from _one_collision(where(plain, filling=0.4, radius=80, velocity=VELOCITY))
    yield from _new(runs, plain)


def _sizes(plain):
    """d_max against size at 3.2 m/s, ten pairs a size in A24, and what follows from its slope."""
    A24, restated = partial(Row, runs=50), partial(estimate, runs=where(plain, filling=0.4, velocity=VELOCITY))
    for filling, at_60, equations in ((0.4, 2.869, "14, 18, 19"), (0.3, 5.989, "15 to 17, 20, 21")):
        own, (*_, offset, ratio) = where(plain, filling=filling, velocity=VELOCITY), PRINTED[filling]
        c1, c2, found, slope, depth = estimates(size_line, own)
        yield A24(f"d_max at R = 60 r, φ = {filling} [r]", depth, at_60, f"{at_60:.2f}", equations)
        yield A24(f"δ_max/R*, φ = {filling}", slope, ratio, f"{ratio:g}", equations)
        yield A24(f"δ_offset, φ = {filling} [r]", found, offset, f"{offset:.3f}", equations)
        if filling == 0.4:
            yield A24("c1 of d_max = c1 R − c2, φ = 0.4", c1, 0.0566, "0.0566", "14")
            yield A24("c2 of d_max = c1 R − c2, φ = 0.4 [r]", c2, 0.527, "0.527", "14")
    rigid = lambda x: andrews.stress_if_rigid(x, VELOCITY, 0.4 * ICE.density)
    elastic = lambda x: andrews.young_if_elastic(x, VELOCITY, 0.4 * ICE.density)
    least = lambda x: 2.0 * elastic(x) / np.pi * np.sqrt(x)  # A24 eq 24
    for what, f, paper in (
        ("σ of rigid-plastic spheres with δ_max/R*", rigid, 1.67),
        ("σ from which nothing yields", least, 3.13),
        ("E* of elastic spheres", elastic, 14.6),
    ):
        yield A24(f"{what}, φ = 0.4 [MPa]", restated(lambda r: f(size_line(r)[3]) / 1e6), paper, f"{paper}", "4.3.2")


def _moduli(plain):
    """Yield stress and E* as A24 finds them, and what it makes of them in its section 5."""
    A24, pair = partial(Row, runs=160), pair_constants(ICE, GRAIN_RADIUS)
    lengths = GRAIN_RADIUS, pair.equilibrium_overlap
    bulk = bulk_modulus(0.4, cpe_coordination(0.4, *lengths), *lengths, pair.pull_off_force)
    yield Row("K_agg, φ = 0.4 [MPa]", Estimate(bulk / 1e6), (74.25, 74.35), "74.3", "41")
    for filling, (stress, young, papers_offset, _) in PRINTED.items():
        own, what = where(plain, filling=filling), f"φ = {filling}"

        def numbers(r, start):
            """sigma [MPa], 1/E* [1/GPa], nu, 1/E* with A24's delta_offset."""
            sigma, soft = moduli(papers_way(r, start))
            with_papers = moduli(fit_moduli(r, papers_offset, start))[1]
            return sigma / 1e6, soft * 1e9, poisson_ratio(1.0 / max(soft, 1e-15), bulk), with_papers * 1e9

        first = papers_way(own)[:2] if len(own) else START  # fits without a pair start at that to all
        sigma, soft, poisson, with_papers = estimates(lambda r: numbers(r, first), own)
        yield A24(f"yield stress σ, {what} [MPa]", sigma, stress / 1e6, f"{stress / 1e6:g}", "34, 35")
        printed_as = f"{1e9 / young:.3g} (E* = {young / 1e6:g} MPa)"
        yield A24(f"1/E*, {what} [1/GPa]", soft, 1e9 / young, printed_as, "34, 35")
        yield Row(f"1/E* with A24's δ_offset, {what} [1/GPa]", with_papers)
        theirs = Estimate(printed(filling).returned(VELOCITY))
        yield Row(f"returned by Andrews's spheres with A24's moduli, {what} [K(0)]", theirs)
        if filling == 0.4:
            yield A24("ν_agg, φ = 0.4", poisson, 0.443, "0.443", "43")
            over, printed_as = sigma * (1e6 / bcca_strength(0.4)), "“several”: above 2"
            yield A24("σ over that of quasistatic compression, φ = 0.4", over, (2, None), printed_as, "5.2")


def _velocities(plain):
    """How τ_max goes with velocity and size, with A24's delta_offset, and d_max less that of its curve."""
    for filling, radius, limits, words in (
        (0.4, 80, (None, 0), "not rigid-plastic: below 0"),
        (0.3, 40, (-0.2, None), "not elastic: above −0.2"),
    ):
        own = estimate(partial(power_of, column="velocity"), where(plain, filling=filling, radius=radius))
        yield Row(f"exponent of τ_max(v), R = {radius} r, φ = {filling}", own, limits, words, "4.2.2", runs=1)
    for filling in PRINTED:
        for v in (1.0, 10**0.7):
            model, own = printed(filling).at(40.0, v)[0], where(plain, filling=filling, radius=40, velocity=v)
            less, what = estimate(mean(lambda r: r.d - model), own), f"R = 40 r, {v:.3g} m/s, φ = {filling} [r]"
            yield Row(f"d_max less that of A24's curve, {what}", less, None, "“excellent agreement”", "6", runs=1)
        own = estimate(partial(power_of, column="radius"), where(plain, filling=filling, velocity=VELOCITY))
        yield Row(f"exponent of τ_max(R), 3.2 m/s, φ = {filling}", own, 1, "1: “proportional”", "4.2.1", runs=50)


def _one_collision(large):
    """The collision that A24 shows, R = 80 r and φ = 0.4 at 3.2 m/s."""
    A24, what = partial(Row, runs=1), "R = 80 r, φ = 0.4"
    yield A24(f"d_max, {what} [r]", estimate(mean("d"), large), (3.5, 4.5), "≃ 4", "4.1")
    yield A24(f"t_max, {what} [ns]", estimate(mean("t"), large), (250, 350), "≃ 300", "4.1")
    own = where(large, duration=1e-6)
    in_one = fraction(own, own.outcome.isin((STICKING, UNDECIDED)))
    yield A24(f"in one piece at 1 µs, {what}", in_one, (0.5, None), "“still stick together”", "4.1")
    parting = estimate(mean(lambda r: r.return_time * 1e9), large)
    yield A24(f"time of fastest parting, {what} [ns]", parting, 344, "≈ 344", "5.3")


def _new(runs, plain):
    """What comes back, where thin places are, and pairs with one thing changed."""
    for filling in PRINTED:
        own, what = where(plain, filling=filling, velocity=VELOCITY), f"φ = {filling}"
        returned, zones = estimate(mean("returned"), where(own, radius=80)), estimate(zone_correlation, own)
        yield Row(f"returned when the halves part fastest, R = 80 r, {what} [K(0)]", returned)
        yield Row(f"correlation of d_max and the filling of the zones that meet, {what}", zones)
    for key, own in runs[runs.changed].groupby([*UNCHANGED, "filling", "radius", "velocity"]):
        *values, filling, radius, v = key
        words = ", ".join(f"{name} = {value:g}" for name, value in zip(UNCHANGED, values) if value != UNCHANGED[name])
        same, what = where(plain, filling=filling, radius=radius, velocity=v), f"R = {radius:g} r, φ = {filling}"
        change = beside(mean("d"), once(own), same)
        yield Row(f"d_max, {words} less the same pairs without, {what}, {v:.3g} m/s [r]", change)


def figures(runs):
    """A24's Figs 3 and 5."""
    plain = once(runs[~runs.changed]).sort_values(["filling", "radius"], ascending=[False, True])
    own = where(plain, velocity=VELOCITY).assign(of=lambda runs: [f"φ = {filling:g}" for filling in runs.filling])

    def sizes(axes, panel):
        radius = np.linspace(30, 90, 40)
        for filling, name in ((0.4, "A24's fitted model"), (0.3, None)):
            axes.plot(radius, printed(filling).at(radius, VELOCITY)[0], "--", color=PAPER, lw=1.2, label=name)

    look = {"line": "", "x_label": "$R$ [$r$]", "y_label": "$d_{max}$ [$r$]", "paper": sizes}
    figure = curves(own, partial(estimate, mean("d")), "radius", "of", **look)
    yield "fig05_size", "A24 Fig. 5: largest compression at 3.2 m/s against size; dashed: A24's fitted model.", figure

    title = lambda row: f"φ = {row.filling:g}, R = {row.radius:g} r, {row.velocity:.3g} m/s"
    caption = "A24 Fig. 3 at half its size; the largest compression is at 161 ns."
    yield "fig03_snapshots", caption, snapshots(runs, GALLERY / "elastoplastic" / "snapshots", title)


STUDY = Study(
    title="Arakawa et al. (2024): collisions of elastoplastic aggregates",
    question="Do close-packed aggregates compress like elastoplastic spheres, with which yield stress and modulus?",
    values={"packing": "cpe"} | {name: own for name, own in HEAD_ON_ICE.items() if name not in UNCHANGED},
    key=("filling", "radius", "velocity", "seed", *UNCHANGED, "duration"),
    measured=MEASURED,
    pair=("filling", "radius", "seed"),
    rows=rows,
    figures=figures,
    prepared=prepared,
)
