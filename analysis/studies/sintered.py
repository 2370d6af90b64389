"""Collisions of sintered aggregates, beside Sirono & Ueno (2017, S17)."""

from functools import partial
from math import nan, pi

import numpy as np
from scipy.optimize import brentq

from ..figures.style import PAPER
from ..measures.fragments import fragment_labels, fragment_sizes
from ..measures.network import loops
from ..measures.outcome import BOUNCING, STICKING
from ..measures.structure import gyration_radius
from ..runs.format import BROKEN_BONDS, CHANNELS
from ..runs.ledger import fractions_at
from ..runs.measured import derived_constants
from ..theory.bonds import breaking_energy, stretching_period
from ..theory.pair_constants import ICE, pair_constants
from . import columns
from .columns import Column, NotMeasured, constant, group, parameter
from .comparison import Row
from .estimates import beside, ending, estimate, mean, threshold, where
from .figures import curves, snapshots
from .study import GALLERY, Study

# The parts of Fig. 14 and their channels; after what is stored, what is lost.
PARTS = {
    "kinetic": ("kinetic",),
    "elastic": ("normal", "sliding", "rolling", "twisting"),
    "rolling_friction": ("rollingDissipation",),
    "sliding_friction": ("slidingDissipation", "twistingDissipation"),
    "stretching": ("connection", "disconnection"),
    "necks": ("bondBreaking",),
    "drag": ("drag",),
}
LOST = [f"part_{name}" for name in PARTS if name not in ("kinetic", "elastic")]
# Times of energies beside the end, in periods of the stretching vibration (S17 prints none for its Fig. 14).
TIMES = (1250, 2500, 5000, 10_000, 20_000)
FRAGMENT = 0.25  # of the total mass: lighter pieces are fragments (section 5.3)
AMPLITUDE, EXPONENT = 3.7e-2, 0.97  # S17's fit of broken necks (section 5.3)
OF_AGGREGATES = "growth_velocity", "cut", "sliding_factor", "grains", "packing_seed"
FIVE = ((0.0, 0.2), (0.0, 0.7), (1.0, 0.7), (3.0, 0.7), (10.0, 0.7))  # (V_g, beta) in S17's Fig. 15


def _aggregates(run, row):
    """NotMeasured for other aggregates, and for unlike grains or others than S17's (but xi_crit and sliding spring)."""
    columns.require_papers_grains(run, but=("criticalRolling", "slidingStiffnessFactor"))
    start, parameters, about = run.start, run.parameters, run.derived.get("targetPacking") or {}
    if not np.allclose(start.radius, start.radius[0]):
        raise NotMeasured(f"{run.path}: grains of unlike radii, S17's are equal")
    if parameters["packing"] not in ("bcca", "file"):
        raise NotMeasured(f"{run.path}: packing = {parameters['packing']}, S17's are bcca and file")
    springs = int(parameters.get("limit", "held") == "cut"), float(parameters.get("slidingStiffnessFactor", 1.0))
    grown = float(about.get("growthVelocity", 0.0)), int(about.get("seed", parameters["seed"]))
    contacts = 2.0 * len(start.contact_pairs) / len(start.radius)
    radii = [gyration_radius(start.position[start.aggregate == k]) for k in (0, 1)]
    return *springs, *grown, len(start.radius), contacts, float(np.mean(radii)) / row["grain_radius"]


def pieces(position, pairs, radius):
    """Mass fractions of the largest piece that equal grains at position (N,3) [m] make, joined by pairs (M,2), of the
    second, and of all below FRAGMENT; gyration radius of the largest over a grain's [m]."""
    labels = fragment_labels(len(position), pairs)
    largest, second, *_ = fractions = np.append(fragment_sizes(labels), 0) / len(position)
    small = fractions[fractions < FRAGMENT].sum()
    return float(largest), float(second), float(small), gyration_radius(position[labels == 0]) / radius


def _necks(run, row):
    """E_k/E_sint = (m V_c^2/4)/(pi gamma (beta R)^2) (S17 section 5.3), necks at the start, and broken ones by mode."""
    density, energy = derived_constants(run, "density", "surfaceEnergy")
    kinetic = 0.25 * 4.0 / 3.0 * pi * density * row["grain_radius"] ** 3 * row["velocity"] ** 2
    ratio = kinetic / breaking_energy(row["neck"], row["grain_radius"], energy) if row["neck"] else nan
    broken = (int(run.history[name][-1]) if name in run.history else 0 for name in BROKEN_BONDS)
    return ratio, int(np.count_nonzero(run.start.contact_bonded)), *broken


