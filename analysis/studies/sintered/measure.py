"""What is measured of each collision of S17's: aggregates, outcome, pieces, necks, energy and loops."""

from math import nan, pi

import numpy as np

from ...measures.fragments import fragment_labels, fragment_sizes
from ...measures.ledger import initial_kinetic_energy
from ...measures.network import loops
from ...measures.of_run import derived_constants
from ...measures.structure import gyration_radius
from ...runs.format import BROKEN_BONDS
from ...runs.table import Column
from ...theory.bonds import breaking_energy
from ...theory.chains import stretching_period
from ...theory.pair_constants import ICE, pair_constants
from ..columns import CLOSURE, END, GRAIN_RADIUS, MET, OUTCOME, VELOCITY, VISCOUS_TIME, constant, group, parameter
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


def _aggregates(run, row):
    """NotMeasured where the aggregates are of another kind, of unlike grains or of other grains than S17's (but for xi_crit and the sliding
    spring)."""
    require_papers_grains(run, but=("criticalRolling", "slidingStiffnessFactor"))
    start, parameters, about = run.start, run.parameters, run.derived.get("targetPacking") or {}
    if not np.allclose(start.radius, start.radius[0]):
        raise NotMeasured(f"{run.path}: grains of unlike radii, S17's are equal")
    if parameters["packing"] not in PACKINGS:
        raise NotMeasured(f"{run.path}: packing = {parameters['packing']}, S17's are {' and '.join(PACKINGS)}")
    contacts = 2.0 * len(start.contact_pairs) / len(start.radius)
    radii = [gyration_radius(start.position[start.aggregate == k]) for k in (0, 1)]
    springs = int(parameters.get("limit", "held") == "cut"), float(parameters.get("slidingStiffnessFactor", 1.0))
    named = float(about.get("growthVelocity", 0.0)), int(about.get("seed", parameters["seed"]))
    return *springs, *named, len(start.radius), contacts, float(np.mean(radii)) / row["grain_radius"]


def _necks(run, row):
    constants = row["grain_radius"], *derived_constants(run, "density", "surfaceEnergy")
    ratio = energy_ratio(row["neck"], row["velocity"], *constants) if row["neck"] else nan
    broken = (int(run.history[name][-1]) if name in run.history else 0 for name in BROKEN_BONDS)
    return ratio, int(np.count_nonzero(run.start.contact_bonded)), *broken


def _parts(run, row):
    """partition() at the end; what is left after each of TIMES; partition() after EARLY of them. NaN where the run is not that long."""
    time, period = run.history["time"], stretching_period(pair_constants(ICE, row["grain_radius"]))

    def after(number):
        reached = time[-1] >= REACHED * number * period
        place = int(np.argmin(np.abs(time - number * period)))
        return partition(run.history, place) if reached else [nan] * len(PARTS)

    return *partition(run.history), *(sum(after(number)[:2]) for number in TIMES), *after(EARLY)


def _loops(run, row):
    """Numbers of loops at the start and at the end, then of the grains in them."""
    return np.transpose([loops(row["grains"], state.contact_pairs) for state in (run.start, run.last)]).ravel().tolist()


def pieces(position, pairs, radius):
    """Mass fractions of the largest of the pieces that equal grains at position (N,3) [m], joined by pairs (M,2), make, of the second, and of all
    below FRAGMENT; gyration radius of the largest over radius, R [m].

    >>> [round(value, 3) for value in pieces([[0.0, 0, 0], [2, 0, 0], [9, 0, 0]], [[0, 1]], 1.0)]
    [0.667, 0.333, 0.0, 1.0]
    """
    labels = fragment_labels(len(position), pairs)
    fractions = fragment_sizes(labels) / len(position)
    second, small = fractions[1] if len(fractions) > 1 else 0.0, fractions[fractions < FRAGMENT].sum()
    return *map(float, (fractions[0], second, small)), gyration_radius(np.asarray(position)[labels == 0]) / radius


def energy_ratio(neck, velocity, grainRadius, density, surfaceEnergy):
    """E_k/E_sint of beta and V_c [m/s]: (m V_c^2/4)/(pi gamma (beta R)^2), S17 section 5.3; all in SI.

    >>> round(energy_ratio(0.2, 10**1.5, 1e-7, 1000.0, 0.1), 1)
    8.3
    """
    mass = 4.0 / 3.0 * pi * density * grainRadius**3
    return 0.25 * mass * velocity**2 / breaking_energy(neck, grainRadius, surfaceEnergy)


def partition(history, place=-1):
    """Values of PARTS at a place of the history, changes over K(0); they add up to 1 for an exact ledger."""
    unit = initial_kinetic_energy(history)
    change = lambda channels: sum(history[c][place] - history[c][0] for c in channels) / unit
    return [float(change(channels) + (name == "kinetic")) for name, (_, channels) in PARTS.items()]


MEASURED = (
    parameter("planar", "", "1: grains in a plane", "i"),
    parameter("neck", "", "beta; 0: unsintered"),
    VELOCITY,
    constant("criticalRolling", "m", "xi_crit"),
    VISCOUS_TIME,
    GRAIN_RADIUS,
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
    MET,
    OUTCOME,
    group(
        lambda run, row: (int(run.history["contacts_between"].max()),),
        Column("touching", "", "largest number of contacts between the aggregates", **LATER),
    ),
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
        *(Column(f"part_{n}", "K(0)", f"{LABELS[n]}: at the end, or until then") for n in PARTS),
        *(Column(f"left_{n}", "K(0)", f"kinetic and stored energy after {n} periods", **LATER) for n in TIMES),
        *(Column(f"part_{n}_{EARLY}", "K(0)", f"{LABELS[n]} after {EARLY} periods", **LATER) for n in PARTS),
    ),
    group(
        _loops,
        Column("loops_at_start", "", "independent loops of contacts in both aggregates at the start", **LATER),
        Column("loops", "", "the same at the end", **LATER),
        Column("loop_grains_at_start", "", "grains in loops at the start", **LATER),
        Column("loop_grains", "", "the same at the end", **LATER),
    ),
    group(
        lambda run, row: (bool(run.history["time"][-1] < 0.999 * float(run.parameters["duration"])),),
        Column("ended_by", "", "whether the run ended before its duration: nothing could meet or break", kind="b"),
    ),
    CLOSURE,
    END,
)
