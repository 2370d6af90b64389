"""The study of A22's collisions: which quantities the runs tell. A pair of aggregates collides at every offset, velocity and T_vis."""

from functools import reduce

import numpy as np

from ...measures.fragments import cumulative_cross_section, cumulative_grains
from ...runs.collect import Scene
from ..definition import Quantity, Study
from ..estimate import combine, exact
from ..runs import Runs, along, differences, ratios, select, together
from ..threshold import thresholds
from .growth import FEW, LARGE_FITTED, MERGED, SMALL, SMALL_FITTED, SQUARES, fragment_exponent, offset_weights
from .measure import DISSIPATION, EVENTS, FAST, MEASURED, REFERENCE, sizes_from_text

NO_DRAG, MOST_DRAG = 0.0, 6e-12  # T_vis [s]
# Twelfths of B_off^2 over which a mean is taken: chosen when of 50,000 grains 3/12 was known, and after their first pair.
SQUARES_OF = {"drag_edge": (2, 3, 4, 5), "drag_beyond": (6, 7, 8, 9)}
CURVE = ("grains", "viscoelasticTime", "velocity")
POINT = ("grains", "viscoelasticTime")
FRAGMENTS_AT = (10**1.7, 100.0)  # m/s: A22 Figs 6 to 8
WAYS = {
    "rolling": ("rollingDissipation",),
    "sliding": ("slidingDissipation",),
    "twisting": ("twistingDissipation",),
    "connection and disconnection": ("connection", "disconnection"),
    "drag": ("drag",),
}


def quantities(table):
    """Quantities of a table of runs (measure.MEASURED)."""
    ways = {name: table[list(channels)].sum(axis=1) for name, channels in WAYS.items()}
    lost, unit = table[list(DISSIPATION)].sum(axis=1), 2 * table.grains * table.energy_unit
    table = table.assign(square=(table.impact**2).round(9), lost=lost, unit=unit, **ways)
    runs = Runs(table, "seed", ("grains",))
    yield from _growth(runs.over("square", SQUARES, offset_weights), "", "13 offsets, A22 eq 29")
    yield from _growth(runs.over("square", SQUARES[::2], offset_weights), "_7", "every second offset")
    yield from _offsets(runs)
    yield from _energies(runs)
    yield from _fragments(runs)
    yield from _grains(runs)


def _growth(runs, suffix, over):
    """Growth efficiency and what follows, from means over offsets."""
    growth = runs.estimates("growth", CURVE)
    yield Quantity(f"growth{suffix}", f"growth efficiency f_gro, mean over {over}", growth)
    several = growth[growth.index.droplevel("velocity").duplicated(keep=False)]
    v_fra = thresholds(several) if len(several) else several
    yield Quantity(f"v_fra{suffix}", f"velocity at which that mean falls through 0 ({over})", v_fra, "m/s")
    of_velocity = ("grains", "velocity")
    more = _with_drag(runs, "growth", of_velocity)
    small = lambda t: [cumulative_grains(sizes_from_text(sizes), [SMALL])[0] for sizes in t.fragments]
    half = _with_drag(runs, lambda t: 0.5 * np.array(small(t)) / t.grains, of_velocity)
    with_drag = {
        "growth efficiency": more,
        "of it half the small fragments": -half,
        "the rest": more + half,
        "cross-section of merging": _with_drag(runs, lambda t: t.growth > MERGED, of_velocity),
    }
    parts = f"small fragments: of {SMALL} grains or fewer; merging: growth efficiency above {MERGED:g}"
    meaning = f"what drag changes: 6 ps less without, mean over {over}; {parts}"
    yield Quantity(f"drag{suffix}", meaning, together(with_drag, "part"))


