"""One row of numbers for each collision."""

from math import nan, pi

import numpy as np

from ...measures.fragments import fragment_labels, fragment_sizes
from ...measures.ledger import closure, initial_kinetic_energy
from ...measures.loops import loops
from ...measures.of_run import derived_constants, met
from ...measures.structure import gyration_radius
from ...runs.format import BROKEN_BONDS
from ...runs.table import Column
from ...theory.chains import breaking_energy, stretching_period
from ...theory.pair_constants import ICE, pair_constants
from ..collisions import OUTCOME_COLUMNS, outcome_values
from ..definition import NotMeasured
from ..grains import require_papers_grains

# The parts of Fig. 14: {column: (what it is, channels)}.
PARTS = {
    "kinetic": ("kinetic", ("kinetic",)),
    "elastic": ("stored in contacts and necks", ("normal", "sliding", "rolling", "twisting")),
    "rolling_friction": ("rolling friction", ("rollingDissipation",)),
    "sliding_friction": ("sliding friction", ("slidingDissipation", "twistingDissipation")),
    "stretching": ("contacts formed and broken", ("connection", "disconnection")),
    "necks": ("necks broken", ("bondBreaking",)),
    "drag": ("drag", ("drag",)),
}
LABELS = {name: label for name, (label, _) in PARTS.items()}
# Times at which energies are measured beside the end, in periods of the stretching vibration: the paper doesn't print that of Fig. 14.
TIMES = (1250, 2500, 5000, 10_000, 20_000)
REACHED = 0.99  # a run has got to a time if it has this part of it
EARLY = 5000  # the one at which every part is measured
FRAGMENT = 0.25  # of the total mass: lighter pieces are fragments (section 5.3)
PACKINGS = ("bcca", "file")
LATER = {"gaps": True, "absent": nan}  # of columns that the first runs don't have

COLUMNS = (
    Column("planar", "", "1: grains in a plane", kind="i"),
    Column("neck", "", "beta; 0: unsintered"),
    Column("velocity", "m/s", "collision velocity V_c"),
    Column("growth_velocity", "m/s", "V_g of the compacted aggregates; 0: BCCA"),
    Column("criticalRolling", "m", "xi_crit"),
    Column("viscoelasticTime", "s", "T_vis"),
    Column("cut", "", "1: springs are cut at the limits, 0: held there", kind="i"),
    Column("sliding_factor", "", "k_s over W07's 8 a0 G*; 2: S17 eqs 11 and 12"),
    Column("packing_seed", "", "random seed of the aggregates", kind="i"),
    Column("grains", "", "grains of both aggregates", kind="i"),
    Column("grain_radius", "m", "R, before sintering"),
    Column("contacts", "", "contacts a grain at the start"),
    Column("initial_radius", "", "gyration radius of an aggregate at the start, mean of both, in R"),
    Column("met", "", "whether the aggregates touched", kind="b"),
    Column("touching", "", "largest number of contacts between the aggregates", **LATER),
    *OUTCOME_COLUMNS,
    Column("largest", "", "sticking efficiency: fraction of the mass in the largest piece"),
    Column("second", "", "fraction of the mass in the second one"),
    Column("fragments", "", f"fraction of the mass in pieces of less than {FRAGMENT:g} of it"),
    Column("gyration_radius", "", "gyration radius of the largest piece, in R (S17 eq 13)"),
    Column("energy_ratio", "", "E_k/E_sint, E_k = m V_c^2/4 (S17 section 5.3)", gaps=True),
    Column("necks_at_start", "", "sintered bonds at the start", kind="i"),
    *(Column(name, "", "necks broken so", kind="i") for name in BROKEN_BONDS),
    *(Column(f"part_{n}", "K(0)", f"{LABELS[n]}: at the end, or until then") for n in PARTS),
    *(Column(f"left_{n}", "K(0)", f"kinetic and stored energy after {n} periods", **LATER) for n in TIMES),
    *(Column(f"part_{n}_{EARLY}", "K(0)", f"{LABELS[n]} after {EARLY} periods", **LATER) for n in PARTS),
    Column("loops_at_start", "", "independent loops of contacts in both aggregates at the start", **LATER),
    Column("loops", "", "the same at the end", **LATER),
    Column("loop_grains_at_start", "", "grains in loops at the start", **LATER),
    Column("loop_grains", "", "the same at the end", **LATER),
    Column("ended_by", "", "whether the run ended before its duration, because nothing could meet or break", kind="b"),
    Column("closure", "", "largest error of the energy ledger over K(0)"),
    Column("time", "s", "time at the end"),
)


