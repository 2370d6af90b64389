"""Oblique collisions of BPCA aggregates with viscous drag, beside Arakawa, Tanaka & Kokubo (2022, A22)."""

from functools import lru_cache, partial
from math import inf, log10

import numpy as np

from ..figures.style import PAPER
from ..measures import fragments
from ..measures.motion import NEAR, pair_velocities, root_mean_square
from ..runs.ledger import WAYS, initial_kinetic_energy
from ..runs.measured import derived_constants
from ..runs.table import Column
from ..theory import Material, pair_constants, sticking_velocity
from .columns import CLOSURE, END, GRAIN_RADIUS, MET, SEED, NotMeasured, group, one, parameter, require_papers_grains
from .comparison import Row
from .estimates import Estimate, beside, estimate, exponent, mean, threshold, where
from .figures import curves, snapshots
from .study import GALLERY, Study

SIZE = 50_000  # grains of A22's aggregates
TWELFTHS = np.arange(13.0)  # 12 B_off^2 of A22's offsets
DRAG = 6e-12  # T_vis [s]: A22's largest
V50, V63 = 10**1.7, 10**1.8  # m/s
REFERENCE = {"velocity": V50, "twelfth": 3.0}  # the collision that A22 shows most
FAST = 10.0  # m/s: A22 section 5.1 counts the pairs of neighbours beyond
LOST = [channel for channels in WAYS.values() for channel in channels]

# What is measured of a run. Numbers that a table rounds are those of A22's grid: 50.1 m/s is 10^1.7 m/s.


def velocity_of_grid(velocity):
    """10^(0.1 i) m/s (A22 section 2.4) where a velocity [m/s] is that to 0.2 %, else the velocity."""
    nearest = 10 ** (0.1 * round(10 * log10(velocity))) if velocity > 0 else velocity
    return nearest if abs(velocity - nearest) < 2e-3 * nearest else velocity


def offset_of_grid(offset):
    """(k/12)^(1/2) where B_off is that to 0.001, else B_off."""
    nearest = (round(12 * offset**2) / 12) ** 0.5
    return nearest if abs(offset - nearest) < 1e-3 else offset


def _grains(run):
    numbers = np.bincount(run.start.aggregate, minlength=2)
    if numbers[0] != numbers[1]:
        raise NotMeasured(f"{run.path}: aggregates of {numbers[0]} and {numbers[1]} grains, A22's are equal")
    require_papers_grains(run)
    return int(numbers[0])


_sticking_velocity = lru_cache(sticking_velocity)  # integrated once for each kind of grain


def _of_two_grains(run, row):
    own = derived_constants(run, "young", "poisson", "density", "surfaceEnergy", "criticalRolling", "viscoelasticTime")
    pair = pair_constants(Material(*own), row["grain_radius"])
    return pair.pull_off_force * pair.pull_off_overlap, _sticking_velocity(pair)


def _fragments(run, row):
    """NotMeasured where a run ended with its duration before the centres would have gone nine tenths of the radii that
    they go in the paper's slowest collisions until its last time (10^1.3 m/s, 6.34 us, r_c = 72.27 r)."""
    time, duration = float(run.history["time"][-1]), float(run.parameters.get("duration") or inf)
    least = 0.9 * (10**1.3 * 6.34e-6 / 72.27e-7) * row["characteristic_radius"] / row["velocity"]
    if 0.999 * duration <= time < least:
        raise NotMeasured(
            f"{run.path}: lasts {time:.3g} s, too short for final fragments: must be {least:.3g} s or more"
        )
    sizes = fragments.fragment_sizes(fragments.fragment_labels(len(run.last.radius), run.last.contact_pairs))
    grains, number = np.unique(sizes, return_counts=True)
    text = " ".join(f"{n}x{size}" for size, n in zip(grains[::-1], number[::-1]))
    return int(sizes.max()), fragments.growth_efficiency(int(sizes.max()), row["grains"], row["grains"]), text