def _offsets(runs):
    """Collisions at single offsets."""
    head_on = runs.where(square=0.0).estimates("growth", CURVE)
    yield Quantity("head_on", "f_gro of head-on collisions", head_on)
    runs = runs.where(velocity=REFERENCE["velocity"])
    at_offset = runs.estimates("growth", (*POINT, "square"))
    yield Quantity("at_offset", "f_gro at 50.1 m/s", at_offset)
    drag_at_offset = _with_drag(runs, "growth", ("grains", "square"))
    yield Quantity("drag_at_offset", "f_gro at 50.1 m/s, 6 ps less without drag", drag_at_offset)
    for name, of in SQUARES_OF.items():
        change = _with_drag(runs.over("square", [k / 12 for k in of]), "growth", ("grains",))
        yield Quantity(name, f"the same, mean over B_off^2 = {of[0]}/12 to {of[-1]}/12", change)
    loss = runs.parts(_over("kinetic_at_start"), (*POINT, "square"), "channel")
    yield Quantity("loss_at_offset", "lost in each way at 50.1 m/s, of K(0)", loss, "%")


def _energies(runs):
    """A22's reference collision: the largest fragment, where the energy goes, and the latter against velocity at its offset."""
    own, at_square = runs.where(**REFERENCE), runs.where(square=REFERENCE["square"])
    largest = own.estimates("largest", POINT)
    yield Quantity("largest", "grains of the largest fragment, 50.1 m/s, B_off^2 = 3/12", largest)
    drag_largest = _with_drag(own, "largest", ("grains",))
    yield Quantity("drag_largest", "the same, 6 ps less without drag", drag_largest)
    loss = own.parts(_over("lost"), POINT, "channel")
    yield Quantity("loss", "lost in each way there, of all that is lost", loss, "%")
    lead = _beyond(loss, "rolling", np.maximum)
    yield Quantity("rolling_lead", "rolling less the largest of the other ways", lead, "%")
    lead = _beyond(loss, "connection and disconnection", np.minimum)
    yield Quantity("connection_lead", "making and breaking contacts less the smallest of the other ways", lead, "%")
    by_drag = {name: _with_drag(own, name, ("grains",), ratios) for name in WAYS if name != "drag"}
    yield Quantity("drag_ratio", "lost there with 6 ps over without drag", together(by_drag, "channel"))
    at_end = at_square.parts(_over("unit"), CURVE, "channel")
    yield Quantity("loss_per_grain", "lost in each way over N_tot F_c delta_c, B_off^2 = 3/12", at_end)
    per_grain = {symbol: lambda t, name=name: t[name] / (2 * t.grains) for name, symbol in EVENTS.items()}
    per_grain["both"] = lambda t: sum(t[name] for name in EVENTS) / (2 * t.grains)
    of_events = at_square.parts(per_grain, CURVE, "event")
    yield Quantity("events", "contacts formed and broken over N_tot, B_off^2 = 3/12", of_events)
    meaning = "largest rms of v_rel of neighbours over the states, 50.1 m/s, B_off^2 = 3/12"
    yield Quantity("pair_speed", meaning, own.estimates("pair_speed", POINT), "m/s")
    fast = own.estimates("fast_pairs", POINT)
    yield Quantity("fast_pairs", f"neighbours there that approach or part faster than {FAST:g} m/s, over N_tot", fast)


def _fragments(runs):
    """Sizes of fragments: of the reference collision, cumulative means over offsets at FRAGMENTS_AT, and fits to these."""
    own = runs.where(**REFERENCE)
    few = lambda t: [np.count_nonzero(sizes_from_text(sizes) <= FEW) for sizes in t.fragments]
    number = own.estimates(few, POINT)
    yield Quantity("small_fragments", f"fragments of {FEW} grains or fewer, 50.1 m/s, B_off^2 = 3/12", number)
    fewer = _with_drag(own, few, ("grains",), ratios)
    yield Quantity("small_fragments_ratio", "the same, 6 ps over without drag", fewer)
    own = own.where(grains=50_000)
    single = own.of(_by_size(own.table, cumulative_grains)).estimates("value", (*POINT, "fragment"))
    yield Quantity("grains_in_fragments_full", "N_cum(<= N) of 50,000 grains each, 50.1 m/s, B_off^2 = 3/12", single)
    table = runs.where(velocity=FRAGMENTS_AT).table
    runs = runs.over("square", SQUARES, offset_weights)
    found = {"grains_in_fragments": cumulative_grains, "cross_section": cumulative_cross_section}
    grains, section = (runs.of(_by_size(table, f)).estimates("value", (*CURVE, "fragment")) for f in found.values())
    meaning = "<N_cum(<= N)>: grains in fragments of at most N grains, mean over 13 offsets"
    yield Quantity("grains_in_fragments", meaning, grains, listed=False)
    alphas = {
        "small": _fitted(grains, lambda each, n: n <= SMALL_FITTED * 2 * each),
        "all": _fitted(grains, lambda each, n: n <= each),
        "large": _fitted(grains, lambda each, n: (n >= LARGE_FITTED) & (n <= each) & (each >= 10 * LARGE_FITTED)),
    }
    meaning = f"alpha of f(N) = c N^-alpha: small: N to {SMALL_FITTED:.0%} of all grains, all: to an aggregate's, large: from {LARGE_FITTED} to an aggregate's"
    yield Quantity("alpha", meaning, together(alphas, "fragments"))
    each, n = (section.index.get_level_values(name) for name in ("grains", "fragment"))
    ends = [section[kept].groupby(level=list(CURVE)).last() for kept in (n <= SMALL_FITTED * 2 * each, n == 2 * each)]
    meaning = f"part of the cross-section in fragments beyond {SMALL_FITTED:.0%} of all grains"
    yield Quantity("large_share", meaning, 1.0 - ratios(*ends))


