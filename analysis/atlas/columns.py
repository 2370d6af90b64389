"""The columns of the atlas's table of runs, and how a run folder fills them."""

import re

import numpy as np
from scipy.optimize import brentq

from ..measures.decided import Pieces, is_recent
from ..measures.fragments import fragment_labels, fragment_sizes
from ..measures.motion import pieces_that_can_meet
from ..measures.outcome import NEVER_MET, UNDECIDED, restitution_of_pieces
from ..measures.structure import of_members
from ..runs.files import RunFolderError
from ..runs.format import CHANNEL_TABLE, LOST_CHANNELS
from ..runs.ledger import closure, fractions_at, initial_kinetic_energy
from ..runs.measured import maximum_of_run, met, time_of_touch
from ..runs.table import Column, read_table
from ..theory import Material, breaking_velocity
from .rules import KINDS, outcome
from .variables import FIT, HELD_OUT

NAME = re.compile(r"(\d+)(-held)?")  # of a run folder: the number of the row, and whether it is held out
OF_BODY = (
    ("filling", "1", "volume filling factor, of a sphere of radius (5/3)^(1/2) R_g"),
    ("coordination", "", "mean number of contacts of a grain"),
    ("gyration", "m", "radius of gyration R_g"),
)
BEFORE = {"target": " before", "projectile": " before"}
AFTER = {"largest": " piece", "second": " largest piece"}


def _of_bodies(bodies):
    return [
        Column(f"{kind}_{name}", unit, f"of the {name}{words}: {meaning}", gaps=True)
        for kind, unit, meaning in OF_BODY
        for name, words in bodies.items()
    ]


COLUMNS = (
    Column("number", "", "of the row in the atlas's table", "i"),
    Column("split", "", f"{FIT}, or {HELD_OUT}: drawn before any run, never fitted", "O"),
    Column("material", "", "material of the grains", "O"),
    Column("structure", "", "bcca, bpca, cpe or compressed", "O"),
    Column("cell", "", "that compressed aggregates were cut out of: those of one are not independent; 0: none", "i"),
    Column("grains_target", "", "grains of the larger aggregate", "i"),
    Column("grains_projectile", "", "grains of the smaller one", "i"),
    Column("mass_ratio", "", "smaller over larger"),
    *_of_bodies(BEFORE),
    Column("velocity", "m/s", "collision velocity"),
    Column("v_break", "m/s", "(E_break/m0)^(1/2) of the grains"),
    Column("impact", "", "impact parameter over the sum of the characteristic radii (5/3)^(1/2) R_g"),
    Column("seed", "", "of packings that were not read from files", "i"),
    Column("at_rest", "", "1: contacts were brought to rest before; 0: grown aggregates were as made", "i"),
    Column("grain_radius", "m", "radius of a grain"),
    *_of_bodies(AFTER),
    Column("fragment_index", "", "n of dN/dm ~ m^-n of all pieces but the largest", gaps=True),
    Column("fragment_index_error", "", "its standard error", gaps=True),
    Column("restitution", "", "relative speed of the two largest pieces over that at the start; 0: one", gaps=True),
    Column("spin", "K(0)", "kinetic energy of the largest piece's rotation", gaps=True),
    Column("largest", "", "mass of the largest piece over the total"),
    Column("second", "", "of the second largest"),
    Column("pieces", "", "their number", "i"),
    Column("own", "", "of these two, the least part of a piece's mass that is of its own aggregate"),
    Column(
        "lost_in_compression", "", "dissipated until d_max, over K(0) and what adhesion released by then", gaps=True
    ),
    Column("outcome", "", "by analysis/atlas/rules.py; undecided; never met: on straight ways they never touch", "O"),
    *(
        Column(f"{c.name}_at_end", "K(0)", f"{c.label}, change until the end (kinetic: what is left)")
        for c in CHANNEL_TABLE
    ),
    Column("energy_closure", "", "largest error of the energy ledger over K(0)"),
    Column("steps", "", "time steps", "i"),
    Column("seconds", "s", "run time on a machine shared with others"),
)


