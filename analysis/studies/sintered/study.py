"""The study of S17's collisions: which quantities the runs tell. A pair of aggregates collides at every velocity, beta and rule."""

import numpy as np

from ...measures.outcome import STICKING, UNDECIDED
from ...runs.collect import Scene
from ...runs.format import BROKEN_BONDS
from ...theory import ICE, interaction_energies, pair_constants
from ..collisions import outcome_quantities
from ..definition import Quantity, Study
from ..estimate import combine, exact
from ..runs import Runs, alike, along, differences, ratios, select, together
from ..threshold import threshold_velocity
from .measure import COLUMNS, LABELS, TIMES, measure
from .models import chain_ratio, fit_necks, papers_necks

POINT = ("setup", "growth_velocity", "neck", "velocity")
PLAIN = "cut"  # S17's: springs of ordinary contacts are cut at their limits, in the plane, xi_crit = 2 Angstrom, no drag
GRAINS = 2048  # of both BCCA aggregates (section 4)
HALF = 0.5  # of the total mass: what the largest piece must keep for growth (section 5.1)
CURVE = 4  # velocities or more: with fewer, where it falls to a half lies anywhere between two of them
STRONG = 0.65  # beta above which necks are those of S17's fit, 0.7
LOST = ("rolling_friction", "sliding_friction", "stretching", "necks", "drag")
MODES = {name: name.removeprefix("brokenBy").lower() for name in BROKEN_BONDS}


def quantities(table):
    """Quantities of a table of runs (measure.COLUMNS)."""
    broken, new_loops = table[list(BROKEN_BONDS)].sum(axis=1), table.loops - table.loops_at_start
    table = table.assign(
        setup=[_setup(row) for row in table.itertuples()],
        broken=broken,
        necks=broken / table.grains,
        necks_per_touching=broken / table.touching.where(table.touching > 0),
        outcome=table.outcome.mask(_may_part(table), UNDECIDED),
        largest_fraction=table.largest,
        lost=sum(table[f"part_{name}"] for name in LOST),
        left=table.part_kinetic + table.part_elastic,
        loop_size=table.loop_grains / table.loops.where(table.loops > 0),
        new_loop_size=(table.loop_grains - table.loop_grains_at_start) / new_loops.where(new_loops > 0),
    )
    # A compacted aggregate grows from the first half of the BCCA aggregate of its seed: one pair.
    runs = Runs(table, "packing_seed", ("planar",))
    yield from outcome_quantities(runs, POINT)
    yield from _sizes(runs)
    yield from _necks(runs.of(table[table.neck > 0]))
    yield from _bouncing(runs)
    yield from _energies(runs.where(growth_velocity=0.0, velocity=10.0))


def _setup(row):
    """What is not S17's in a run: 'held', 'space', or PLAIN."""
    special = {
        "held": not row.cut,
        "space": not row.planar,
        f"{row.criticalRolling * 1e10:g} Å": not alike([row.criticalRolling], 2e-10)[0],
        f"{row.viscoelasticTime * 1e12:g} ps": row.viscoelasticTime,
        f"k_s {row.sliding_factor / 2:g}": not alike([row.sliding_factor], 2.0)[0],
        f"{row.grains / 2:g} grains": not row.growth_velocity and row.grains != GRAINS,
    }
    return ", ".join(name for name, is_so in special.items() if is_so) or PLAIN


def _may_part(table):
    """Runs that were ended early in one piece, while their halves moved against each other with more energy than their contacts can hold."""
    hold = [interaction_energies(pair_constants(ICE, radius))["break"] for radius in table.grain_radius]
    mass = 4 / 3 * np.pi * ICE.density * table.grain_radius**3
    halves = table.bulk * table.grains * mass * table.velocity**2 / 8
    return (table.outcome == STICKING) & table.ended_by & (halves > table.touching * hold)


def _sizes(runs):
    """Structure at the start, sizes of the pieces, and the critical velocity for growth."""
    contacts = runs.estimates("contacts", ("setup", "growth_velocity"))
    yield Quantity("contacts", "contacts a grain of the aggregates at the start", contacts)
    fragments = runs.estimates("fragments", POINT)
    yield Quantity("fragments", "fraction of the mass in pieces of less than a quarter of it", fragments)
    yield Quantity("fragments_compacted", "the same, less that of BCCA aggregates", _over_bcca(fragments, differences))
    radius = runs.estimates("gyration_radius", POINT)
    yield Quantity("gyration_radius", "gyration radius of the largest piece in grain radii", radius)
    bcca = select(radius, growth_velocity=0.0)
    less = differences(select(bcca, neck=0.7), select(bcca, neck=0.0))
    yield Quantity("gyration_change", "the same, beta = 0.7 less unsintered, BCCA", less)
    largest = runs.estimates("largest", POINT)
    at_own = largest[alike(*(largest.index.get_level_values(name) for name in ("velocity", "growth_velocity")))]
    meaning = "fraction of the mass in the largest piece, collided at the velocity that compacted the aggregates"
    yield Quantity("largest_own", meaning, at_own.droplevel("velocity"))
    beside = _beside_plain(largest, differences)
    yield Quantity("largest_change", f"fraction of the mass in the largest piece, less that with {PLAIN}", beside)
    bcca = select(largest, growth_velocity=0.0)
    fall = differences(select(bcca, neck=0.4), select(bcca, neck=0.5))
    yield Quantity("largest_fall", "the same, beta = 0.4 less 0.5, BCCA", fall)
    curves = bcca.groupby(level=["setup", "neck"]).filter(lambda curve: len(curve) >= CURVE)
    critical = along(curves - HALF, "velocity", threshold_velocity)
    critical = critical[[np.isfinite(estimate.value) for estimate in critical]]
    yield Quantity("growth_limit", "velocity at which the mean largest piece of BCCA falls below a half", critical, "m/s")


