"""The energy ledger: the channels [J] of a history, their sum, how well it stays constant, and where the energy goes.

A history is a mapping of arrays (T,) by name: `time` [s] and every channel of runs.format.
"""

import numpy as np

from ..arrays import numbers
from ..measures.periodic_cell import work_on_boundaries
from .format import CHANNELS, STORED_CHANNELS

ROUNDING = 1e-12  # of the largest energy
# A22's five ways to lose energy; connection and disconnection together are its E_dis,c.
WAYS = {
    "rolling": ["rollingDissipation"],
    "sliding": ["slidingDissipation"],
    "twisting": ["twistingDissipation"],
    "contacts": ["connection", "disconnection"],
    "drag": ["drag"],
}


def total_energy(history):
    """Sum of all channels (T,) [J], work on boundaries and constraints included: constant for an exact ledger.

    >>> energies = {"kinetic": np.array([4.0, 1.0]), "drag": np.array([0.0, 2.0])}
    >>> total_energy({**dict.fromkeys(CHANNELS, np.zeros(2)), **energies}).tolist()
    [4.0, 3.0]
    """
    return np.sum([numbers(name, history[name], (None,)) for name in CHANNELS], axis=0)


def initial_kinetic_energy(history):
    """K(0) [J]: the unit of the fractions and of the closure."""
    return float(history["kinetic"][0])


def largest_change(history):
    """Largest |E_c(t) - E_c(0)| [J] of any channel c: the unit for a script's own run, which may start at rest; 0 where
    there is nothing but rounding."""
    change = float(max(np.abs(history[name] - history[name][0]).max() for name in CHANNELS))
    return change if change > ROUNDING * max(np.abs(history[name]).max() for name in CHANNELS) else 0.0


def closure_history(history, unit=None):
    """[E(t) - E(0)] over a unit [J] (K(0) if left out) (T,), 0 at all times for an exact ledger; None where that
    is 0."""
    unit = initial_kinetic_energy(history) if unit is None else unit
    total = total_energy(history)
    return (total - total[0]) / unit if unit > 0 else None


def closure(history, unit=None):
    """Largest |closure_history()|. Of a compression, which starts almost at rest, it is work_closure()."""
    error = closure_history(history, unit)
    return None if error is None else float(np.abs(error).max())


def largest_work(history):
    """Largest work [J] on the boundaries, either way: the unit of energies of a cell that starts almost at rest."""
    return float(np.abs(work_on_boundaries(history)).max())


def work_closure(history):
    """Largest |E(t) - E(0)| over the largest work of the boundaries; None where they did none."""
    total, work = total_energy(history), largest_work(history)
    return float(np.abs(total - total[0]).max()) / work if work > 0 else None


def released_before(history, time):
    """Largest fall of the energy that contacts store until a time [s], over K(0): what aggregates that do not start at
    rest set free by themselves. None where K(0) = 0."""
    unit, until = initial_kinetic_energy(history), history["time"] <= time
    if not unit > 0:
        return None
    stored = np.sum([history[name] for name in STORED_CHANNELS if name != "kinetic"], axis=0)[until]
    return float((stored[0] - stored.min()) / unit) if len(stored) else 0.0


def fractions(history, unit=None):
    """Change of every channel since the start over a unit [J] (K(0) if left out), by name, each (T,); of the kinetic
    channel itself, so that fractions of K(0) add up to 1 at all times. None where the unit is 0."""
    unit = initial_kinetic_energy(history) if unit is None else unit
    if not unit > 0:
        return None
    return {name: (history[name] - (0.0 if name == "kinetic" else history[name][0])) / unit for name in CHANNELS}


def fractions_at(history, time, unit=None):
    """fractions() at one time [s] within the record, linear between samples: a dict of floats, or None."""
    first, last = history["time"][0], history["time"][-1]
    if not first <= time <= last:
        raise ValueError(f"time = {time}: must be within the record, {first:g} to {last:g} s")
    parts = fractions(history, unit)
    return None if parts is None else {c: float(np.interp(time, history["time"], part)) for c, part in parts.items()}
