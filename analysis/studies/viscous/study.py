"""The study of A22's collisions: which quantities the runs tell. A pair of aggregates collides at every offset, velocity and T_vis."""

import numpy as np
import pandas

from ...measures.fragments import cumulative_cross_section, cumulative_grains
from ...runs.collect import Scene
from ..definition import Quantity, Study
from ..estimate import combine, exact
from ..runs import Runs, alike, along, differences, ratios, select, together
from .growth import (
    LARGE_FITTED,
    MERGED,
    SMALL,
    SMALL_FITTED,
    SQUARES,
    fragment_exponent,
    offset_weights,
    threshold_velocity,
)
from .measure import COLUMNS, DISSIPATION, FAST, measure, sizes_from_text

NO_DRAG, MOST_DRAG = 0.0, 6e-12  # T_vis [s]
REFERENCE = {"velocity": 10**1.7, "square": 3 / 12}  # the collision that A22 shows most
CURVE = ("grains", "viscoelasticTime", "velocity")
POINT = ("grains", "viscoelasticTime")
FRAGMENTS_AT = (10**1.7, 100.0)  # m/s: A22 Figs 6 to 8
SHARE = {"rolling": ("rollingDissipation",), "sliding": ("slidingDissipation",), "twisting": ("twistingDissipation",)}
WAYS = {**SHARE, "connection and disconnection": ("connection", "disconnection"), "drag": ("drag",)}


def quantities(table):
    """Quantities of a table of runs (measure.COLUMNS)."""
    table = table.assign(
        square=(table.impact**2).round(9), lost=table[list(DISSIPATION)].sum(axis=1), total=2 * table.grains
    )
    runs = Runs(table, "seed", ("grains",))
    yield from _growth(runs.over("square", SQUARES, offset_weights), "", "13 offsets, A22 eq 29")
    yield from _growth(runs.over("square", SQUARES[::2], offset_weights), "_7", "every second offset")
    yield from _offsets(runs)
    yield from _energies(runs)
    yield from _fragments(runs.over("square", SQUARES, offset_weights))
    yield from _grains(table)


def _growth(runs, suffix, over):
    """Growth efficiency and what follows, from means over offsets."""
    growth = runs.estimates("growth", CURVE)
    yield Quantity(f"growth{suffix}", f"growth efficiency f_gro, mean over {over}", growth)
    v_fra = along(growth, "velocity", threshold_velocity) if len(growth) else growth
    yield Quantity(f"v_fra{suffix}", f"velocity at which that mean falls through 0 ({over})", v_fra, "m/s")
    if not len(growth):
        return
    half = runs.estimates(lambda t: [0.5 * _small(sizes) for sizes in t.fragments] / t.grains, CURVE)
    merging = runs.estimates(lambda t: t.growth > MERGED, CURVE)
    with_drag = {
        "f_gro": _drag(growth),
        f"half the mass in fragments of {SMALL} grains or fewer": _drag(half) * -1.0,
        "the rest": _drag(growth) + _drag(half),
        "cross-section of merging": _drag(merging),
    }
    yield Quantity(
        f"drag{suffix}", f"what drag changes: 6 ps less without, mean over {over}", together(with_drag, "of what")
    )


def _offsets(runs):
    """Collisions at single offsets."""
    growth = runs.estimates("growth", (*CURVE, "square"))
    head_on = select(growth, square=0.0)
    yield Quantity("head_on", "f_gro of head-on collisions", head_on)
    at_offset = select(growth, velocity=REFERENCE["velocity"])
    yield Quantity("at_offset", "f_gro at 50.1 m/s", at_offset)
    yield Quantity("drag_at_offset", "f_gro at 50.1 m/s, 6 ps less without drag", _drag(at_offset))
    largest = runs.where(**REFERENCE).estimates("largest", POINT)
    yield Quantity("largest", "grains of the largest fragment, 50.1 m/s, B_off^2 = 3/12", largest)
    yield Quantity("drag_largest", "the same, 6 ps less without drag", _drag(largest))
    loss = together(
        {
            name: runs.estimates(lambda t, c=c: t[list(c)].sum(axis=1) / t.kinetic_at_start, (*CURVE, "square"))
            for name, c in WAYS.items()
        },
        "channel",
    )
    yield Quantity(
        "loss_at_offset",
        "lost in each way at 50.1 m/s, of K(0)",
        select(loss, velocity=REFERENCE["velocity"]),
        "%",
        0.01,
    )