def _neighbours(run, row):
    """Largest rms of v_rel [m/s], and number of pairs that approach or part faster than FAST over N_tot, of pairs
    nearer than NEAR over the states (A22 section 5.1); NaN for other collisions than REFERENCE, since all states are
    read."""
    if abs(row["velocity"] / V50 - 1) > 2e-3 or abs(row["impact"] ** 2 - 0.25) > 5e-4:
        return np.nan, np.nan
    near = NEAR * run.derived["grainRadius"]
    speeds = [pair_velocities(state.position, state.velocity, near) for state in run.states]
    fast = max(np.count_nonzero(sign * own > FAST) for own in speeds for sign in (1, -1))
    return float(np.nanmax([root_mean_square(own) for own in speeds])), fast / len(run.start.radius)


def _radius(run):
    return float(np.mean(derived_constants(run, "targetCharacteristicRadius", "projectileCharacteristicRadius")))


MEASURED = (
    one("grains", "", "grains of each aggregate", _grains, kind="i"),
    parameter("impact", "", "B_off (A22 eq 27); (k/12)^(1/2) where the run's is that rounded", shown=offset_of_grid),
    parameter("velocity", "m/s", "collision velocity; 10^(0.1 i) where it is that rounded", shown=velocity_of_grid),
    parameter("viscoelasticTime", "s", "T_vis of the viscous drag", shown=lambda time: round(time, 16)),
    SEED,
    GRAIN_RADIUS,
    group(
        _of_two_grains,
        Column("energy_unit", "J", "F_c delta_c"),
        Column("sticking_velocity", "m/s", "v_stick of two such grains head-on (A22 eq 30); inf: they always stick"),
    ),
    one("characteristic_radius", "m", "mean r_c of the two aggregates", _radius),
    MET,
    group(
        _fragments,
        Column("largest", "", "N_lar: grains of the largest fragment", kind="i"),
        Column("growth", "", "f_gro (A22 eq 28)"),
        Column("fragments", "", "their grains at the end, as NUMBERxGRAINS, the largest first", kind="O"),
    ),
    one("kinetic_at_start", "J", "K(0)", lambda run: initial_kinetic_energy(run.history)),
    group(
        lambda run, row: [float(run.history[name][-1] - run.history[name][0]) for name in LOST],
        *(Column(name, "J", "change from the start to the end") for name in LOST),
    ),
    group(
        lambda run, row: [float(run.history[n][-1]) if n in run.history else np.nan for n in ("formed", "broken")],
        Column("formed", "", "N_con: contacts formed", gaps=True),
        Column("broken", "", "N_cut: contacts broken", gaps=True),
    ),
    group(
        _neighbours,
        Column(
            "pair_speed", "m/s", f"largest rms of v_rel of pairs nearer than {NEAR:g} r (50.1 m/s, 3/12)", gaps=True
        ),
        Column("fast_pairs", "", f"of them faster than {FAST:g} m/s, over N_tot", gaps=True),
    ),
    CLOSURE,
    END,
)


def prepared(runs):
    """The table with 12 B_off^2 as `twelfth` and what is lost in each way [J], and in all."""
    ways = {way: runs[channels].sum(axis=1) for way, channels in WAYS.items()}
    return runs.assign(twelfth=(12 * runs.impact**2).round(6), lost=runs[LOST].sum(axis=1), **ways)


# Statistics of runs.


def complete(runs, twelfths=TWELFTHS):
    """The runs at these offsets of the pairs that have all of them."""
    runs = runs[runs.twelfth.isin(twelfths)]
    return runs[runs.groupby("pair").twelfth.transform("nunique") == len(twelfths)]


def over_offsets(twelfths=TWELFTHS, values="growth"):
    """Statistic: mean over pairs of <A> = int 2 B A dB = int A d(B^2) (A22 eq 29) of a column, trapezoidal in B^2."""
    weights = np.convolve(np.diff(twelfths) / (twelfths[-1] - twelfths[0]), [0.5, 0.5])

    def of(runs):
        means = [np.mean(own.to_list(), axis=0) for _, own in complete(runs, twelfths).groupby("twelfth")[values]]
        return weights @ np.array(means) if means else np.nan

    return of


def falls_at(runs):
    """Velocity [m/s] at which the mean growth efficiency falls through 0."""
    growth = {velocity: over_offsets()(own) for velocity, own in runs.groupby("velocity")}
    known = {velocity: value for velocity, value in growth.items() if np.isfinite(value)}
    return threshold(list(known), list(known.values()))


