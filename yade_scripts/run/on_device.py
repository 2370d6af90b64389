"""Collisions of a table on a GPU, or by the same code on a processor: batches, and a run folder of each as YADE's runs
leave it. No YADE is needed.

Many collisions start together, each with its own step and length, and come back at the samples that become states, or
at which it is looked whether they are at rest. A run on a device has no checkpoints: one that was stopped starts
again."""

import sys
import time
from dataclasses import dataclass, field

import numpy as np

from analysis.measures.compression import of_sides
from analysis.runs.files import RunFolderError
from analysis.runs.format import BROKEN_BONDS, CHANNELS, RESTING
from analysis.version import commit, version
from yade_scripts.experiments import collision
from yade_scripts.materials import pair_constants
from yade_scripts.parameters import InputError, one_line
from yade_scripts.run.ensemble import (
    DEVICE,
    MATERIAL,
    MECHANISMS,
    PROCESSOR,
    SIDES,
    Collision,
    DeviceError,
    Grains,
    Library,
)
from yade_scripts.run.folder import RunFolder
from yade_scripts.run.kind import Schedule, derived
from yade_scripts.run.parameters import SPRINGS
from yade_scripts.run.script import record_of
from yade_scripts.time_step import require_countable

LIBRARIES = {"gpu": DEVICE, "processor": PROCESSOR}
BATCH = 400  # collisions at once: each holds its folder, and a process may have 1,024 files open
CHECKS = 20  # times in a run that it is looked whether pieces are apart


def library_of(device):
    """The Library of a device, a name of LIBRARIES. Raises InputError."""
    file = LIBRARIES[device]
    if not file.exists():
        raise InputError(f"--device {device}: {file} is not built; must be made first (make gpu; make for a processor)")
    try:
        library = Library(file)
    except OSError as error:
        raise InputError(f"--device {device}: {one_line(error)}; must be a machine with that device") from None
    if not library.device:
        raise InputError(f"--device {device}: none found; must be a machine with that device")
    return library


def why_not(parameters, library):
    """Why a run of these collision.CollisionParameters can't run on a device, or None."""
    reasons = {
        "engine = functors": parameters.engine != "fused",
        "a plate": parameters.target == collision.WALL,
        "planar = 1": bool(parameters.planar),
        "impactStepFraction": parameters.impactStepFraction is not None,
        "these springs": not library.runs(_mechanisms(parameters)),
    }
    return next((reason for reason, given in reasons.items() if given), None)


def _mechanisms(parameters):
    found = sum(MECHANISMS[name] for name in SPRINGS if getattr(parameters, name))
    return found + (MECHANISMS["drag"] if parameters.viscoelasticTime else 0)


def run(parameters, library, stop=None, progress=lambda ended: None):
    """Run collisions and write their folders; {number in `parameters`: why it failed, in a line}.

    parameters: list of collision.CollisionParameters; stop: script.StopSignals, after a signal the runs that are under
    way are left as they are; progress(ended): called with the number of runs that have come to their end since."""
    waiting, failed = list(enumerate(parameters))[::-1], {}
    while waiting and not (stop and stop.received):
        batch = []
        try:
            while waiting and len(batch) < BATCH:
                number, given = waiting.pop()
                try:
                    batch.append(_Run(number, given, library))
                except (InputError, RunFolderError, OSError, ValueError) as error:
                    failed[number] = one_line(error)
                    progress(1)
                except DeviceError as error:  # no memory for one more: the batch is full
                    if not batch:
                        failed[number] = one_line(error)
                        progress(1)
                        continue
                    waiting.append((number, given))
                    break
            failed |= _carry_out(batch, library, stop, progress)
        finally:
            for one in batch:
                one.folder.close()
    return failed


def _carry_out(batch, library, stop, progress):
    """Bring a batch to its end; {number: why it failed}."""
    failed, active = {}, list(batch)
    while active and not (stop and stop.received):
        try:
            library.run([one.collision for one in active], [one.steps_to_stop for one in active])
        except DeviceError as error:  # the device is lost, and all that was on it
            return failed | {one.number: one.end(f"failed: {one_line(error)}") for one in active}
        for one in list(active):
            try:
                status = one.look()
                if status is None:
                    continue
                problem = one.end(status)
            except (OSError, RunFolderError) as error:
                problem = f"failed: {one_line(error)}"
            if problem:
                failed[one.number] = problem.removeprefix("failed: ")
            active.remove(one)
            progress(1)
    return failed


