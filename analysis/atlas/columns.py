"""The columns of the atlas's table of runs, in one list, and how a run folder fills them."""

import re
from functools import lru_cache

import numpy as np

from ..measures.compression import first_compression
from ..measures.decided import Pieces, is_recent
from ..measures.fragments import fragment_labels, fragment_sizes
from ..measures.ledger import closure, fractions_at, initial_kinetic_energy
from ..measures.motion import pieces_that_can_meet
from ..measures.of_run import met, time_of_touch
from ..measures.outcome import NEVER_MET, UNDECIDED, restitution_of_pieces
from ..measures.structure import filling_factor, gyration_radius, mean_coordination
from ..runs.format import CHANNEL_TABLE, LOST_CHANNELS
from ..runs.table import Column
from ..studies.columns import VELOCITY, constant, group, one, parameter
from ..studies.definition import NotMeasured
from ..theory import Material, interaction_energies, pair_constants
from .power_law import power_law_index
from .rules import KINDS, outcome
from .variables import FIT, HELD_OUT

NAME = re.compile(r"(\d+)(-held)?")
BODIES = ("target", "projectile")
STICKING = KINDS[0]
AT_END = "{}_at_end"


def _name(run, row):
    """NotMeasured for a run that is none of the atlas's table."""
    found = NAME.fullmatch(run.path.name)
    if not found:
        raise NotMeasured(f"{run.path}: no run of the atlas, whose names are numbers")
    return int(found[1]), HELD_OUT if found[2] else FIT


def _structure(run):
    packing = run.parameters["packing"]
    return run.derived["targetPacking"]["packing"] if packing == "file" else packing


def _cell(run):
    about = run.derived.get("targetPacking") or {}
    return int(about.get("cell", 0))


def _breaking_velocity(run):
    names = ("young", "poisson", "density", "surfaceEnergy", "criticalRolling")
    return breaking_velocity(Material(*(float(run.derived[name]) for name in names)), float(run.derived["grainRadius"]))


@lru_cache
def breaking_velocity(material, radius):
    """v_break = (E_break/m0)^(1/2) [m/s] of grains of a theory.Material and a radius [m]; E_break: A22 eq 12, m0: mass of a grain."""
    constants = pair_constants(material, radius)
    return (interaction_energies(constants)["break"] / (2 * constants.reduced_mass)) ** 0.5


def body(state, members):
    """(filling, coordination, gyration radius [m]) of the grains of a folder.State in the mask members (N,); NaN without any."""
    if not members.any():
        return np.nan, np.nan, np.nan
    position, radius = state.position[members], state.radius[members]
    contacts = state.contact_pairs[members[state.contact_pairs].all(axis=1)]
    return (
        filling_factor(position, radius),
        mean_coordination(int(members.sum()), contacts),
        gyration_radius(position, radius),
    )


def _bodies(run, row):
    """Of both aggregates at the start, the one with more grains first."""
    numbers = np.bincount(run.start.aggregate, minlength=2)
    of = [body(run.start, run.start.aggregate == k) for k in _by_size(run)]
    large, small = sorted(numbers.tolist(), reverse=True)
    return large, small, small / large, *(value for values in zip(*of) for value in values)


def _by_size(run):
    """Numbers (2,) of the aggregates, the one with more grains first."""
    return np.argsort(-np.bincount(run.start.aggregate, minlength=2), kind="stable")


def _pieces(run, row):
    """Largest and second largest piece at the end, and what they are made of; grains are of one mass."""
    end = run.last
    labels = fragment_labels(len(end.radius), end.contact_pairs)
    sizes = fragment_sizes(labels)
    total, members = len(labels), [labels == k for k in (0, 1)]
    shares = [np.mean(end.aggregate[own]) if own.any() else np.nan for own in members]
    own = min(1 - min(shares), max(shares)) if len(sizes) > 1 else 0.0
    index, error = power_law_index(sizes[1:])
    of = [body(end, own) for own in members]
    second = sizes[1] / total if len(sizes) > 1 else 0.0
    return (
        *(value for values in zip(*of) for value in values),
        *(index, error, _restitution(run, members), _spin(run, members[0])),
        *(sizes[0] / total, second, len(sizes), own),
    )


def _restitution(run, members):
    """Of the two largest pieces, as measures.outcome has it; NaN where there is none."""
    start, end, mass = run.start, run.last, np.ones(len(run.last.radius))
    if not members[1].any():
        return 0.0
    pieces = sorted(members, key=lambda own: end.aggregate[own].mean())
    found = restitution_of_pieces(start.aggregate, mass, mass > 0, pieces, start.velocity, end.velocity)
    return np.nan if found is None else found


def _spin(run, members):
    """Kinetic energy of the largest piece's rotation as a rigid body over K(0); without the grains' own spin."""
    end = run.last
    mass = 4 / 3 * np.pi * run.derived["density"] * end.radius[members] ** 3
    position, velocity = end.position[members], end.velocity[members]
    position = position - np.average(position, axis=0, weights=mass)
    momentum = (mass[:, None] * np.cross(position, velocity)).sum(axis=0)
    square = (mass * ((position**2).sum(axis=1) + 0.4 * end.radius[members] ** 2)).sum()
    inertia = square * np.eye(3) - (mass[:, None, None] * position[:, :, None] * position[:, None, :]).sum(axis=0)
    return float(momentum @ np.linalg.solve(inertia, momentum)) / 2 / initial_kinetic_energy(run.history)


