"""A collision on a device, as its host has it: scene, samples at which it is looked at, run folder. No YADE is needed.

on_device.py has processes of this file, each for many runs: they prepare, judge and write while the device computes."""

import time
from multiprocessing.connection import Connection
from typing import NamedTuple

import numpy as np

from analysis.measures.compression import of_sides
from analysis.runs.format import BROKEN_BONDS, CHANNELS, RESTING
from yade_scripts.experiments import collision
from yade_scripts.materials import pair_constants
from yade_scripts.run.ensemble import MATERIAL, MECHANISMS, SIDES, DeviceError, Grains
from yade_scripts.run.folder import RunFolder
from yade_scripts.run.kind import Schedule, derived
from yade_scripts.run.parameters import SPRINGS
from yade_scripts.run.script import record_of
from yade_scripts.time_step import require_countable

CHECKS = 20  # times in a run that it is looked whether pieces are apart


class Start(NamedTuple):
    """What a device needs of a run: arguments of ensemble.Collision, and steps until it is looked at."""

    grains: Grains
    options: dict
    steps: int


class Seen(NamedTuple):
    """What a device gives at such a sample: what ensemble.Collision has of these names."""

    motion: tuple
    contacts: tuple
    samples: dict


def mechanisms_of(parameters):
    """The sum of ensemble.MECHANISMS that a run has."""
    found = sum(MECHANISMS[name] for name in SPRINGS if getattr(parameters, name))
    return found + (MECHANISMS["drag"] if parameters.viscoelasticTime else 0)