@dataclass
class _Run:
    """One collision under way."""

    number: int
    given: object
    library: Library
    states: int = 0
    resting: list = field(default_factory=list)  # (sample, time, 0 or 1)

    def __post_init__(self):
        self.begun = time.monotonic()
        constants = pair_constants(self.given, neck=self.given.neck)
        self.scene = scene = collision.prepare(self.given, 1, constants)
        given = scene.parameters
        require_countable(given.duration, scene.time_step)
        self.schedule = schedule = Schedule.of(given.duration, scene.time_step, scene.interval, states=given.states)
        self.folder = RunFolder(given.out, given.overwrite)
        try:
            self._start(scene, schedule)
        except BaseException:
            self.folder.close()
            raise

    def _start(self, scene, schedule):
        given = scene.parameters
        self.collision = Collision(
            self.library,
            _grains(scene),
            schedule.steps,
            scene.time_step,
            schedule.interval,
            mechanisms=_mechanisms(given),
            limit=given.limit,
            neck=given.neck,
            sliding_stiffness_factor=given.slidingStiffnessFactor,
        )
        made = {"versions": {"contact_law": version(), "python": sys.version.split()[0], "numpy": np.__version__}}
        made |= {"commit": commit(), "device": self.library.device}
        self.record = record_of(collision.KIND.name, given.as_dict(), derived(scene, schedule), made)
        between = schedule.interval * scene.time_step
        checks = range(0, schedule.samples + 1, max(1, schedule.samples // CHECKS))[1:] if scene.rest else ()
        self.checks = {number for number in checks if number * between > scene.rest.earliest}
        self.stops = sorted(set(schedule.states) | self.checks | {schedule.samples})
        self.sample = 0

    @property
    def steps_to_stop(self):
        """Steps until the next sample at which it is looked at."""
        return (self.stops[0] - self.sample) * self.schedule.interval

    def look(self):
        """What a sample at which the run has stopped is for; the status if it has come to its end, or None."""
        self.sample = self.stops.pop(0)
        self.collision.read()
        if self.collision.failure:
            return f"failed: {self.collision.failure}"
        at_end, state = not self.stops, self._state()
        if not np.isfinite(state["position"]).all():
            return f"failed: positions are not finite at {state['time']:.4g} s"
        if self.sample in self.checks:
            self.resting.append((self.sample, state["time"], self.scene.rest.seems_so(state)))
            since = state["time"] - self.scene.rest.needed(state["time"])
            at_end |= all(rests for _, when, rests in self.resting if when >= since)
        if at_end or self.sample in self.schedule.states:
            self.folder.write_state(self.states, state)
            self.states += 1
        return "completed" if at_end else None

    def _state(self):
        """The state at the latest sample, as contact_law.snapshot() has it, with the arrays of the scene's grains."""
        position, velocity, spin = self.collision.motion()
        pairs, force, bonded = self.collision.contacts()
        time = self.collision.step * self.scene.time_step
        found = {"time": time, "position": position, "velocity": velocity}
        found |= {"angular_velocity": spin, "radius": self.collision.radius, **self.scene.grains}
        found |= {"contact_pairs": pairs, "contact_normal_force": force, "contact_bonded": bonded}
        if self.scene.parameters.neck:
            found["contact_neck"] = np.where(bonded, self.scene.parameters.neck, 0.0)
            samples = self.collision.samples()
            found["bonds_broken"] = np.array([samples[name][-1] for name in BROKEN_BONDS], dtype=int)
        return found

    def end(self, status):
        """Write what is left; the status if it failed, or None."""
        self.record["timeReached"] = None
        if self.collision.failure is None and status == "completed":
            history = self._history()
            self.record["timeReached"] = float(history["time"][-1])
            self.folder.write_history(history)
        write = lambda: self.folder.write_run(
            {**self.record, "wallTime": time.monotonic() - self.begun, "status": status}
        )
        write()
        if status != "completed":
            return status
        self.record["outcome"] = collision.KIND.ending(self.folder.path).outcome
        write()
        self.folder.write_ended()
        return None

    def _history(self):
        """history.npz of all samples."""
        samples, given = self.collision.samples(), self.scene.parameters
        sides = [samples[name] for name in SIDES]
        d, v = of_sides(sides[:3], sides[3:], given.radius * given.grainRadius)
        counts = ("contacts", "contacts_between", "formed", "broken", *(BROKEN_BONDS if given.neck else ()))
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
