"""What is measured of a run folder: its arrays given to the functions of analysis.measures."""

import numpy as np

from ..measures.compression import first_compression
from ..measures.decided import CONSTANTS, is_recent, why_undecided
from ..measures.fragments import belongs_to_an_aggregate, grain_masses
from ..measures.outcome import collision_outcome
from ..measures.plate import has_plate, plate_outcome, why_undecided_on_plate
from .files import RunFolderError
from .format import COLLISION, COMPRESSION, STATES_FOLDER
from .ledger import initial_kinetic_energy, largest_change, largest_work

UNLIKE = 0.05  # of the heavier aggregate's mass: with a larger difference the plane x = 0 is not where they meet


def maximum_of_run(run):
    """compression.Maximum of a RunFolder's first compression; None where d has no value."""
    return first_compression(run.history["time"], run.history["d"], run.history["v"])


def are_equal(run):
    """Whether the two aggregates of a RunFolder are of equal mass to within UNLIKE, or one hits a plate: d and v have
    a meaning then."""
    start = run.start
    masses = np.bincount(start.aggregate, grain_masses(vars(start)), minlength=2)
    return has_plate(vars(start)) or bool(np.ptp(masses) <= UNLIKE * masses.max())


def met(run):
    """Whether the two aggregates of a RunFolder, or aggregate and plate, touched until its last sample: at the run's
    first touch, which includes a graze between two samples, or at a sample."""
    history = run.history
    return bool(run.derived.get("firstTouch", np.inf) <= history["time"][-1] or np.any(history["contacts_between"] > 0))


def time_of_touch(run):
    """Time [s] of the first touch of a RunFolder's aggregates: that of the run, or of the first sample with contacts
    between them. It has no meaning if they never met."""
    return run.derived.get("firstTouch", run.history["time"][np.argmax(run.history["contacts_between"] > 0)])


def outcome_of_run(run):
    """outcome.Outcome of a RunFolder from its first and last state, undecided if it may still become another one
    (decided.why_undecided; runs that lack its constants are taken as decided). RunFolderError if the states don't
    match."""
    start, end = run.start, run.last
    if start.aggregate.shape != end.aggregate.shape or np.any(start.aggregate != end.aggregate):
        raise RunFolderError(f"{run.path / STATES_FOLDER}: the first and the last state don't hold the same grains")
    on_plate = has_plate(vars(start))
    try:
        if on_plate:
            found = plate_outcome(vars(start), vars(end), met(run))
        else:
            at_start = grain_masses(vars(start)), start.aggregate, start.velocity, start.contact_pairs
            found = collision_outcome(*at_start, end.velocity, end.contact_pairs, met(run))
    except ValueError as error:
        raise RunFolderError(f"{run.path / STATES_FOLDER}: {error}") from None
    # The run has found that they never touch on their straight ways (which format 1 does not say), if none spins.
    spins = any(run.parameters.get(name) for name in ("spin", "projectileSpin"))
    passes = run.record["format"] > 1 and "firstTouch" not in run.derived and not met(run) and not spins
    if passes or not all(name in run.derived for name in CONSTANTS):
        return found
    touch = time_of_touch(run)
    before = np.flatnonzero(is_recent(run.states.times, end.time, touch))[:-1]
    recent = (vars(run.states[index]) for index in before)  # read only where they are needed
    if on_plate:
        why = why_undecided_on_plate(found.kind, vars(start), vars(end), run.derived, touch, recent)
    else:
        counted = belongs_to_an_aggregate(start.aggregate, start.contact_pairs, grain_masses(vars(start)))
        why = why_undecided(found.kind, counted, vars(end), run.derived, touch, recent)
    return found.if_decided(why)


def unit_of(run):
    """(energy [J], its name) over which the energies of a RunFolder's ledger are given."""
    if run.kind is COMPRESSION:
        return largest_work(run.history), "the boundaries' largest work"
    if run.kind is COLLISION:
        return initial_kinetic_energy(run.history), "K(0)"
    return largest_change(run.history), "the largest change of a channel"


def derived_constants(run, *names):
    """[float] of a RunFolder's derived constants of these names; RunFolderError where one is missing or no number."""
    try:
        return [float(run.derived[name]) for name in names]
    except (KeyError, TypeError, ValueError) as error:
        raise RunFolderError(f"{run.path}: cannot be measured: {error}") from None