class DeviceRun:
    """One collision under way; given: collision.CollisionParameters; made: versions, commit and device for run.json."""

    def __init__(self, given, made):
        self.begun = time.monotonic()
        self.scene = scene = collision.prepare(given, 1, pair_constants(given, neck=given.neck))
        self.given = given = scene.parameters
        require_countable(given.duration, scene.time_step)
        self.schedule = schedule = Schedule.of(given.duration, scene.time_step, scene.interval, states=given.states)
        self.record = record_of(collision.KIND.name, given.as_dict(), derived(scene, schedule), made)
        between = schedule.interval * scene.time_step
        checks = range(0, schedule.samples + 1, max(1, schedule.samples // CHECKS))[1:] if scene.rest else ()
        self.checks = {number for number in checks if number * between > scene.rest.earliest}
        self.stops = sorted(set(schedule.states) | self.checks | {schedule.samples})
        self.sample = self.states = 0
        self.resting = []  # (sample, time, 0 or 1)
        self.short = 0, schedule.interval  # samples that end with shorter steps, and how many those are
        if scene.shorter:
            self.short = scene.shorter.samples(between), scene.shorter.steps(schedule.interval)
        self.folder = RunFolder(given.out, given.overwrite)

    def start(self):
        samples, interval = self.short
        usual = self.scene.time_step, self.schedule.interval
        options = dict(
            steps=self._steps_until(self.schedule.samples),
            time_step=usual[0] * usual[1] / interval,
            interval=interval,
            change=(samples * interval, *usual),
            mechanisms=mechanisms_of(self.given),
            limit=self.given.limit,
            neck=self.given.neck,
            sliding_stiffness_factor=self.given.slidingStiffnessFactor,
            rolling_stiffness_factor=self.given.rollingStiffnessFactor,
            mixed_surface_energy_factor=self.given.mixedSurfaceEnergyFactor,
        )
        return Start(_grains(self.scene), options, self._steps_to_stop())

    def _steps_until(self, sample):
        short, interval = self.short
        return min(sample, short) * interval + max(0, sample - short) * self.schedule.interval

    def _steps_to_stop(self):
        return self._steps_until(self.stops[0]) - self._steps_until(self.sample)

    def look(self, seen):
        """What a sample at which the run has stopped is for; the steps until the next one, None when the run has come
        to its end and its folder is written."""
        self.sample = self.stops.pop(0)
        at_end, state = not self.stops, self._state(seen)
        if not np.isfinite(state["position"]).all():
            self.fail(f"positions are not finite at {state['time']:.4g} s")
        if self.sample in self.checks:
            self.resting.append((self.sample, state["time"], self.scene.rest.seems_so(state)))
            since = state["time"] - self.scene.rest.needed(state["time"])
            at_end |= all(rests for _, when, rests in self.resting if when >= since)
        if at_end or self.sample in self.schedule.states:
            self.folder.write_state(self.states, state)
            self.states += 1
        if not at_end:
            return self._steps_to_stop()
        self.folder.write_history(history := self._history(seen.samples))
        self._write_run("completed", float(history["time"][-1]))
        self.record["outcome"] = collision.KIND.ending(self.folder.path).outcome
        self._write_run("completed", float(history["time"][-1]))
        self.folder.write_ended()
        return None

    def fail(self, problem):
        """Note that the run has failed; raises DeviceError."""
        self._write_run(f"failed: {problem}", None)
        raise DeviceError(problem)

    def _write_run(self, status, reached):
        of_end = {"timeReached": reached, "wallTime": time.monotonic() - self.begun, "status": status}
        self.folder.write_run({**self.record, **of_end})

    def _state(self, seen):
        """The state at the latest sample, as contact_law.snapshot() has it, with the arrays of the scene's grains."""
        (position, velocity, spin), (pairs, force, bonded) = seen.motion, seen.contacts
        found = {"time": float(seen.samples["time"][-1]), "position": position, "velocity": velocity}
        radius = np.concatenate([packing.radius for packing in self.scene.placed[0]])
        found |= {"angular_velocity": spin, "radius": radius, **self.scene.grains}
        found |= {"contact_pairs": pairs, "contact_normal_force": force, "contact_bonded": bonded}
        if self.given.neck:
            found["contact_neck"] = np.where(bonded, self.given.neck, 0.0)
            found["bonds_broken"] = np.array([seen.samples[name][-1] for name in BROKEN_BONDS], dtype=int)
        return found

    def _history(self, samples):
        """history.npz of all samples."""
        sides = [samples[name] for name in SIDES]
        d, v = of_sides(sides[:3], sides[3:], self.given.radius * self.given.grainRadius)
        counts = ("contacts", "contacts_between", "formed", "broken", *(BROKEN_BONDS if self.given.neck else ()))
        found = {name: samples[name] for name in ("time", *CHANNELS)}
        found |= {"d": d, "v": v, **{name: samples[name].astype(int) for name in counts}}
        if self.scene.rest:
            found[RESTING] = np.full(len(d), np.nan)
            for number, _, rests in self.resting:
                found[RESTING][number] = rests
        return found


def _grains(scene):
    """Grains of a Scene of two packings."""
    pair, velocities = scene.placed
    each = scene.parameters.of_each()
    materials = [[getattr(own, name) for name in MATERIAL] for own in each]
    motions = [packing.motion(v, spin) for packing, v, spin in zip(pair, velocities, scene.parameters.spins)]
    return Grains(
        np.concatenate([packing.position for packing in pair]),
        np.concatenate([velocity for velocity, _ in motions]),
        np.concatenate([packing.radius for packing in pair]),
        np.array(materials),
        scene.grains.get("material"),
        scene.grains["aggregate"],
        np.concatenate([spin for _, spin in motions]),
    )


def serve(descriptor):
    """Answer the calls that come through one end of a multiprocessing.Pipe, until the other is closed.

    A call: number of a run, name of a method or "begin", its arguments. Its answer: what the method returns, or the
    exception that it raises. After None and an exception the run is over."""
    connection, runs = Connection(descriptor), {}
    while True:
        try:
            number, method, *arguments = connection.recv()
        except EOFError:
            break
        try:
            if method == "begin":
                runs[number] = DeviceRun(*arguments)
                answer = runs[number].start()
            else:
                answer = getattr(runs[number], method)(*arguments)
        except Exception as error:
            answer = error
        if (answer is None or isinstance(answer, Exception)) and number in runs:
            runs.pop(number).folder.close()
        connection.send(answer)
    for run in runs.values():
        run.folder.close()