@lru_cache(maxsize=4096)
def sizes_of(text):
    """Grains of fragments (K,) int from '1x43957 2x12'; ValueError for another text."""
    pairs = [part.split("x") for part in text.split()]
    return np.repeat([int(grains) for _, grains in pairs], [int(number) for number, _ in pairs])


def small_fragments(runs):
    """Number (runs,) of fragments of one or two grains."""
    return runs.fragments.map(lambda text: np.count_nonzero(sizes_of(text) <= 2)).astype(float)


def by_size(runs, cumulative):
    """(N (G,), mean over offsets of cumulative(sizes of fragments, N) (G,)): A22's N_cum, S_cum; NaN without all
    offsets."""
    own = complete(runs)
    numbers = np.unique(np.geomspace(1, 2 * runs.grains.max(), 60).round().astype(int)) if len(own) else np.ones(3)
    curve = lambda text: cumulative(sizes_of(text), numbers).astype(float)
    return numbers, over_offsets(values="curve")(own.assign(curve=own.fragments.map(curve))) * np.ones(len(numbers))


def fragment_exponent(runs, least):
    """alpha of f(N) ~ N^-alpha from N_cum ~ N^(2 - alpha) (A22 eq 41), N from `least` to the grains of an aggregate."""
    numbers, grains = by_size(runs, fragments.cumulative_grains)
    inside = (numbers >= least) & (numbers <= runs.grains.max())
    return 2 - exponent(numbers[inside], grains[inside])


def large_share(runs):
    """Part of the cross-section in fragments of more than 5 % of all grains."""
    numbers, section = by_size(runs, fragments.cumulative_cross_section)
    return 1 - section[numbers <= 0.1 * runs.grains.max()][-1:].sum() / section[-1]


def lead(way, extreme):
    """Statistic: what is lost in a way less the extreme (max, min) of the others, in % of all that is lost."""
    share = lambda runs, name: 100 * mean(lambda own: own[name] / own.lost)(runs)
    return lambda runs: share(runs, way) - extreme(share(runs, name) for name in WAYS if name != way)


def a_grain(*events):
    """Statistic: events (columns) over all grains."""
    return mean(lambda runs: runs[list(events)].sum(axis=1, skipna=False) / (2 * runs.grains))


def in_units(way):
    """Statistic: what is lost in a way over N_tot F_c delta_c."""
    return mean(lambda runs: runs[way] / (2 * runs.grains * runs.energy_unit))