def _grains(runs):
    """What follows from the grains alone, and the aggregates."""
    stick = runs.table.groupby("viscoelasticTime").sticking_velocity.first().map(exact)
    yield Quantity("v_stick", "sticking velocity of two grains head-on (A22 eq 30)", stick, "m/s")
    yield Quantity("v_stick_ratio", "over that without drag", stick / stick.get(NO_DRAG, np.nan))
    radius = runs.estimates(lambda t: t.characteristic_radius / t.grain_radius, ("grains",))
    yield Quantity("radius", "characteristic radius of the aggregates", radius, "r")


def _over(column):
    """{way: function table -> what is lost so, over a column}."""
    return {name: lambda t, name=name: t[name] / t[column] for name in WAYS}


def _beyond(loss, way, extreme):
    """What a way takes less the extreme (np.maximum, np.minimum) of the others, draw by draw."""
    of_two = lambda first, second: first.combine(second, lambda a, b: combine(extreme, a, b))
    others = (select(loss, channel=name) for name in WAYS if name != way)
    return differences(select(loss, channel=way), reduce(of_two, others))


def _by_size(table, cumulative):
    """The table with a row for each number of grains `fragment`, and the cumulative(sizes, numbers) of each run there as value."""
    numbers = [np.unique(np.geomspace(1, 2 * grains, 60).round().astype(int)) for grains in table.grains]
    values = [cumulative(sizes_from_text(text), own) for text, own in zip(table.fragments, numbers)]
    rows = table.assign(fragment=numbers, value=values).explode(["fragment", "value"], ignore_index=True)
    return rows.astype({"fragment": int, "value": float})


def _fitted(means, inside):
    """Series of fragment_exponent of <N_cum> at numbers inside(grains, numbers)."""
    grains, numbers = (means.index.get_level_values(name) for name in ("grains", "fragment"))
    own = means[inside(grains, numbers)]
    return along(own, "fragment", fragment_exponent) if len(own) else own


def _with_drag(runs, values, by, of=differences):
    """Values with the most drag less those without (or over them), of the same pairs."""
    found = runs.beside("viscoelasticTime", NO_DRAG, values, by, of, same_pairs=True)
    return select(found, viscoelasticTime=MOST_DRAG)


STUDY = Study(
    title="Arakawa et al. (2022): viscous drag, growth and fragmentation",
    question="How much does viscous drag between grains help colliding aggregates to grow, at which velocity do they fragment, and how are the "
    "fragments distributed?",
    # Collisions of equal BPCA aggregates of equal ice grains, without bonds, springs held at their limits.
    scene=Scene(
        name="the study of Arakawa et al. (2022)",
        values={"packing": "bpca", "neck": 0.0, "planar": 0, "material": "ice", "sizes": "equal", "limit": "held"},
        numbers=("grains", "impact", "velocity", "viscoelasticTime", "seed"),
    ),
    measured=MEASURED,
    quantities=quantities,
)