def read_runs(file):
    """The atlas's table of runs (DataFrame) from a runs.csv; Refused where it is none."""
    return read_table(file, COLUMNS)[0]


def measure(run):
    """{column: value} of a RunFolder; RunFolderError where it lacks a parameter."""
    try:
        row = _scene(run)
    except (KeyError, TypeError, ValueError) as error:
        raise RunFolderError(f"{run.path}: cannot be measured: {error}") from None
    row |= _aggregates(run) | _pieces(run)
    parts = fractions_at(run.history, run.history["time"][-1])
    row |= {f"{channel.name}_at_end": parts[channel.name] for channel in CHANNEL_TABLE}
    row["lost_in_compression"] = _lost_in_compression(run)
    row["outcome"] = _outcome(run, row)
    row["energy_closure"] = closure(run.history)
    row["steps"] = int(run.derived.get("steps") or 0)
    row["seconds"] = float(run.record.get("wallTime") or 0.0)
    return row


def _scene(run):
    given, derived = run.settled, run.derived
    name = NAME.fullmatch(run.path.name)  # None: of a run of one's own
    number, held = name.groups() if name else (-1, None)
    packing = derived.get("targetPacking") or {}
    names = ("young", "poisson", "density", "surfaceEnergy", "criticalRolling")
    radius = float(derived["grainRadius"])
    return {
        "number": int(number),
        "split": HELD_OUT if held else FIT,
        "material": str(given["material"]),
        "structure": packing["packing"] if given["packing"] == "file" else given["packing"],
        "cell": int(packing.get("cell", 0)),
        "velocity": float(given["velocity"]),
        "v_break": breaking_velocity(Material(*(float(derived[name]) for name in names)), radius),
        "impact": float(given["impact"]),
        "seed": int(given["seed"]),
        "at_rest": int(given.get("atRest", 0)),
        "grain_radius": radius,
    }


def _aggregates(run):
    """Columns of both aggregates at the start, the one with more grains first."""
    grains = np.bincount(run.start.aggregate, minlength=2)
    by_size = np.argsort(-grains, kind="stable")
    large, small = grains[by_size].tolist()
    row = {"grains_target": large, "grains_projectile": small, "mass_ratio": small / large}
    for name, k in zip(BEFORE, by_size):
        row |= _body(name, run.start, run.start.aggregate == k)
    return row


def _pieces(run):
    """Columns of the pieces at the end; all grains have the same mass."""
    end = run.last
    labels = fragment_labels(len(end.radius), end.contact_pairs)
    sizes, members = fragment_sizes(labels), [labels == k for k in (0, 1)]
    shares = [np.mean(end.aggregate[own]) if own.any() else np.nan for own in members]
    index, error = power_law_index(sizes[1:])
    row = {
        "largest": sizes[0] / len(labels),
        "second": sizes[1] / len(labels) if len(sizes) > 1 else 0.0,
        "pieces": len(sizes),
        "own": min(1 - min(shares), max(shares)) if len(sizes) > 1 else 0.0,
        "fragment_index": index,
        "fragment_index_error": error,
        "restitution": _restitution(run, members),
        "spin": _spin(run, members[0]),
    }
    for name, own in zip(AFTER, members):
        row |= _body(name, end, own)
    return row


def _body(name, state, members):
    """Columns OF_BODY of the grains of a folder.State in the mask members (N,); NaN where there are none."""
    values = of_members(state, members) if members.any() else [np.nan] * len(OF_BODY)
    return {f"{kind}_{name}": value for (kind, _, _), value in zip(OF_BODY, values)}


def _restitution(run, members):
    """Of the two largest pieces, as in measures.outcome; NaN where it is not defined."""
    start, end, mass = run.start, run.last, np.ones(len(run.last.radius))
    if not members[1].any():
        return 0.0
    pieces = sorted(members, key=lambda own: end.aggregate[own].mean())
    found = restitution_of_pieces(start.aggregate, mass, mass > 0, pieces, start.velocity, end.velocity)
    return np.nan if found is None else found