def measure(run):
    """{column: value} of a RunFolder of S17's scene that has ended. NotMeasured where the aggregates are of
    another kind, of unlike grains or of other grains than S17's (but for xi_crit and the sliding spring), RunFolderError
    where something is missing."""
    require_papers_grains(run, but=("criticalRolling", "slidingStiffnessFactor"))
    start, end, history = run.start, run.last, run.history
    if not np.allclose(start.radius, start.radius[0]):
        raise NotMeasured(f"{run.path}: grains of unlike radii, S17's are equal")
    parameters = run.parameters
    if parameters["packing"] not in PACKINGS:
        raise NotMeasured(f"{run.path}: packing = {parameters['packing']}, S17's are {' and '.join(PACKINGS)}")
    constants = derived_constants(run, {name: name for name in ("grainRadius", "density", "surfaceEnergy")})
    radius, grains = constants["grainRadius"], len(start.radius)
    velocity, neck = float(parameters["velocity"]), float(parameters["neck"])
    about = run.derived.get("targetPacking") or {}
    return {
        "planar": int(parameters["planar"]),
        "neck": neck,
        "velocity": velocity,
        "growth_velocity": float(about.get("growthVelocity", 0.0)),
        "criticalRolling": float(run.derived["criticalRolling"]),
        "viscoelasticTime": float(parameters["viscoelasticTime"]),
        "cut": int(parameters.get("limit", "held") == "cut"),
        "sliding_factor": float(parameters.get("slidingStiffnessFactor", 1.0)),
        "packing_seed": int(about.get("seed", parameters["seed"])),
        "grains": grains,
        "grain_radius": radius,
        "contacts": 2.0 * len(start.contact_pairs) / grains,
        "initial_radius": float(np.mean([gyration_radius(start.position[start.aggregate == k]) for k in (0, 1)]))
        / radius,
        "met": met(run),
        "touching": int(history["contacts_between"].max()),
        **outcome_values(run, velocity),
        **pieces(end.position, end.contact_pairs, radius),
        "energy_ratio": energy_ratio(neck, velocity, **constants) if neck else float("nan"),
        "necks_at_start": int(np.count_nonzero(start.contact_bonded)),
        **{name: int(history[name][-1]) if name in history else 0 for name in BROKEN_BONDS},
        **partition(history),
        **partition_in_time(history, stretching_period(pair_constants(ICE, radius))),
        **dict(zip(("loops_at_start", "loop_grains_at_start"), loops(grains, start.contact_pairs))),
        **dict(zip(("loops", "loop_grains"), loops(grains, end.contact_pairs))),
        "ended_by": bool(history["time"][-1] < 0.999 * float(parameters["duration"])),
        "closure": closure(history),
        "time": float(history["time"][-1]),
    }


def pieces(position, pairs, radius):
    """{column: value} of the pieces that equal grains at position (N,3) [m], joined by pairs (M,2), make; radius: R [m].

    >>> pieces([[0.0, 0, 0], [2, 0, 0], [9, 0, 0]], [[0, 1]], 1.0)["largest"].__round__(3)
    0.667
    """
    labels = fragment_labels(len(position), pairs)
    fractions = fragment_sizes(labels) / len(position)
    return {
        "largest": float(fractions[0]),
        "second": float(fractions[1]) if len(fractions) > 1 else 0.0,
        "fragments": float(fractions[fractions < FRAGMENT].sum()),
        "gyration_radius": gyration_radius(np.asarray(position)[labels == 0]) / radius,
    }


def energy_ratio(neck, velocity, grainRadius, density, surfaceEnergy):
    """E_k/E_sint of beta and V_c [m/s]: (m V_c^2/4)/(pi gamma (beta R)^2), S17 section 5.3; all in SI.

    >>> round(energy_ratio(0.2, 10**1.5, 1e-7, 1000.0, 0.1), 1)
    8.3
    """
    mass = 4.0 / 3.0 * pi * density * grainRadius**3
    return 0.25 * mass * velocity**2 / breaking_energy(neck, grainRadius, surfaceEnergy)


def partition(history, row=-1):
    """{part_NAME: value} of PARTS at a row of the history, changes over K(0); they add up to 1 for an exact ledger."""
    unit = initial_kinetic_energy(history)
    found = {}
    for name, (_, channels) in PARTS.items():
        change = sum(history[c][row] - history[c][0] for c in channels) / unit
        found[f"part_{name}"] = float(change + (name == "kinetic"))
    return found


def partition_in_time(history, period):
    """{column: value} of the energies after TIMES periods [s], and of every part after EARLY; NaN where the run is not that
    long."""
    time, found = history["time"], {}
    for number in TIMES:
        reached = time[-1] >= REACHED * number * period
        parts = partition(history, int(np.argmin(np.abs(time - number * period))))
        found[f"left_{number}"] = parts["part_kinetic"] + parts["part_elastic"] if reached else nan
        if number == EARLY:
            found.update({f"{name}_{EARLY}": value if reached else nan for name, value in parts.items()})
    return found