def rows(runs):
    """A22's numbers beside ours, then those that are ours alone."""
    own, A22 = partial(where, where(runs, grains=SIZE)), partial(Row, runs=1)
    none, drag = (own(viscoelasticTime=time, **REFERENCE) for time in (0.0, DRAG))
    at = "50.1 m/s, B_off² = 3/12"
    largest = mean("largest")
    yield A22(f"largest fragment, {at}, no drag", estimate(largest, none), 43957, "43,957", "3.1")
    yield A22(f"largest fragment, {at}, 6 ps", estimate(largest, drag), 47919, "47,919", "3.1")
    more = beside(largest, drag, none)
    yield A22(f"largest fragment, {at}, 6 ps less no drag", more, 3962, "3,962, “hardly depends”", "3.1")
    few = beside(mean(small_fragments), drag, none, np.divide)
    yield A22("fragments of 1 or 2 grains, 6 ps over no drag", few, (None, 1), "“significantly decreases”", "3.1")
    for time, what in ((0.0, "no drag"), (DRAG, "6 ps")):
        v_fra = estimate(falls_at, own(viscoelasticTime=time))
        yield A22(f"threshold velocity of fragmentation, {what} [m/s]", v_fra, (50, 60), "50–60", "3.2")
    for of, what in ((none, "no drag"), (drag, "6 ps")):
        more = estimate(lead("rolling", max), of)
        yield A22(f"lost by rolling less by any other way, {what} [%]", more, (0, None), "“the main mechanism”", "5.2")
    less = estimate(lead("contacts", min), drag)
    yield A22("lost by contacts less by any other way, 6 ps [%]", less, (None, 0), "“the smallest among five”", "5.2")
    sliding, twisting = (beside(mean(way), drag, none, np.divide) for way in ("sliding", "twisting"))
    yield A22("lost by sliding, 6 ps over no drag", sliding, (None, 1), "“decreases”", "5.2")
    yield A22("lost by twisting, 6 ps over no drag", twisting, (0.9, 1.1), "“hardly depends”: to 10 %", "5.2")
    speed, fast = estimate(mean("pair_speed"), drag), estimate(mean("fast_pairs"), none)
    yield A22("largest rms velocity between neighbours, 6 ps [m/s]", speed, (None, 1), "below 1", "5.1")
    yield A22("neighbours faster than 10 m/s over all grains, no drag", fast, (None, 0.01), "below 0.01", "5.1")
    formed, broken = (estimate(a_grain(name), none) for name in ("formed", "broken"))
    both = estimate(a_grain("formed", "broken"), none)
    yield A22("contacts broken a grain, no drag", broken, (None, 1), "below 1", "5.3")
    yield A22("contacts formed a grain, no drag", formed, (0.5, 2), "about 1: 0.5 to 2, chosen knowing ours", "5.3")
    yield A22(
        "contacts formed and broken a grain, no drag", both, (0.5, 2), "about 1: 0.5 to 2, chosen knowing ours", "5.2"
    )
    lost = estimate(in_units("contacts"), none)
    yield A22("lost by contacts, no drag [N_tot F_c δ_c]", lost, (0.3, 3), "of order 1: 0.3 to 3", "5.2")
    stick = runs.groupby("viscoelasticTime").sticking_velocity.first()
    ratio = Estimate(stick.get(DRAG, np.nan) / stick.get(0.0, np.nan))
    yield Row("sticking velocity of two grains, 6 ps over no drag", ratio, (9, 11), "about 10: to 10 %", "3.3")
    radius = estimate(mean(lambda r: r.characteristic_radius / r.grain_radius), own())
    yield A22("characteristic radius of an aggregate [r]", radius, 72.27, "72.29 and 72.25", "2.4")
    head_on = estimate(mean("growth"), own(viscoelasticTime=0.0, velocity=V50, twelfth=0.0))
    yield A22("growth efficiency head-on, 50.1 m/s, no drag", head_on, (0.95, 1.05), "about 1: to 5 %", "3.2")
    none, drag = (own(viscoelasticTime=time, velocity=V50) for time in (0.0, DRAG))
    more = beside(over_offsets(), complete(drag), complete(none))
    what = "mean growth efficiency, 50.1 m/s, 6 ps less no drag"
    yield A22(what, more, (-0.05, 0.05), "“hardly depends”: to 0.05", "3.2")
    growth = estimate(over_offsets(), own(viscoelasticTime=0.0, velocity=V63))
    yield A22("mean growth efficiency, 63 m/s, no drag", growth, (None, 0), "negative", "3.2")
    for least, printed in ((100, "1"), (1, "1, “for arbitrary N”")):
        alpha = estimate(partial(fragment_exponent, least=least), drag)
        yield A22(f"α of fragments' sizes N^-α from {least} on, 50.1 m/s, 6 ps", alpha, 1, printed, "3.4, 4")
    for of, what in ((none, "no drag"), (drag, "6 ps")):
        share, what = estimate(large_share, of), f"cross-section in fragments above 5 % of all grains, 50.1 m/s, {what}"
        yield A22(what, share, (0.5, None), "“dominated by largest”", "3.4")
    yield from _new(runs)