def _parts(run, row):
    """PARTS at the end, and what is left after each of TIMES [K(0)]; NaN where a run is not as long."""
    end, period = run.history["time"][-1], stretching_period(pair_constants(ICE, row["grain_radius"]))

    def after(time):
        changes = fractions_at(run.history, min(time, end)) if end >= 0.99 * time else dict.fromkeys(CHANNELS, nan)
        return [float(sum(changes[channel] for channel in channels)) for channels in PARTS.values()]

    return *after(end), *(sum(after(number * period)[:2]) for number in TIMES)


MEASURED = (
    parameter("planar", "", "1: grains in a plane", "i"),
    parameter("neck", "", "beta; 0: unsintered"),
    columns.VELOCITY,
    constant("criticalRolling", "m", "xi_crit"),
    parameter("viscoelasticTime", "s", "T_vis of the viscous drag"),
    columns.GRAIN_RADIUS,
    group(
        _aggregates,
        Column("cut", "", "1: springs are cut at the limits, 0: held there", kind="i"),
        Column("sliding_factor", "", "k_s over W07's 8 a0 G*; 2: S17 eqs 11 and 12"),
        Column("growth_velocity", "m/s", "V_g of the compacted aggregates; 0: BCCA"),
        Column("packing_seed", "", "random seed of the aggregates", kind="i"),
        Column("grains", "", "grains of both aggregates", kind="i"),
        Column("contacts", "", "contacts a grain at the start"),
        Column("initial_radius", "", "gyration radius of an aggregate at the start, mean of both, in R"),
    ),
    columns.MET,
    columns.OUTCOME,
    group(
        lambda run, row: pieces(run.last.position, run.last.contact_pairs, row["grain_radius"]),
        Column("largest", "", "sticking efficiency: fraction of the mass in the largest piece"),
        Column("second", "", "fraction of the mass in the second one"),
        Column("fragments", "", f"fraction of the mass in pieces of less than {FRAGMENT:g} of it"),
        Column("gyration_radius", "", "gyration radius of the largest piece, in R (S17 eq 13)"),
    ),
    group(
        _necks,
        Column("energy_ratio", "", "E_k/E_sint, E_k = m V_c^2/4 (S17 section 5.3)", gaps=True),
        Column("necks_at_start", "", "sintered bonds at the start", kind="i"),
        *(Column(name, "", "necks broken so", kind="i") for name in BROKEN_BONDS),
    ),
    group(
        _parts,
        *(Column(f"part_{n}", "K(0)", "in that way at the end, or until then") for n in PARTS),
        *(Column(f"left_{n}", "K(0)", f"kinetic and stored energy after {n} periods", gaps=True) for n in TIMES),
    ),
    group(
        lambda run, row: loops(row["grains"], run.last.contact_pairs),
        Column("loops", "", "independent loops of contacts in both aggregates at the end", gaps=True),
        Column("loop_grains", "", "grains in loops", gaps=True),
    ),
    columns.CLOSURE,
    columns.END,
)


def prepared(runs):
    """The table with what is not S17's as `setup` (cut, held, space, ...), broken necks, and what is lost [K(0)]."""
    broken, lost = runs[list(BROKEN_BONDS)].sum(axis=1), runs[LOST].sum(axis=1)
    over_line = broken / runs.grains / (AMPLITUDE * runs.energy_ratio**EXPONENT)
    setup = [_setup(row) for row in runs.itertuples()]
    necks = broken / runs.grains
    return runs.assign(setup=setup, broken_bonds=broken, necks=necks, over_line=over_line, lost=lost)


def _setup(row):
    """S17: springs are cut at their limits, in the plane, xi_crit = 2 Angstrom, no drag, 2 x 1,024 grains of BCCA."""
    special = {
        "held": not row.cut,
        "space": not row.planar,
        f"{row.criticalRolling * 1e10:g} Å": abs(row.criticalRolling - 2e-10) > 1e-19,
        f"{row.viscoelasticTime * 1e12:g} ps": row.viscoelasticTime,
        f"k_s {row.sliding_factor / 2:g}": row.sliding_factor != 2,
        f"{row.grains / 2:g} grains": not row.growth_velocity and row.grains != 2048,
    }
    return ", ".join(name for name, is_so in special.items() if is_so) or "cut"