def _spin(run, members):
    """Kinetic energy of the largest piece's rotation as a rigid body over K(0), without the grains' own spin."""
    end = run.last
    mass = 4 / 3 * np.pi * run.derived["density"] * end.radius[members] ** 3
    position, velocity = end.position[members], end.velocity[members]
    position = position - np.average(position, axis=0, weights=mass)
    momentum = (mass[:, None] * np.cross(position, velocity)).sum(axis=0)
    square = (mass * ((position**2).sum(axis=1) + 0.4 * end.radius[members] ** 2)).sum()
    inertia = square * np.eye(3) - (mass[:, None, None] * position[:, :, None] * position[:, None, :]).sum(axis=0)
    return float(momentum @ np.linalg.solve(inertia, momentum)) / 2 / initial_kinetic_energy(run.history)


def _lost_in_compression(run):
    """NaN where the halves never turned around."""
    maximum = maximum_of_run(run)
    if maximum is None or not maximum.inside or not met(run):
        return np.nan
    parts = fractions_at(run.history, maximum.time)
    lost = sum(parts[name] for name in LOST_CHANNELS)
    return lost / (lost + parts["kinetic"])


def _outcome(run, row):
    """By the rules; UNDECIDED where pieces may still meet or break, or the aggregates still rebound."""
    if not met(run):
        return UNDECIDED if "firstTouch" in run.derived else NEVER_MET
    kind, touch, end = str(outcome(row)), time_of_touch(run), run.last.time
    recent = [Pieces(vars(run.states[k]), run.derived) for k in np.flatnonzero(is_recent(run.states.times, end, touch))]
    rebounding = kind == KINDS[0] and recent[-1].why_rebounding(end - touch)
    if rebounding or _may_meet(kind, row, recent[-1]) or any(_may_break(kind, row, pieces) for pieces in recent):
        return UNDECIDED
    return kind


def _may_meet(kind, row, pieces):
    """Whether pieces (measures.decided) that may meet the largest again would make another outcome."""
    shares = np.bincount(pieces.labels) / len(pieces.labels)
    more = shares[pieces_that_can_meet(0, *pieces.flight, np.inf)].sum()
    return outcome({**row, "largest": row["largest"] + more}) != kind


def _may_break(kind, row, pieces):
    """Whether what may break off the largest piece would make another outcome; False where the pieces are not (yet)
    of this outcome."""
    largest, second = [*np.bincount(pieces.labels) / len(pieces.labels), 0.0][:2]
    without = lambda lost: str(outcome({**row, "largest": largest - lost, "second": max(second, lost)}))
    return pieces.why_breaking(kind, slice(None), {0: without}) is not None


FEWEST = 5  # fragments of which an index is estimated
RANGE = -3.0, 8.0  # of the index


def power_law_index(sizes, most=None):
    """(index n of dN/dm ~ m^-n of fragments by maximum likelihood, its standard error), of the grains (K,) of each
    fragment; most: the largest possible one, by default all grains together. NaN for fewer than FEWEST fragments, and
    where the index is not within RANGE.

    Clauset, Shalizi & Newman (2009), eq 3.7 with an upper end: mass is conserved, so that the index may be below 1."""
    sizes = np.asarray(sizes)
    if len(sizes) < FEWEST:
        return np.nan, np.nan
    log = np.log(np.arange(1, int(most or sizes.sum()) + 1))
    mean = np.log(sizes).mean()

    def moments(index):
        weights = np.exp(-index * log)
        first = (weights * log).sum() / weights.sum()
        return first, (weights * log**2).sum() / weights.sum() - first**2

    excess = lambda index: moments(index)[0] - mean
    if not excess(RANGE[0]) > 0 > excess(RANGE[1]):
        return np.nan, np.nan
    index = brentq(excess, *RANGE)
    return index, (len(sizes) * moments(index)[1]) ** -0.5
