"""The study of S17's collisions: which quantities the runs tell. A pair of aggregates collides at every velocity, beta and rule."""

from ...measures.outcome import BOUNCING, UNDECIDED
from ...runs.collect import Scene
from ...runs.format import BROKEN_BONDS
from ..collisions import outcome_quantities
from ..definition import Quantity, Study
from ..runs import Runs, alike, differences, finite, ratios, select, together
from ..threshold import thresholds
from .measure import LABELS, MEASURED, TIMES
from .models import chain_ratio, fit_necks, papers_necks

POINT = ("setup", "growth_velocity", "neck", "velocity")
KIND = ("setup", "neck", "velocity")
# S17's: springs of ordinary contacts are cut at their limits, in the plane, xi_crit = 2 Angstrom, no drag.
PLAIN = "cut"
GRAINS = 2048  # of both BCCA aggregates (section 4)
HALF = 0.5  # of the total mass: what the largest piece must keep for growth (section 5.1)
CURVE = 4  # velocities or more: with fewer, where it falls to a half lies anywhere between two of them
# (V_g, beta) of the aggregates in S17's Fig. 15.
FIVE = (0.0, 0.2), (0.0, 0.7), (1.0, 0.7), (3.0, 0.7), (10.0, 0.7)
STRONG = 0.65  # beta above which necks are those of S17's fit, 0.7
LOST = ("rolling_friction", "sliding_friction", "stretching", "necks", "drag")
MODES = {name.removeprefix("brokenBy").lower(): name for name in BROKEN_BONDS}


def quantities(table):
    """Quantities of a table of runs (measure.MEASURED)."""
    broken = table[list(BROKEN_BONDS)].sum(axis=1)
    table = table.assign(
        setup=[_setup(row) for row in table.itertuples()],
        broken=broken,
        necks=broken / table.grains,
        over_line=broken / table.grains / papers_necks(table.energy_ratio),
        largest_fraction=table.largest,
        lost=sum(table[f"part_{name}"] for name in LOST),
        left=table.part_kinetic + table.part_elastic,
    )
    # A compacted aggregate grows from the first half of the BCCA aggregate of its seed: one pair.
    runs = Runs(table, "packing_seed", ("planar",))
    sintered = runs.where(lambda t: t.neck > 0)
    yield from outcome_quantities(runs, POINT)
    yield from _sizes(runs)
    yield from _necks(sintered)
    yield from _models(sintered)
    yield from _energies(runs.where(growth_velocity=0.0, velocity=10.0))


def _setup(row):
    """What is not S17's in a run: 'held', 'space', or PLAIN."""
    special = {
        "held": not row.cut,
        "space": not row.planar,
        f"{row.criticalRolling * 1e10:g} Å": not alike(row.criticalRolling, 2e-10),
        f"{row.viscoelasticTime * 1e12:g} ps": row.viscoelasticTime,
        f"k_s {row.sliding_factor / 2:g}": not alike(row.sliding_factor, 2.0),
        f"{row.grains / 2:g} grains": not row.growth_velocity and row.grains != GRAINS,
    }
    return ", ".join(name for name, is_so in special.items() if is_so) or PLAIN


def _sizes(runs):
    """Structure at the start, sizes of the pieces, and the critical velocity for growth."""
    contacts = runs.estimates("contacts", ("setup", "growth_velocity"))
    yield Quantity("contacts", "contacts a grain of the aggregates at the start", contacts)
    width = runs.estimates("initial_radius", ("setup", "growth_velocity"))
    yield Quantity("initial_radius", "gyration radius of the aggregates at the start", width, "r")
    fragments = runs.estimates("fragments", POINT)
    yield Quantity("fragments", "fraction of the mass in pieces of less than a quarter of it", fragments)
    less = runs.beside("growth_velocity", 0.0, "fragments", KIND, differences)
    yield Quantity("fragments_compacted", "the same, less that of BCCA aggregates", less)
    radius = runs.estimates("gyration_radius", POINT)
    yield Quantity("gyration_radius", "gyration radius of the largest piece in grain radii", radius)
    bcca = select(radius, growth_velocity=0.0)
    less = differences(select(bcca, neck=0.7), select(bcca, neck=0.0))
    yield Quantity("gyration_change", "the same, beta = 0.7 less unsintered, BCCA", less)
    largest = runs.estimates("largest", POINT)
    less = runs.beside("setup", PLAIN, "largest", POINT[1:], differences)
    yield Quantity("largest_change", f"fraction of the mass in the largest piece, less that with {PLAIN}", less)
    less = runs.beside("neck", 0.0, "largest", ("setup", "growth_velocity", "velocity"), differences, same_pairs=True)
    yield Quantity(
        "largest_sintered", "fraction of the mass in the largest piece, less that of the same pairs unsintered", less
    )
    bcca = select(largest, growth_velocity=0.0)
    curves = bcca.groupby(level=["setup", "neck"]).filter(lambda curve: len(curve) >= CURVE)
    critical = finite(thresholds(curves - HALF))
    yield Quantity("growth_limit", "velocity at which the mean largest piece of BCCA falls to a half", critical, "m/s")


