"""One row of numbers for each collision: what the fits, tables and figures are made of."""

from dataclasses import dataclass
from pathlib import Path
from typing import Mapping

import numpy as np

from ..channels import CHANNELS
from ..collision_outcome import STICKING, collision_outcome
from ..ledger import closure, initial_kinetic_energy, shares
from ..measures.compression import compression_length, maximum_compression
from ..run_folder import RunFolderError, read_arrays

# Grains deeper than this below the sphere that holds all centres have all their neighbours' sites in it.
SKIN = 2.0  # grain radii

# Of a run that ends in one piece while its halves still part, at more than this share of the largest speed of
# their return: a sixteenth of that kinetic energy is left, which may yet part them.
UNDECIDED, STILL_PARTING = "undecided", 0.25


class NoCompression(RunFolderError):
    """A sound run in which the aggregates did not meet, or not turn around."""


@dataclass(frozen=True)
class Row:
    """A collision's numbers, SI. radius: of an aggregate [m]; offset: d(0) + 2 r, by which the centres of
    mass are closer than the spheres' centres by chance; d_max, t_max and their errors (compression.Maximum)
    of the first compression; exceeded: whether d grows beyond it later; label_d_max: d_max with each
    aggregate's own grains in place of A24's x > 0 and x < 0; shares: by channel, the change since the start
    over K(0) at t_max and at the end (kinetic: what is left); bulk: (v/v_col)^2 at the end, the kinetic share
    of the motion of the halves; outcome: as collision_outcome's, or UNDECIDED; coordination of all grains and of those inside, at the start."""

    path: Path
    filling: float
    radius: float
    velocity: float
    seed: int
    grain_radius: float
    grain_density: float
    pull_off_force: float
    overlap: float
    offset: float
    d_max: float
    d_max_error: float
    exceeded: bool
    t_max: float
    t_max_error: float
    label_d_max: float
    outcome: str
    restitution: float
    shares_at_maximum: Mapping
    shares_at_end: Mapping
    bulk: float
    coordination: float
    inner_coordination: float
    closure: float


def measure(run):
    """Row of a RunFolder of A24's scene that has ended. NoCompression where the aggregates never met or never
    turned around, RunFolderError where something is missing."""
    history, derived = run.history, run.derived
    maximum, again = first_compression(history["time"], history["d"], history["v"])
    if maximum is None or not maximum.inside or not np.any(history["contacts_between"] > 0):
        raise NoCompression(f"{run.path}: the aggregates have not met, or not turned around")
    if not initial_kinetic_energy(history) > 0:
        raise RunFolderError(f"{run.path / 'history.npz'}: no kinetic energy at the start")
    start = run.start
    try:
        outcome = collision_outcome(start, run.last)
        radius, grain_radius = float(derived["aggregateRadius"]), float(derived["grainRadius"])
        constants = [float(derived[name]) for name in ("density", "pullOffForce", "equilibriumOverlap")]
    except (KeyError, TypeError, ValueError) as error:
        raise RunFolderError(f"{run.path}: cannot be measured: {error}") from None
    parts = shares(history)
    velocity = float(run.parameters["velocity"])
    return Row(
        path=run.path,
        filling=float(run.parameters["filling"]),
        radius=radius,
        velocity=velocity,
        seed=int(run.parameters["seed"]),
        grain_radius=grain_radius,
        grain_density=constants[0],
        pull_off_force=constants[1],
        overlap=constants[2],
        offset=float(history["d"][0]) + 2.0 * grain_radius,
        d_max=maximum.length,
        d_max_error=maximum.length_error,
        exceeded=again,
        t_max=maximum.time,
        t_max_error=maximum.time_error,
        label_d_max=maximum.length + _label_difference(run, maximum.time, radius),
        outcome=UNDECIDED if outcome.kind == STICKING and still_parting(history["v"]) else outcome.kind,
        restitution=outcome.restitution,
        shares_at_maximum={c: float(np.interp(maximum.time, history["time"], parts[c])) for c in CHANNELS},
        shares_at_end={c: float(parts[c][-1]) for c in CHANNELS},
        bulk=float(np.nan_to_num(history["v"][-1] / velocity) ** 2),
        coordination=2.0 * len(start.contact_pairs) / len(start.radius),
        inner_coordination=_inner_coordination(start, radius, grain_radius),
        closure=closure(history),
    )


def still_parting(v):
    """Whether halves with the mutual velocity v (N,) [m/s], positive while they approach (A24 eq 12), part at the
    end at more than STILL_PARTING of the largest speed at which they ever did."""
    v = np.asarray(v, dtype=float)
    v = v[np.isfinite(v)]
    return bool(v.size and v.min() < 0 and v[-1] < STILL_PARTING * v.min())


def first_compression(time, d, v):
    """(Maximum, whether d exceeds it later): the largest d before v, once fallen through zero, rises through
    it again. Aggregates that stuck may creep together further, long after the collision (A24 defines d_max as
    the largest d; it is this one then). Arguments and None as maximum_compression, of whole arrays without
    NaN between."""
    v = np.asarray(v, dtype=float)
    falls = np.flatnonzero((v[:-1] > 0) & (v[1:] <= 0))
    rises = np.flatnonzero((v[:-1] <= 0) & (v[1:] > 0))
    rises = rises[rises > falls[0]] if falls.size else rises[:0]
    end = int(rises[0]) + 1 if rises.size else len(v)
    first = maximum_compression(time[:end], d[:end], v[:end])
    return first, bool(first is not None and np.nanmax(d) > first.length)


def label_length(x, aggregate, aggregate_radius):
    """d [m] as A24 eq 10, but with the means over the grains that belonged to each aggregate at the start: x
    (N,) [m], aggregate (N,) 0 or 1."""
    return 2.0 * aggregate_radius - abs(x[aggregate == 1].mean() - x[aggregate == 0].mean())


def _label_difference(run, time, radius):
    """What d by the label has over d by the sign of x at `time` [m]: between the states before and after
    it."""
    times = run.states.times
    after = int(np.clip(np.searchsorted(times, time), 1, len(times) - 1)) if len(times) > 1 else 0
    differences = []
    for k in sorted({max(after - 1, 0), after}):
        arrays = read_arrays(run.states.files[k], ("position", "aggregate"))
        x = arrays["position"][:, 0]
        differences.append(label_length(x, arrays["aggregate"], radius) - compression_length(x, radius))
    return float(np.interp(time, times[[max(after - 1, 0), after]][-len(differences) :], differences))


def _inner_coordination(start, radius, grain_radius):
    """Mean contacts of the grains whose centre lies SKIN below the sphere of all centres; nan if there is
    none."""
    contacts = np.bincount(start.contact_pairs.ravel(), minlength=len(start.radius))
    # The spheres stand at -+(R + r) on the collision axis (A24 section 3).
    centre = np.where(start.aggregate == 1, 1.0, -1.0) * (radius + grain_radius)
    place = start.position - np.stack([centre, 0.0 * centre, 0.0 * centre], axis=1)
    inside = np.einsum("ij,ij->i", place, place) < (radius - SKIN * grain_radius) ** 2
    return float(contacts[inside].mean()) if inside.any() else float("nan")