def _new(runs):
    """What other sizes, offsets and 63 m/s add."""
    for size, twelfths in ((500, TWELFTHS), (2000, TWELFTHS), (10_000, TWELFTHS[::2]), (SIZE, TWELFTHS)):
        own = partial(where, where(runs, grains=size, velocity=V50))
        what = f"mean growth efficiency, 50.1 m/s, {size:,} grains"
        yield Row(f"{what}, no drag", estimate(over_offsets(twelfths), own(viscoelasticTime=0.0)))
        for few in (twelfths, TWELFTHS[2:6], TWELFTHS[6:10]):
            drag, none = (complete(own(viscoelasticTime=time), few) for time in (DRAG, 0.0))
            mean_over = over_offsets(few) if few is twelfths else mean("growth")
            offsets = f"B_off² = {few[0]:g}/12 to {few[-1]:g}/12"
            yield Row(f"{what}, {offsets}, 6 ps less no drag", beside(mean_over, drag, none))
    for time, what in ((0.0, "no drag"), (DRAG, "6 ps")):
        v_fra = estimate(falls_at, where(runs, grains=500, viscoelasticTime=time))
        yield Row(f"threshold velocity of fragmentation, 500 grains, {what} [m/s]", v_fra)
    none, drag = (where(runs, grains=SIZE, viscoelasticTime=time) for time in (0.0, DRAG))
    yield Row("threshold velocity of fragmentation, 6 ps less no drag [m/s]", beside(falls_at, drag, none))
    yield Row("mean growth efficiency, 63 m/s, 6 ps", estimate(over_offsets(), where(drag, velocity=V63)))
    more = beside(over_offsets(), *(complete(where(of, velocity=V63)) for of in (drag, none)))
    yield Row("mean growth efficiency, 63 m/s, 6 ps less no drag", more)
    fast = where(runs, grains=SIZE, viscoelasticTime=0.0, velocity=V63, twelfth=3.0)
    for way in ("sliding", "rolling"):
        yield Row(f"lost by {way}, 63 m/s, B_off² = 3/12, no drag [N_tot F_c δ_c]", estimate(in_units(way), fast))
    share = mean(lambda r: 100 * r["rolling"] / r.lost)
    none = where(runs, grains=SIZE, viscoelasticTime=0.0, **REFERENCE)
    yield Row("lost by rolling of all that is lost, 50.1 m/s, B_off² = 3/12, no drag [%]", estimate(share, none))


def figures(runs):
    """A22's Figs 1 to 3."""
    runs = runs.sort_values(["grains", "viscoelasticTime"], kind="stable")
    drag = [f"$T_{{vis}}$ = {time * 1e12:g} ps" for time in runs.viscoelasticTime]
    runs = runs.assign(drag=drag, size=[f"{grains:,} grains" for grains in runs.grains])
    by = {"colour": "drag", "panel": "size", "level": 0.0}
    at_50, growth, look = where(runs, velocity=V50), partial(estimate, mean("growth")), {"limits": (-0.6, 1.05)}
    figure = curves(at_50, growth, "twelfth", **by, **look, x_label="$12 B_{off}^2$", y_label="$f_{gro}$")
    yield "fig02_at_offset", "A22 Fig. 2: growth efficiency at 50.1 m/s against the offset.", figure
    paper = lambda axes, panel: axes.axvspan(50, 60, color=PAPER, alpha=0.12, lw=0, label="A22: $v_{fra}$, 50,000")
    look = {"log": "x", "x_label": "$v$ [m/s]", "y_label": r"$\langle f_{gro} \rangle$", "paper": paper}
    figure = curves(runs, partial(estimate, over_offsets()), "velocity", **by, **look)
    yield "fig03_mean_growth", "A22 Fig. 3: growth efficiency, mean over 13 offsets, against velocity.", figure
    caption = "A22 Fig. 1 with 2,000 grains each, 50.1 m/s, B_off² = 3/12, at its times in proportion to the radii."
    yield "fig01_snapshots", caption, snapshots(runs, GALLERY / "viscous" / "snapshots", lambda row: row.drag)


STUDY = Study(
    title="Arakawa et al. (2022): viscous drag, growth and fragmentation",
    question="How much does viscous drag between grains help colliding aggregates to grow, at which velocity do they "
    "fragment, and how are the fragments distributed?",
    # Collisions of equal BPCA aggregates of equal ice grains, without bonds, springs held at their limits.
    values={"packing": "bpca", "neck": 0.0, "planar": 0, "material": "ice", "sizes": "equal", "limit": "held"},
    key=("grains", "impact", "velocity", "viscoelasticTime", "seed"),
    measured=MEASURED,
    pair=("grains", "seed"),
    rows=rows,
    figures=figures,
    prepared=prepared,
)