def _necks(runs):
    """Broken necks: how many, by which mode, beside S17's line and between kinds of aggregates and rules."""
    necks = runs.estimates("necks", POINT)
    yield Quantity("necks", "broken necks over all grains, N_cut/N_t", necks)
    over = runs.estimates("over_line", POINT)
    yield Quantity("necks_over_line", "the same over S17's 0.037 (E_k/E_sint)^0.97", over)
    over = runs.beside("growth_velocity", 0.0, "necks", KIND, ratios)
    yield Quantity("necks_compacted", "N_cut/N_t over that of BCCA aggregates", over)
    over = runs.beside("setup", PLAIN, "necks", POINT[1:], ratios)
    yield Quantity("necks_change", f"N_cut/N_t over that with {PLAIN}", over)
    modes = _modes(runs, ("setup", "growth_velocity", "neck"))
    yield Quantity("modes", "necks broken by each mode, of all that broke at any velocity", modes, "%")
    cut = runs.where(lambda t: t.broken > 0)
    rolling = ratios(cut.estimates("brokenByRolling", POINT), cut.estimates("broken", POINT))
    yield Quantity("rolling_at", "necks broken by rolling, of all that broke at a velocity", rolling, "%")
    five = runs.where(lambda t: [kind in FIVE for kind in zip(t.growth_velocity, t.neck)], setup=PLAIN)
    meaning = "necks broken by each mode, of all in the five kinds of S17's Fig. 15"
    yield Quantity("modes_together", meaning, _modes(five, ("setup",)), "%")


def _modes(runs, by):
    """Necks broken by each mode over all that broke, by some of POINT: each set of the others, where one broke, counts once, however many
    pairs it has."""
    runs = runs.where(lambda t: t.groupby(list(POINT)).broken.transform("any"))
    broken = lambda name: runs.estimates(name, POINT).groupby(level=list(by)).agg(sum)
    return together({mode: ratios(broken(name), broken("broken")) for mode, name in MODES.items()}, "mode")


def _models(runs):
    """S17's two models of sintered aggregates: broken necks against energy, bouncing against force; and loops of grains."""
    law = runs.where(lambda t: t.neck > STRONG).fit(fit_necks, ("amplitude", "exponent"), ("setup",))
    meaning = "N_cut/N_t = amplitude (E_k/E_sint)^exponent of aggregates with beta = 0.7: maximum likelihood of counts"
    yield Quantity("necks_law", meaning, law)
    contacts = runs.table.groupby(list(POINT)).contacts.transform("mean").where(runs.table.growth_velocity > 0)
    ratio = chain_ratio(contacts, runs.table.neck, runs.table.velocity, runs.table.grain_radius)
    of_model, by = runs.of(runs.table.assign(force_ratio=ratio)[ratio > 0]), ("setup", "growth_velocity", "neck")
    line = runs.estimates("over_line", (*by, "energy_ratio"))
    yield Quantity("necks_at_energy", "broken necks over S17's line against E_k/E_sint", line, listed=False)
    undecided = lambda t: t.outcome == UNDECIDED
    bounced = of_model.fractions(lambda t: t.outcome == BOUNCING, (*by, "force_ratio"), undecided)
    meaning = "runs that bounce against F_c/F_max of the chain model (S17 eq 19), which says that they do below 1"
    yield Quantity("bouncing_at_force", meaning, bounced)
    loops = runs.where(growth_velocity=0.0, neck=0.7, velocity=10.0)
    size = loops.estimates(lambda t: t.loop_grains / t.loops.where(t.loops > 0), ("setup",))
    yield Quantity("loop_size", "grains in loops over loops of grains at the end, BCCA, beta = 0.7, 10 m/s", size)
    starts = loops.estimates("loops_at_start", ("setup",))
    yield Quantity("loops_at_start", "loops of grains of the two aggregates at the start", starts)


def _energies(runs):
    """Where the energy goes at 10 m/s, BCCA."""
    by = ("setup", "neck")
    lost = runs.parts({LABELS[n]: lambda t, n=n: t[f"part_{n}"] / t.lost for n in LOST}, by, "way")
    yield Quantity("lost", "lost in each way at 10 m/s, of all that is lost, BCCA", lost, "%")
    necks = lambda t: 2 * t.necks / t.energy_ratio  # K(0) is half an E_k = m V_c^2/4 a grain
    parts = {LABELS[name]: f"part_{name}" for name in LABELS} | {"N_cut E_sint": necks}
    yield Quantity("energy", "energy at the end, or lost until then, of K(0)", runs.parts(parts, by, "part"))
    left = runs.where(neck=0.5).parts({n: f"left_{n}" for n in TIMES}, ("setup",), "periods")
    yield Quantity("left", "kinetic and stored energy after periods of stretching, beta = 0.5, 10 m/s, of K(0)", left)


STUDY = Study(
    title="Sirono & Ueno (2017): collisions of sintered aggregates",
    question="Do sintered icy aggregates grow, bounce or break when they collide, and is it the same in three dimensions?",
    # Head-on collisions of equal aggregates of equal ice grains: BCCA ones, and those that collisions have compacted.
    scene=Scene(
        name="the study of Sirono & Ueno (2017)",
        values={"material": "ice", "impact": 0.0, "sizes": "equal"},
        numbers=("velocity", "neck", "planar", "viscoelasticTime"),
        measured=("criticalRolling", "growth_velocity", "cut", "sliding_factor", "grains", "packing_seed"),
    ),
    measured=MEASURED,
    quantities=quantities,
)