def critical_velocity(runs):
    """Velocity [m/s] at which the mean largest piece falls to a half of the mass: growth below (S17 section 5.1)."""
    largest = runs.groupby("velocity").largest.mean()
    return threshold(largest.index, largest - 0.5)


def by_mode(mode):
    """Statistic: necks broken by Rolling (...) in % of all; each kind of aggregates and velocity counts once."""
    of_kinds = lambda runs: runs.groupby(["setup", "growth_velocity", "neck", "velocity"]).mean(numeric_only=True).sum()
    return lambda runs: 100 * of_kinds(runs)[f"brokenBy{mode}"] / of_kinds(runs).broken_bonds if len(runs) else nan


def necks_exponent(runs):
    """n of N_cut/N_t = A (E_k/E_sint)^n: maximum likelihood of Poisson counts, which knows runs without a broken neck.

    With the best A for each n it is largest where the mean of x = ln(E_k/E_sint) over broken necks is that over all
    grains weighted with exp(n x)."""
    x, broken = np.log(runs.energy_ratio.to_numpy()), runs.broken_bonds.to_numpy()
    if len(np.unique(x[broken > 0].round(3))) < 2:
        return nan
    target = np.average(x, weights=broken)
    weights = lambda n: runs.grains.to_numpy() * np.exp(n * (x - x.max()))
    return brentq(lambda n: np.average(x, weights=weights(n)) - target, -20, 20, xtol=1e-13)


# S17's words on collisions at V_g [m/s] (0: BCCA), β and velocity [m/s]; springs: limits, as printed, section.
MOST, FEW, FIFTH = (0.5, None), (None, 0.5), ((0.1, 0.3), "about 0.2: 0.1 to 0.3", "5.2")
BOTH, CUT = ("cut", "held"), ("cut",)
LARGEST = (
    (0, 0.0, 30, BOTH, (0.9, None), "“close to unity”: 0.9", "5.1"),
    (0, 0.0, 50, BOTH, MOST, "more than 0.5", "5.1"),
    (0, 0.2, 30, BOTH, MOST, "growth: 0.5", "5.3"),
    (0, 0.4, 30, BOTH, MOST, "growth: 0.5", "5.3"),
    (0, 0.5, 30, BOTH, FEW, "no growth: 0.5", "5.3"),
    (0, 0.7, 15, BOTH, None, "0.2; at 20 m/s also a half", "5.2"),
    (0, 0.7, 20, BOTH, None, "0.2; at 20 m/s also a half", "5.2, abstract"),
    (0, 0.7, 30, BOTH, *FIFTH),
    (1, 0.7, 30, BOTH, *FIFTH),
    *((1, 0.7, v, CUT, *FIFTH) for v in (15, 20, 50, 100)),
)
ENDINGS = (
    (STICKING, 0, 0.0, 10, BOTH, MOST, "“stick perfectly”: most", "5.1"),
    (BOUNCING, 0, 0.7, 10, BOTH, 0.4, "2 of 5", "5.4"),
    (BOUNCING, 3, 0.7, 3, BOTH, MOST, "“only bouncing”: most", "5.3"),
    (BOUNCING, 3, 0.7, 10, BOTH, MOST, "bouncing: most", "5.2"),
    (BOUNCING, 5, 0.7, 5, CUT, MOST, "“only bouncing”: most", "5.3"),
    *((BOUNCING, growth, 0.7, v, CUT, MOST, "bouncing: most", "5.2") for growth in (3, 10) for v in (5, 15, 20)),
    *((BOUNCING, growth, 0.7, v, CUT, FEW, "fragmentation: few", "5.2") for growth in (3, 10) for v in (50, 100)),
    # the rule that ended our slow runs took too many for stuck
    *((STICKING, growth, 0.7, 10**0.5, CUT, None, "“perfect sticking”", "5.2") for growth in (0, 1)),
    *((BOUNCING, growth, 0.7, 10, ("space",), None, "“also to 3D”, of other chains", "6.2") for growth in (1, 3, 10)),
)


def at(runs, setup, velocity, growth=0, neck=0.7):
    """Runs at a place."""
    return where(runs, setup=setup, velocity=velocity, growth_velocity=growth, neck=neck)


