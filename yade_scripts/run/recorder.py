"""Samples a running scene into its run folder."""

import time
from contextlib import suppress
from math import isfinite

import numpy as np
from yade.wrapper import JKRWadaEngine, Omega

import contact_law
from analysis.runs.format import BROKEN_BONDS, CHANNEL_TABLE, CHANNELS, STATE, WORK

SECONDS_BETWEEN_WRITES = 10
LARGEST_LEDGER_ERROR = 0.1  # of the energies at the start and the work done since: beyond, a run isn't worth its time
WORK_CHANNELS = [channel.name for channel in CHANNEL_TABLE if channel.kind == WORK]

# What the PyRunner of a scene runs, in YADE's main namespace, and the Recorder that samples it.
COMMAND = "from yade_scripts.run import recorder; recorder.current.sample()"
current = None


class RunFailed(RuntimeError):
    """The simulation can't be continued; the message is one line."""


def engine_counts():
    """statistics() of the fused engine; of YADE's own loop, the broken bonds by mode alone."""
    for engine in Omega().engines:
        if isinstance(engine, JKRWadaEngine):
            return engine.statistics()
        dispatcher = getattr(engine, "lawDispatcher", None)
        if dispatcher:
            return {name: getattr(dispatcher.functors[0], name) for name in BROKEN_BONDS}
    return {}


class Recorder:
    """sample() takes one row of the history, and some states: for a PyRunner that is the last engine.

    kind_format: a RunKind, which names the columns; scene: a run.kind.Scene, at whose end .finished becomes true.
    Optional series are those that are there at the first sample; broken bonds by mode are in states that have bonds.
    An exception is kept in .error for the loop to find (YADE would print pages of it)."""

    def __init__(self, folder, schedule, kind_format, scene):
        self.folder, self.schedule, self.scene = folder, schedule, scene
        self.history, self.states = kind_format.history, STATE
        self.columns = None  # until the first sample, or those of the checkpoint
        self.error = None
        self.ending = self.finished = False
        self._rows, self.states_written = [], 0
        self._last_good = None  # state of the last sample, unless it is written already
        self._next_write = time.monotonic() + SECONDS_BETWEEN_WRITES

    def rows(self):
        """The history so far, (T, columns), for a checkpoint."""
        return np.array(self._rows, dtype=float).reshape(-1, len(self.columns or self.history))

    @property
    def time(self):
        """Time [s] of the last sample; None before the first."""
        return self._rows[-1][0] if self._rows else None

    def is_one_of(self, times):
        """Whether the last sample is one of so many, spread evenly over the run; the first is none of them."""
        return len(self._rows) > 1 and (len(self._rows) - 1) % max(1, self.schedule.samples // times) == 0

    def recent(self, name, duration=0.0):
        """(K,) values of a column over the last `duration` [s], the last sample always."""
        time, column = self.columns.index("time"), self.columns.index(name)
        since, values = self._rows[-1][time] - duration, []
        for row in reversed(self._rows):
            if values and row[time] < since:
                break
            values.append(row[column])
        return np.array(values[::-1])

    def note(self, name, value):
        """Have a value in the last sample's place of a column."""
        row = list(self._rows[-1])
        row[self.columns.index(name)] = value
        self._rows[-1] = tuple(row)

    def resume(self, rows, columns, states):
        """Have these rows, of a checkpoint, as the history so far, and so many states as written."""
        self.columns = list(columns)
        self._rows = [tuple(row) for row in rows.tolist()]
        self.states_written = states

    def sample(self):
        try:
            self._sample()
        except Exception as error:
            self.error = error
            self.write_last_good()

    def write_last_good(self):
        """After a failure: the state of the last sample that was in order, if it isn't written yet and can be."""
        if self._last_good is not None:
            with suppress(OSError):
                self._write_state(self._last_good)

    def write_history(self):
        """Write all samples so far."""
        series = dict(zip(self.columns or [quantity.name for quantity in self.history], self.rows().T))
        whole = [quantity.name for quantity in self.history if quantity.kind == "i" and quantity.name in series]
        self.folder.write_history({**series, **{name: series[name].astype(int) for name in whole}})

    def _snapshot(self):
        return {**contact_law.snapshot(), **self.scene.grains}

    def _sample(self):
        state = self._snapshot()
        if self._rows and state["time"] <= self.time:  # an engine was replaced by one whose rows are a step behind
            return
        booked = dict(Omega().energy.items())
        energies = {channel: booked.get(channel, 0.0) for channel in CHANNELS}  # none of it so far: no entry
        self._require_sound(state, energies)
        contacts = len(state["contact_pairs"])
        counts = engine_counts()
        if state["contact_bonded"].any() or BROKEN_BONDS[0] in (self.columns or ()):
            state["bonds_broken"] = np.array([counts[name] for name in BROKEN_BONDS])
        else:
            state.pop("contact_neck")
            counts = {name: count for name, count in counts.items() if name not in BROKEN_BONDS}
        sample = {**counts, "time": state["time"], **energies, "contacts": contacts, **self.scene.series(state)}
        if self.columns is None:
            self.columns = [q.name for q in self.history if not q.optional or q.name in sample]
        number = len(self._rows)
        self._rows.append(tuple(sample[name] for name in self.columns))
        self._last_good = state
        self.finished = bool(self.scene.control(self, state))
        if self.ending or self.finished or number in self.schedule.states:
            self._write_state(state)
        if time.monotonic() >= self._next_write:
            self.write_history()
            self._next_write = time.monotonic() + SECONDS_BETWEEN_WRITES

    def _write_state(self, state):
        there = [quantity.name for quantity in self.states if not quantity.optional or quantity.name in state]
        self.folder.write_state(self.states_written, {name: state[name] for name in there})
        self.states_written += 1
        self._last_good = None

    def _require_sound(self, state, energies):
        """Raise RunFailed when a number is not finite, or the ledger of all channels is off by a tenth."""
        when = f'at {state["time"]:.4g} s'
        for channel, energy in energies.items():
            if not isfinite(energy):
                raise RunFailed(f"energy {channel} is {energy} {when}")
        finite = np.isfinite(state["position"])
        if not finite.all():
            raise RunFailed(f'body {state["ids"][~finite.all(axis=1)][0]} has no finite position {when}')
        if not self.scene.energy_is_conserved:
            return
        first = dict(zip(self.columns, self._rows[0])) if self._rows else energies
        start = {channel: first[channel] for channel in CHANNELS}
        more = sum(energies.values()) - sum(start.values())
        scale = sum(map(abs, start.values())) + sum(abs(energies[name] - start[name]) for name in WORK_CHANNELS)
        if abs(more) > LARGEST_LEDGER_ERROR * scale:
            speed = np.linalg.norm(state["velocity"], axis=1)
            fastest = np.argmax(speed)
            raise RunFailed(
                f"energy is not conserved ({more:.3g} J more than at the start, of {scale:.3g} J) {when}: the step is "
                f"too long; body {state['ids'][fastest]} is the fastest ({speed[fastest]:.4g} m/s)"
            )