def _energies(runs):
    """Where the energy goes at A22's reference collision, and against velocity at its offset."""
    own, at_square = runs.where(**REFERENCE), runs.where(square=REFERENCE["square"])
    lost = {name: own.estimates(lambda t, c=c: t[list(c)].sum(axis=1) / t.lost, POINT) for name, c in WAYS.items()}
    yield Quantity(
        "loss", "lost in each way, of all that is lost, 50.1 m/s, B_off^2 = 3/12", together(lost, "channel"), "%", 0.01
    )
    others = [lost[name] for name in WAYS if name != "rolling"]
    lead = differences(lost["rolling"], _largest(others))
    yield Quantity("rolling_lead", "rolling less the largest of the other ways, there", lead, "%", 0.01)
    total = {name: own.estimates(lambda t, c=c: t[list(c)].sum(axis=1), POINT) for name, c in WAYS.items()}
    by_drag = {
        name: ratios(select(total[name], viscoelasticTime=MOST_DRAG), select(total[name], viscoelasticTime=NO_DRAG))
        for name in SHARE
    }
    yield Quantity("drag_ratio", "lost with 6 ps over without drag, there", together(by_drag, "channel"))
    unit = lambda t: t.total * t.energy_unit
    at_end = {
        name: at_square.estimates(lambda t, c=c: t[list(c)].sum(axis=1) / unit(t), CURVE) for name, c in WAYS.items()
    }
    yield Quantity(
        "loss_per_grain", "lost in each way over N_tot F_c delta_c, B_off^2 = 3/12", together(at_end, "channel")
    )
    events = {
        name: at_square.estimates(lambda t, c=c: t[list(c)].sum(axis=1, min_count=len(c)) / t.total, CURVE)
        for name, c in {"N_con": ("formed",), "N_cut": ("broken",), "both": ("formed", "broken")}.items()
    }
    yield Quantity("events", "contacts formed and broken over N_tot, B_off^2 = 3/12", together(events, "event"))
    yield Quantity(
        "pair_speed",
        "largest rms of v_rel of neighbours over the states, 50.1 m/s, B_off^2 = 3/12",
        own.estimates("pair_speed", POINT),
        "m/s",
    )
    yield Quantity(
        "fast_pairs",
        f"neighbours that approach or part faster than {FAST:g} m/s, over N_tot, there",
        own.estimates("fast_pairs", POINT),
    )


def _fragments(runs):
    """Sizes of fragments at FRAGMENTS_AT: cumulative means, and fits to them."""
    table = runs.table[np.logical_or.reduce([alike(runs.table.velocity, v) for v in FRAGMENTS_AT])]
    found = {"grains_in_fragments": cumulative_grains, "cross_section": cumulative_cross_section}
    means = {name: runs.of(_by_size(table, f)).estimates("value", (*CURVE, "fragment")) for name, f in found.items()}
    yield Quantity(
        "grains_in_fragments", "<N_cum(<= N)>: grains in fragments of at most N grains", means["grains_in_fragments"]
    )
    fits = {
        "small": lambda grains, n: n <= SMALL_FITTED * 2 * grains,
        "large": lambda grains, n: (n >= LARGE_FITTED) & (n <= grains),
    }
    alphas = {name: _fitted(means["grains_in_fragments"], inside) for name, inside in fits.items()}
    meaning = f"alpha of f(N) = c N^-alpha: small: N to {SMALL_FITTED:.0%} of all grains, large: N from {LARGE_FITTED} to an aggregate's"
    yield Quantity("alpha", meaning, together(alphas, "fragments"))
    section = means["cross_section"]
    sizes = section.index.get_level_values("grains")
    n = section.index.get_level_values("fragment")
    small, every = (
        section[keep].groupby(level=list(CURVE)).last() for keep in (n <= SMALL_FITTED * 2 * sizes, n == 2 * sizes)
    )
    share = 1.0 - ratios(small, every)
    yield Quantity(
        "large_share", f"part of the cross-section in fragments beyond {SMALL_FITTED:.0%} of all grains", share
    )