def rows(runs):
    """S17's numbers, of five pairs, beside ours; then those that are ours alone."""
    S17, largest = partial(Row, runs=5), partial(estimate, mean("largest"))
    place = "V_g = {:g} m/s, β = {:g}, {:.3g} m/s, {}".format
    for growth, neck, v, rules, *words in LARGEST:
        for rule in rules:
            own = largest(at(runs, rule, v, growth, neck))
            yield S17(f"largest piece, {place(growth, neck, v, rule)}", own, *words)
    for outcome, growth, neck, v, rules, *words in ENDINGS:
        for rule in rules:
            own = ending(at(runs, rule, v, growth, neck), outcome)
            yield S17(f"{outcome}, {place(growth, neck, v, rule)}", own, *words)
    for rule in BOTH:
        bcca = where(runs, setup=rule, growth_velocity=0, neck=0.7)
        critical, what = estimate(critical_velocity, bcca), f"critical velocity for growth [m/s], β = 0.7, {rule}"
        yield S17(what, critical, 20, "20", "abstract")
        of, plain, what = at(runs, rule, 20), at(runs, rule, 20, neck=0), f"β = 0.7 less unsintered, 20 m/s, {rule}"
        less = beside(mean("largest"), of, plain)
        yield S17(f"largest piece, {what}", less, (None, 0), "“decreased”", "abstract")
        less = beside(mean("gyration_radius"), of, plain)
        yield S17(f"gyration radius [r], {what}", less, (None, 0), "“the smallest”", "5.1")
        less = beside(mean("fragments"), at(runs, rule, 30, 3), at(runs, rule, 30))
        what = f"mass in fragments, V_g = 3 m/s less BCCA, β = 0.7, 30 m/s, {rule}"
        yield S17(what, less, (None, 0), "“fewer”", "5.3")
    yield from (S17(*row) for row in (*_necks(runs), *_energies(runs)))
    yield from (Row(*row) for row in _space(runs))


def _necks(runs):
    """How many necks break, and how: (quantity, ours, paper's, printed, section)."""
    line = "broken necks over S17's 0.037 (E_k/E_sint)^0.97, β = 0.7"
    for rule in BOTH:
        for v in (30, 50):
            own = estimate(mean("over_line"), at(runs, rule, v))
            yield f"{line}, {v} m/s, {rule}", own, (0.5, 2), "on the line: to a factor of 2", "5.3"
    own, cut = estimate(mean("over_line"), at(runs, "cut", 10)), runs[runs.setup == "cut"]
    yield f"{line}, 10 m/s, cut", own, None, "on the line, fitted from where?", "5.3"
    law = estimate(necks_exponent, cut[cut.neck > 0.65])
    yield "exponent of E_k/E_sint, β = 0.7, cut", law, EXPONENT, "0.97, without error", "5.3"
    for growth in (1, 3, 10):
        over = beside(mean("necks"), at(runs, "cut", 30, growth), at(runs, "cut", 30), np.divide)
        what = f"broken necks, V_g = {growth} m/s over BCCA, β = 0.7, 30 m/s, cut"
        yield what, over, (0.8, 1.25), "the same: 0.8 to 1.25", "5.3"
    five = cut[np.array([kind in FIVE for kind in zip(cut.growth_velocity, cut.neck)], dtype=bool)]
    own, one = (estimate(by_mode("Rolling"), kinds) for kinds in (five, where(cut, growth_velocity=10, neck=0.7)))
    yield "necks broken by rolling, five kinds together, cut [%]", own, (90, None), "more than 90", "5.3"
    yield "necks broken by rolling, V_g = 10 m/s, β = 0.7, cut [%]", one, None, "not of one kind", "5.3"


def _energies(runs):
    """Where the energy goes at 10 m/s, and loops of grains; how the paper counts these is not printed."""
    share = mean(lambda r: 100 * r.part_rolling_friction / r.lost)
    for rule in BOTH:
        own = estimate(share, at(runs, rule, 10, neck=0))
        yield f"lost by rolling of all that is lost, β = 0, 10 m/s, {rule} [%]", own, None, "80, of K(0)", "5.3"
    lost = estimate(mean("part_necks"), at(runs, "cut", 10, neck=0.2))
    yield "lost by breaking necks, β = 0.2, 10 m/s, cut [K(0)]", lost, None, "0.2, of another count", "5.3"
    for number in (5000, 20_000):
        left = estimate(mean(f"left_{number}"), at(runs, "cut", 10, neck=0.5))
        what = f"kinetic and stored energy after {number} periods, β = 0.5, 10 m/s, cut [K(0)]"
        yield what, left, None, "0.4, at no printed time", "5.3"
    size = estimate(mean(lambda r: r.loop_grains / r.loops.where(r.loops > 0)), at(runs, "cut", 10))
    yield "grains in a loop, β = 0.7, 10 m/s, cut", size, 44, "44", "5.4"