def _necks(runs):
    """Broken necks: how many, by which mode, beside S17's line and between kinds of aggregates and rules."""
    necks = runs.estimates("necks", POINT)
    yield Quantity("necks", "broken necks over all grains, N_cut/N_t", necks)
    line = runs.estimates(lambda t: t.necks / papers_necks(t.energy_ratio), POINT)
    yield Quantity("necks_over_line", "the same over S17's 0.037 (E_k/E_sint)^0.97", line)
    yield Quantity("necks_compacted", "N_cut/N_t over that of BCCA aggregates", _over_bcca(necks, ratios))
    yield Quantity("necks_change", f"N_cut/N_t over that with {PLAIN}", _beside_plain(necks, ratios))
    touching = _beside_plain(runs.estimates("necks_per_touching", POINT), ratios)
    yield Quantity("touching_change", "N_cut over the largest number of contacts between the two, the same way", touching)
    cut = runs.of(runs.table[runs.table.broken > 0])
    by = ("setup", "growth_velocity", "neck")
    total = cut.estimates("broken", by)
    modes = together({mode: ratios(cut.estimates(name, by), total) for name, mode in MODES.items()}, "mode")
    yield Quantity("modes", "necks broken by each mode, of all that broke at any velocity", modes, "%", 0.01)
    selections = {"β = 0.7": runs.table.neck > STRONG, "β ≥ 0.3": runs.table.neck > 0.25}
    fits = {
        name: runs.of(runs.table[own]).fit(fit_necks, ("amplitude", "exponent"), ("setup",))
        for name, own in selections.items()
    }
    meaning = "N_cut/N_t = amplitude (E_k/E_sint)^exponent, all aggregates of these beta: maximum likelihood of counts"
    yield Quantity("necks_law", meaning, together(fits, "necks"))


def _bouncing(runs):
    """S17's chain model, and loops of grains."""
    sintered = runs.of(runs.table[runs.table.neck > 0])
    contacts = sintered.estimates("contacts", POINT)
    radius = runs.table.grain_radius.iloc[0]
    for (setup, growth, neck, velocity), own in contacts.items():
        model = lambda n, neck=neck, velocity=velocity: chain_ratio(n, neck, velocity, radius)
        contacts[setup, growth, neck, velocity] = combine(model, own) if growth else exact(model(None))
    meaning = "F_c/F_max of the chain model (S17 eq 19), below 1 for bouncing; BCCA: chains of 22 grains"
    yield Quantity("chain_ratio", meaning, contacts)
    of = {"at the start": "loops_at_start", "grains in one": "loop_size", "in a new one": "new_loop_size"}
    loops = runs.where(growth_velocity=0.0, neck=0.7, velocity=10.0).parts(of, ("setup",), "loops")
    yield Quantity("loops", "loops of grains, beta = 0.7, 10 m/s: how many at the start; grains in loops over loops at the end", loops)


def _energies(runs):
    """Where the energy goes at 10 m/s, BCCA."""
    by = ("setup", "neck")
    lost = runs.parts({LABELS[n]: lambda t, n=n: t[f"part_{n}"] / t.lost for n in LOST}, by, "part")
    yield Quantity("lost", "lost in each way at 10 m/s, of all that is lost, BCCA", lost, "%", 0.01)
    necks = lambda t: 2 * t.necks / t.energy_ratio  # K(0) is half an E_k = m V_c^2/4 a grain
    parts = {LABELS[name]: f"part_{name}" for name in LABELS} | {"N_cut E_sint": necks}
    yield Quantity("energy", "energy at the end, or lost until then, of K(0)", runs.parts(parts, by, "part"))
    left = runs.where(neck=0.5).parts({n: f"left_{n}" for n in TIMES}, ("setup",), "periods")
    yield Quantity("left", "kinetic and stored energy after periods of stretching, beta = 0.5, 10 m/s, of K(0)", left)


def _beside_plain(series, of):
    """Series of `of` (differences, ratios) each other setup and PLAIN."""
    return _beside(series, "setup", PLAIN, of)


def _over_bcca(series, of):
    """The same of compacted aggregates and BCCA ones."""
    return _beside(series, "growth_velocity", 0.0, of)


def _beside(series, level, reference, of):
    values = [value for value in series.index.unique(level) if value != reference]
    plain = select(series, **{level: reference})
    return together({v: of(select(series, **{level: v}), plain) for v in values} or {reference: plain[:0]}, level)


STUDY = Study(
    title="Sirono & Ueno (2017): collisions of sintered aggregates",
    question="Do sintered icy aggregates still grow when they collide, when do they bounce or break, and how do their necks break? And does it "
    "hold in three dimensions?",
    # Head-on collisions of equal aggregates of equal ice grains: BCCA ones, and those that collisions have compacted.
    scene=Scene(
        name="S17's scene",
        values={"material": "ice", "impact": 0.0, "sizes": "equal"},
        numbers=("velocity", "neck", "planar", "viscoelasticTime"),
        measured=("criticalRolling", "growth_velocity", "cut", "sliding_factor", "grains", "packing_seed"),
    ),
    columns=COLUMNS,
    measure=measure,
    quantities=quantities,
)