def _grains(table):
    """What follows from the grains alone, and the aggregates."""
    known = table.drop_duplicates("viscoelasticTime")
    runs = Runs(known, "viscoelasticTime")
    stick = runs.estimates("sticking_velocity", ("viscoelasticTime",)).map(lambda estimate: exact(estimate.value))
    yield Quantity("v_stick", "sticking velocity of two grains head-on (A22 eq 30)", stick, "m/s")
    without = [e for t, e in stick.items() if t[0] == NO_DRAG]
    yield Quantity("v_stick_ratio", "over that without drag", stick / without[0] if without else stick[:0])
    pairs = Runs(table, "seed", ("grains",))
    yield Quantity(
        "radius",
        "characteristic radius of the aggregates",
        pairs.estimates(lambda t: t.characteristic_radius / t.grain_radius, ("grains",)),
        "r",
    )


def _largest(of):
    """Series of the largest of several, draw by draw."""
    largest = of[0]
    for other in of[1:]:
        first, second = largest.align(other, join="inner")
        largest = first.combine(second, lambda a, b: combine(np.maximum, a, b))
    return largest


def _by_size(table, cumulative):
    """The table with a row for each number of grains `fragment`, and the cumulative(sizes, numbers) of each run there as value."""
    parts = []
    for grains, runs in table.groupby("grains"):
        numbers = np.unique(np.geomspace(1, 2 * grains, 40).round().astype(int))
        values = [cumulative(sizes_from_text(text), numbers) for text in runs.fragments]
        place = np.repeat(np.arange(len(runs)), len(numbers))
        parts.append(runs.iloc[place].assign(fragment=np.tile(numbers, len(runs)), value=np.concatenate(values)))
    return pandas.concat(parts, ignore_index=True) if parts else table.assign(fragment=0, value=0.0)


def _fitted(means, inside):
    """Series of fragment_exponent of <N_cum> at numbers inside(grains, numbers)."""
    grains, numbers = (means.index.get_level_values(name) for name in ("grains", "fragment"))
    own = means[inside(grains, numbers)]
    return along(own, "fragment", fragment_exponent) if len(own) else own


def _drag(series):
    """With the most drag less without, of the same pairs."""
    return differences(select(series, viscoelasticTime=MOST_DRAG), select(series, viscoelasticTime=NO_DRAG))


def _small(text):
    sizes = sizes_from_text(text)
    return sizes[sizes <= SMALL].sum()


STUDY = Study(
    title="Arakawa et al. (2022): viscous drag, growth and fragmentation",
    question="How much does viscous drag between grains help colliding aggregates to grow, at which velocity do they fragment, and how are the "
    "fragments distributed?",
    # Collisions of equal BPCA aggregates of equal ice grains, without bonds, springs held at their limits.
    scene=Scene(
        name="A22's scene",
        values={"packing": "bpca", "neck": 0.0, "planar": 0, "material": "ice", "sizes": "equal", "limit": "held"},
        numbers=("grains", "impact", "velocity", "viscoelasticTime", "seed"),
    ),
    columns=COLUMNS,
    measure=measure,
    quantities=quantities,
)