def _space(runs):
    """Space, where S17 ran nothing."""
    necks = partial(beside, mean("necks"), of=np.divide)
    for neck in (0.2, 0.7):
        own = necks(at(runs, "space", 30, neck=neck), at(runs, "cut", 30, neck=neck))
        what = f"broken necks, space over plane, β = {neck}, 30 m/s, cut"
        yield what, own, (0.8, 1.25), "as many: 0.8 to 1.25", "6.2"
    less = beside(mean("largest"), at(runs, "space", 20), at(runs, "cut", 20))
    yield "largest piece, β = 0.7, 20 m/s, space less plane, cut", less, None, "the same critical velocity", "6.2"
    for growth in (1, 3):
        own = ending(at(runs, "space", 10, growth), STICKING)
        yield f"sticking, V_g = {growth} m/s, β = 0.7, 10 m/s, space, cut", own
    own = necks(at(runs, "held, space", 30), at(runs, "cut", 30))
    yield "broken necks, held in space over cut in the plane, β = 0.7, 30 m/s", own
    critical = estimate(critical_velocity, where(runs, setup="held, space", growth_velocity=0, neck=0.7))
    yield "critical velocity for growth [m/s], β = 0.7, held, space", critical
    twisting = estimate(by_mode("Twisting"), where(runs, setup="space", growth_velocity=0, neck=0.7))
    yield "necks broken by twisting, β = 0.7, space, cut [%]", twisting
    for setup, name in (("space", "space"), ("cut", "plane")):
        width = estimate(mean("initial_radius"), where(runs, setup=setup, growth_velocity=0))
        yield f"gyration radius of an aggregate at the start, {name} [r]", width


def figures(runs):
    """S17's words beside the largest piece, and states of its Figs 7 and 9."""
    own = runs[(runs.growth_velocity == 0) & runs.setup.isin(BOTH) & runs.neck.isin((0, 0.7))]
    own = own.assign(of=[f"β = {neck:g}" for neck in own.neck]).sort_values(["neck", "setup"], kind="stable")

    def paper(axes, panel):
        """S17: 50 m/s unsintered, 20 m/s sintered, where about 0.2 is left at 30 m/s."""
        axes.plot(20 if "0.7" in panel else 50, 0.5, "x", color=PAPER, markersize=10, mew=2, label="S17")
        if "0.7" in panel:
            axes.plot([30, 30], [0.1, 0.3], color=PAPER, lw=9, alpha=0.2, solid_capstyle="butt")

    look = {"log": "x", "level": 0.5, "limits": (0, 1.05), "paper": paper}
    look |= {"x_label": "$v$ [m/s]", "y_label": "mass in the largest piece"}
    figure = curves(own, partial(estimate, mean("largest")), "velocity", "setup", "of", **look)
    yield "held", "Largest piece, springs cut at their limits or held there, beside S17's words (purple).", figure
    title = lambda row: f"β = {row.neck:g}, {row.velocity:.2g} m/s, {row.setup}"
    caption = "S17 Figs 7 and 9: states at the paper's times (at 30 m/s a quarter of them), run again."
    yield "fig07_snapshots", caption, snapshots(runs, GALLERY / "sintered" / "snapshots", title)


STUDY = Study(
    title="Sirono & Ueno (2017): collisions of sintered aggregates",
    question="Do sintered icy aggregates grow, bounce or break when they collide, and is it the same in space?",
    # Head-on collisions of equal aggregates of equal ice grains: BCCA ones, and those that collisions have compacted.
    values={"material": "ice", "impact": 0.0, "sizes": "equal"},
    key=("velocity", "neck", "planar", "viscoelasticTime", "criticalRolling", *OF_AGGREGATES),
    measured=MEASURED,
    # A compacted aggregate grows from the first half of the BCCA aggregate of its seed: one pair.
    pair=("planar", "packing_seed"),
    rows=rows,
    figures=figures,
    prepared=prepared,
)