def _compression(run):
    """Dissipated over K(0) and the potential energy released until then; NaN where the halves never turned around."""
    history = run.history
    maximum, _ = first_compression(history["time"], history["d"], history["v"])
    if maximum is None or not maximum.inside or not met(run):
        return np.nan
    parts = fractions_at(history, maximum.time)
    lost = sum(parts[name] for name in LOST_CHANNELS)
    return lost / (lost + parts["kinetic"])


def _outcome(run, row):
    """By the rules of this table, where it is decided."""
    if not met(run):
        return (UNDECIDED if "firstTouch" in run.derived else NEVER_MET,)
    kind = outcome(row)
    touch = time_of_touch(run)
    recent = [
        Pieces(vars(run.states[k]), run.derived)
        for k in np.flatnonzero(is_recent(run.states.times, run.last.time, touch))
    ]
    open_still = (
        (kind == STICKING and recent[-1].why_rebounding(run.last.time - touch))
        or _may_meet(kind, row, recent[-1])
        or any(_may_break(kind, row, pieces) for pieces in recent)
    )
    return (UNDECIDED if open_still else kind,)


def _may_meet(kind, row, pieces):
    """Whether pieces that may meet the largest again would make another outcome (measures.decided)."""
    shares = np.bincount(pieces.labels) / len(pieces.labels)
    more = shares[pieces_that_can_meet(0, *pieces.flight, np.inf)].sum()
    return outcome({**row, "largest": row["largest"] + more}) != kind


def _may_break(kind, row, pieces):
    """Whether what may break off the largest piece would make another outcome; not told of pieces that are no such outcome yet."""
    cut, side = pieces.loose_cuts()
    largest, second = [*np.bincount(pieces.labels) / len(pieces.labels), 0.0][:2]
    lost = side[cut == 0].max(initial=0.0) / pieces.mass.sum()
    seen = outcome({**row, "largest": largest, "second": second})
    return seen == kind != outcome({**row, "largest": largest - lost, "second": max(second, lost)})


def _energies(run, row):
    parts = fractions_at(run.history, run.history["time"][-1])
    return [parts[channel.name] for channel in CHANNEL_TABLE]


def _cost(run, row):
    return int(run.derived.get("steps") or 0), float(run.record.get("wallTime") or 0.0)


def _of_bodies(when):
    """Columns of two bodies, as _bodies and _pieces give them."""
    kinds = (("filling", "1", "volume filling factor, of a sphere of radius (5/3)^(1/2) R_g"),)
    kinds += (("coordination", "", "mean number of contacts of a grain"), ("gyration", "m", "radius of gyration R_g"))
    return tuple(
        Column(f"{kind}_{name}", unit, f"of the {name}{said}: {meaning}", gaps=True)
        for kind, unit, meaning in kinds
        for name, said in when.items()
    )


MEASURED = (
    group(
        _name,
        Column("number", "", "of the row in the atlas's table", "i"),
        Column("split", "", f"{FIT}, or {HELD_OUT}: drawn before any run, never fitted", "O"),
    ),
    parameter("material", "", "material of the grains", "O"),
    one("structure", "", "bcca, bpca, cpe or compressed", _structure, kind="O"),
    one(
        "cell",
        "",
        "of compressed aggregates the cell they were cut out of: those of one cell are not independent; 0: none",
        _cell,
        kind="i",
    ),
    group(
        _bodies,
        Column("grains_target", "", "grains of the larger aggregate", "i"),
        Column("grains_projectile", "", "grains of the smaller one", "i"),
        Column("mass_ratio", "", "smaller over larger"),
        *_of_bodies(dict.fromkeys(BODIES, " before")),
    ),
    VELOCITY,
    one("v_break", "m/s", "(E_break/m0)^(1/2) of the grains", _breaking_velocity),
    parameter("impact", "", "impact parameter over the sum of the characteristic radii (5/3)^(1/2) R_g"),
    parameter("seed", "", "of packings that were not read from files", "i"),
    constant("grain_radius", "m", "radius of a grain", "grainRadius"),
    group(
        _pieces,
        *_of_bodies({"largest": " piece", "second": " largest piece"}),
        Column("fragment_index", "", "n of dN/dm ~ m^-n of all pieces but the largest", gaps=True),
        Column("fragment_index_error", "", "its standard error", gaps=True),
        Column(
            "restitution",
            "",
            "relative speed of the two largest pieces over that of the aggregates; 0 for one piece",
            gaps=True,
        ),
        Column("spin", "K(0)", "kinetic energy of the largest piece's rotation", gaps=True),
        Column("largest", "", "mass of the largest piece over the total"),
        Column("second", "", "of the second largest"),
        Column("pieces", "", "their number", "i"),
        Column("own", "", "of these two, the least part of a piece's mass that is of its own aggregate"),
    ),
    one(
        "lost_in_compression",
        "",
        "dissipated until the first largest compression, over K(0) and the potential energy released until then",
        _compression,
        gaps=True,
    ),
    group(
        _outcome,
        Column(
            "outcome",
            "",
            "by analysis/atlas/rules.py; undecided; never met: on straight ways they never touch, and the run was cut short",
            "O",
        ),
    ),
    group(
        _energies,
        *(
            Column(AT_END.format(c.name), "K(0)", f"{c.label}, change until the end (kinetic: what is left)")
            for c in CHANNEL_TABLE
        ),
    ),
    one("energy_closure", "", "largest error of the energy ledger over K(0)", lambda run: closure(run.history)),
    group(
        _cost,
        Column("steps", "", "time steps", "i"),
        Column("seconds", "s", "run time on a machine shared with others"),
    ),
)
