"""Samples a running collision into its run folder."""

import time

import numpy as np
from yade.wrapper import Omega

import contact_law
from yade_scripts.run_folder import CHANNELS, SERIES, STATE
from yade_scripts.sampling import compression_and_velocity

SECONDS_BETWEEN_WRITES = 10


class RunFailed(RuntimeError):
    """The simulation has gone wrong; the message is one line."""


class Recorder:
    """sample() takes one row of the history, and some states: for a PyRunner that is the last engine.

    aggregate: (N,) int, the aggregate of each body; aggregate_radius: R_agg [m] of A24 eq 10.
    An exception is kept in .error for the loop to find (YADE would print pages of it), never lost.
    """

    def __init__(self, folder, schedule, aggregate, aggregate_radius):
        self.folder, self.schedule = folder, schedule
        self.aggregate, self.aggregate_radius = aggregate, aggregate_radius
        self.error = None
        self.ending = False
        self._rows, self._states = [], 0
        self._last_good = None  # state of the last sample, unless it is written already
        self._next_write = time.monotonic() + SECONDS_BETWEEN_WRITES

    def rows(self):
        """The history so far, (T, columns), for a checkpoint."""
        return np.array(self._rows, dtype=float).reshape(-1, len(SERIES))

    def go_on(self, rows):
        """Have these rows, of a checkpoint, as the history so far; later states of the folder are taken away."""
        self._rows = [tuple(row) for row in rows.tolist()]
        self._states = sum(number < len(rows) for number in self.schedule.states)
        self.folder.keep_states(self._states)

    def sample(self):
        try:
            self._sample()
        except Exception as error:
            self.error = error
            self.write_last_good()

    def write_last_good(self):
        """After a failure: the state of the last sample that was in order, if it isn't written yet."""
        if self._last_good is not None:
            self._write_state(self._last_good)

    def write_history(self):
        """Write all samples so far."""
        series = dict(zip(SERIES, self.rows().T))
        for name in ("contacts", "contacts_between"):
            series[name] = series[name].astype(int)
        self.folder.write_history(series)

    def _sample(self):
        state = contact_law.snapshot()
        energies = dict(Omega().energy.items())
        energies = [energies.get(channel, 0.0) for channel in CHANNELS]  # none of it so far: no entry
        self._require_sane(state, energies)
        compression, velocity = compression_and_velocity(
            state["position"][:, 0], state["velocity"][:, 0], self.aggregate_radius
        )
        pairs = self.aggregate[state["contact_pairs"]]
        between = np.count_nonzero(pairs[:, 0] != pairs[:, 1])
        state["aggregate"] = self.aggregate
        number = len(self._rows)
        self._rows.append((state["time"], *energies, compression, velocity, len(pairs), between))
        self._last_good = state
        if self.ending or number in self.schedule.states:
            self._write_state(state)
        if time.monotonic() >= self._next_write:
            self.write_history()
            self._next_write = time.monotonic() + SECONDS_BETWEEN_WRITES

    def _write_state(self, state):
        self.folder.write_state(self._states, {name: state[name] for name in STATE})
        self._states += 1
        self._last_good = None

    def _require_sane(self, state, energies):
        """A run that blew up isn't worth its time: stop when the ledger is off by a tenth, or not finite."""
        when = f'at {state["time"]:.4g} s'
        for channel, energy in zip(CHANNELS, energies):
            if not np.isfinite(energy):
                raise RunFailed(f"energy {channel} is {energy} {when}")
        finite = np.isfinite(state["position"]).all(axis=1)
        if not finite.all():
            raise RunFailed(f'body {state["ids"][~finite][0]} has no finite position {when}')
        start = self._rows[0][1 : 1 + len(CHANNELS)] if self._rows else energies
        more, scale = sum(energies) - sum(start), sum(map(abs, start))
        if abs(more) > 0.1 * scale:
            raise RunFailed(
                f"energy is not conserved ({more:.3g} J more than at the start, of {scale:.3g} J) "
                f"{when}: the step is too long{suspects(state)}"
            )


def suspects(state):
    """What to look at in a state gone wrong: its fastest body and the contact that overlaps most, as a clause."""
    speed = np.linalg.norm(state["velocity"], axis=1)
    fastest = np.argmax(speed)
    text = f'; body {state["ids"][fastest]} is the fastest ({speed[fastest]:.4g} m/s)'
    first, second = state["contact_pairs"].T
    if not len(first):
        return text + ", and none touch any more"
    radius, position = state["radius"], state["position"]
    apart = np.linalg.norm(position[first] - position[second], axis=1)
    overlap = (radius[first] + radius[second] - apart) / np.minimum(radius[first], radius[second])
    deepest = np.argmax(overlap)
    return (
        f'{text}, the deepest contact is that of body {state["ids"][first[deepest]]} and body '
        f'{state["ids"][second[deepest]]} (overlap {overlap[deepest]:.4g} of the smaller radius)'
    )
