"""The run folder of a script of one's own, while it runs: what contact_law.record() gives."""

import atexit
import builtins
import functools
import signal
import socket
import sys
import threading
import time
from contextlib import suppress
from math import inf, pi
from types import SimpleNamespace

import numpy as np
import yade.wrapper as yade
from yade.wrapper import Omega

import contact_law
from analysis.runs.format import Quantity, RunKind, same
from yade_scripts.materials import MIXED_FACTOR, PROPERTIES, derived_grains, derived_materials
from yade_scripts.parameters import one_line
from yade_scripts.run import checkpoint
from yade_scripts.run import recorder as sampling
from yade_scripts.run.folder import RunFolder
from yade_scripts.run.kind import Schedule
from yade_scripts.run.script import made_with, record_of

KIND = "script"
SAVE = "from yade_scripts.run import recorder; recorder.current.save()"
OF_EVERY_RUN = {quantity.name for quantity in RunKind(KIND, ()).history}


class Recording(sampling.Recorder):
    """Writes the run folder until end(); its arguments are those of contact_law.record()."""

    def __init__(self, folder, every, series, states, parameters, aggregate, interval, overwrite, resume):
        for name, value in (("every", every), ("states", states)):
            if not isinstance(value, int) or value < 1:
                raise ValueError(f"{name} = {value!r}: must be a whole number >= 1")
        if series is not None and not callable(series):
            raise TypeError(f"series = {series!r}: must be a function that returns {{name: number}}")
        self._series, self._aggregate = series, aggregate or (lambda body: 0)
        self._described, self._materials, self._begun = None, [], time.monotonic()
        self._signals = None
        plain = {"grains": {}, "control": lambda recorder, state: False, "energy_is_conserved": False}
        own = SimpleNamespace(series=self._own, **plain)
        schedule = Schedule(0, every, range(0, sys.maxsize, states))
        super().__init__(None, schedule, RunKind(KIND, ()), own)
        self._next_write = 0.0  # the first row is written at once
        self.run = self._record(parameters or {})
        self.folder = RunFolder(str(folder), overwrite, resume)
        wall_time = lambda: time.monotonic() - self._begun
        self._writer = checkpoint.CheckpointWriter(self.folder, self.run, self, wall_time, interval)
        try:
            if self.folder.checkpoint:
                self._go_on(self.folder.checkpoint)
            else:
                self._begin()
        except BaseException:
            self.folder.close()
            sampling.current = None
            raise
        self._write_run("running")

    def end(self, status="completed"):
        """Write the last state, and that the run has come to its end, or what else became of it."""
        if sampling.current is not self:
            return
        omega = Omega()
        omega.pause()
        while omega.running and threading.current_thread() is threading.main_thread():
            time.sleep(0.001)
        status = f"failed: {one_line(self.error)}" if self.error else status
        if self.columns and status == "interrupted":
            self._writer.save()  # before the state of the last row, which an uninterrupted run would not have
            print(f"{self.folder.path}: stopped at {omega.time:.4g} s; with resume=True the script goes on", flush=True)
        self.write_last_good()
        if self.columns:
            self.write_history()
        self._write_run(status)
        if status == "completed":
            self.folder.write_ended()
            self.folder.remove_checkpoint()
        self.folder.close()
        sampling.current = None
        omega.engines = [engine for engine in omega.engines if not _is_ours(engine)]

    def sample(self):
        """A row of the history. What goes wrong stops the loop, and O.run(..., True) raises it."""
        super().sample()
        if self.error or self._is_signalled():
            Omega().pause()

    def save(self):
        """A checkpoint, at the beginning of a step."""
        try:
            if self.columns:
                self._writer.save()
                self.write_history()
        except (OSError, RuntimeError) as error:
            self.error = error
            Omega().pause()

    def with_runners(self, engines):
        """The engines, and PyRunners for checkpoints (first) and rows (last)."""
        others = [engine for engine in engines if not _is_ours(engine)]
        before = [engine for engine in Omega().engines if getattr(engine, "command", None) == sampling.COMMAND]
        # The fused engine's row is of the end of a step, that of YADE's own loop of its beginning.
        if before:
            last = before[0].iterLast + _is_fused(Omega().engines)
        else:
            last = Omega().iter - (0 if _is_fused(others) else self.schedule.interval)
        saver = yade.PyRunner(command=SAVE, realPeriod=self._writer.interval)
        steps = {"iterPeriod": self.schedule.interval, "iterLast": last - _is_fused(others), "nDone": 1}
        return [saver, *others, yade.PyRunner(command=sampling.COMMAND, **steps)]

    def _begin(self):
        omega = Omega()
        omega.trackEnergy = True
        engines = self.with_runners(omega.engines)
        self._listen()
        omega.engines = engines
        for engine in _fused(engines):
            engine.prepare()
            self.sample()
        if self.error:
            raise self.error

    def _go_on(self, saved):
        saved.require(self._difference(saved), made_with(), inf, ended=False)
        self.folder.resume()
        self.run["derived"] = saved.run["derived"]
        if several := saved.run["derived"].get("materials"):
            self._materials = [self._material_of(**own) for own in several]
        self._begun -= saved.wallTime
        self.resume(saved.rows, saved.columns, saved.states)
        threads = [engine.threads for engine in _fused(Omega().engines)]
        Omega().load(f"{self.folder.path}/{saved.scene}", True)
        for engine, number in zip(_fused(Omega().engines), threads):
            engine.threads = number
        self._listen()

    def _difference(self, saved):
        """The first thing in which the script is not that of a checkpoint, or None."""
        if saved.interval != self.schedule.interval:
            return f"every = {saved.interval}, not {self.schedule.interval}"
        there, here = saved.run["parameters"], self.run["parameters"]
        differing = [name for name in {**there, **here} if not same(there.get(name), here.get(name))]
        return next((f"{name} = {there.get(name)}, not {here.get(name)}" for name in differing), None)

    # ---- what is written ----

    def _snapshot(self):
        state = super()._snapshot()
        described = np.append(contact_law.scene.material_changes, state["ids"])
        if not np.array_equal(described, self._described):
            self._described, known = described, len(self._materials)
            self._of_grains = self._arrays([Omega().bodies[int(number)] for number in state["ids"]], state["radius"])
            if len(self._materials) > known:
                self.run["derived"] |= derived_materials(self._materials)
                self._write_run("running")
        # at the moment of the forces
        edges = np.array(Omega().cell.prevHSize) if Omega().periodic else np.zeros((3, 3))
        sheared = {"cell_vectors": edges} if np.any(edges - np.diag(np.diag(edges))) else {}
        return {**state, **self._of_grains, **sheared}

    def _arrays(self, bodies, radius):
        """Arrays (N,) of the bodies: aggregate; with several materials, or masses of a script, material and mass."""
        kinds = np.array([self._material(body.material) for body in bodies], dtype=np.int32)
        mass = np.array([body.state.mass for body in bodies])
        aggregate = np.array([self._aggregate(body) for body in bodies], dtype=np.int32)
        density = np.array([own.density for own in self._materials])[kinds]
        if len(self._materials) == 1 and np.allclose(mass, 4 / 3 * pi * density * radius**3, rtol=1e-6, atol=0):
            return {"aggregate": aggregate}
        return {"aggregate": aggregate, "material": kinds, "mass": mass}

    def _material(self, material):
        """The number of a grain's material among those that were met so far."""
        if not isinstance(material, yade.JKRMat):
            raise sampling.RunFailed(f"a grain's material is a {type(material).__name__}; must be JKRMat")
        properties = {name: getattr(material, name) for name in PROPERTIES}
        own = self._material_of(material.label or "JKRMat", **properties)
        if own not in self._materials:
            self._materials.append(own)
        return self._materials.index(own)

    def _material_of(self, name, **properties):
        every = {"grainRadius": self._radius, MIXED_FACTOR: _mixed_factor(Omega().engines)}
        return SimpleNamespace(material=name, **every, **properties)

    def _own(self, state):
        """The script's series, whose names are those of the first row."""
        found = self._series() if self._series else {}
        if self.columns is None:
            if known := OF_EVERY_RUN & set(found):
                raise ValueError(f"series: {min(known)}: every run has it; must be another name")
            self.history = RunKind(KIND, tuple(Quantity(name, ("T",), "", "") for name in found)).history
        elif missing := {name for name in self.columns if name not in OF_EVERY_RUN} - set(found):
            raise ValueError(f"series: {min(missing)} is missing; must be there as in the first row")
        return {name: float(value) for name, value in found.items()}

    def _record(self, parameters):
        """run.json, but for what changes while the run is under way."""
        grains = [body for body in Omega().bodies if isinstance(body.shape, yade.Sphere)]
        if not grains or not any(map(_has_the_law, Omega().engines)):
            raise ValueError("record(): no spheres, or no engines with this contact law; must come after both")
        radius, made_of = np.array([body.shape.radius for body in grains]), grains[0].material
        self._radius = float(np.median(radius))
        self._arrays(grains, radius)
        names = [own.material for own in self._materials]
        first = SimpleNamespace(**vars(self._materials[0]), viscoelasticTime=made_of.viscoelasticTime)
        constants = yade.Ip2_JKRMat_JKRMat_JKRWadaPhys().pairConstants(*2 * (made_of, self._radius))
        fused = [engine.subSteps for engine in _fused(Omega().engines)]
        derived = derived_grains([first, *self._materials[1:]], constants)
        derived["timeStep"] = Omega().dt / (fused[0] if fused else 1)
        every = {
            "material": ",".join(names),
            "grains": len(grains),
            "grainRadius": self._radius,
            "surfaceEnergy": None if len(names) > 1 else first.surfaceEnergy,
            "engine": "fused" if fused else "functors",
        }
        plain = {name: value.item() if isinstance(value, np.generic) else value for name, value in parameters.items()}
        return record_of(KIND, {**every, **plain}, derived, made_with())

    def _write_run(self, status):
        reached = {"wallTime": time.monotonic() - self._begun, "timeReached": self.time, "status": status}
        self.folder.write_run({**self.run, **reached})

    # ---- how it learns that the script ends ----

    def _listen(self):
        """From now on O.engines, O.run() and the end of the script are heard of."""
        _hook()
        sampling.current = self
        if signal.getsignal(signal.SIGTERM) == signal.SIG_DFL:
            signal.signal(signal.SIGTERM, _terminated)
        # Python's own handlers wait for O.run(..., True) to return: sample() looks here, and has it return.
        self._signals, writing = socket.socketpair()
        for end in (self._signals, writing):
            end.setblocking(False)
        self._writing = writing
        signal.set_wakeup_fd(writing.fileno(), warn_on_full_buffer=False)

    def _is_signalled(self):
        with suppress(BlockingIOError):
            return bool({signal.SIGINT, signal.SIGTERM} & set(self._signals.recv(100)))
        return False


def _is_ours(engine):
    return getattr(engine, "command", None) in (SAVE, sampling.COMMAND)


def _fused(engines):
    return [engine for engine in engines if isinstance(engine, yade.JKRWadaEngine) and not engine.dead]


def _is_fused(engines):
    return bool(_fused(engines))


def _mixed_factor(engines):
    """That of the fused engine, or of the functor that makes contacts."""
    functors = [f for engine in engines if hasattr(engine, "physDispatcher") for f in engine.physDispatcher.functors]
    return next((getattr(of, MIXED_FACTOR) for of in (*_fused(engines), *functors) if hasattr(of, MIXED_FACTOR)), 1.0)


def _has_the_law(engine):
    dispatcher = getattr(engine, "lawDispatcher", None)
    functors = dispatcher.functors if dispatcher else ()
    return isinstance(engine, yade.JKRWadaEngine) or any(
        isinstance(functor, yade.Law2_ScGeom_JKRWadaPhys_JKRWada) for functor in functors
    )


def _terminated(number, _frame):
    _end("interrupted")
    raise SystemExit(128 + number)


def _end(status):
    if isinstance(sampling.current, Recording):
        sampling.current.end(status)


@functools.cache
def _hook():
    """O.engines = ... keeps the PyRunners, O.run() and the like raise what a row has met, O.resetTime() is refused, and
    sys.exit(), which YADE calls after a script or its exception, ends the recording, as exit() and quit() do."""
    engines, leave, reset = Omega.engines, sys.exit, Omega.resetTime

    def replace(omega, others):
        recording = sampling.current
        engines.fset(omega, recording.with_runners(others) if isinstance(recording, Recording) else others)

    def raising(call):
        @functools.wraps(call, assigned=("__doc__", "__name__"))
        def called(*arguments, **named):
            answer = call(*arguments, **named)
            if isinstance(sampling.current, Recording) and sampling.current.error:
                raise sampling.current.error
            return answer

        return called

    def reset_or_raise(omega):
        if isinstance(sampling.current, Recording):
            raise RuntimeError("O.resetTime(): a run is being recorded; must come before record() or after its end()")
        reset(omega)

    def end_and_leave(code=None):
        error = sys.exc_info()[1]
        if isinstance(error, KeyboardInterrupt):
            _end("interrupted")
        elif error or code:
            _end(f"failed: {one_line(error) if error else f'exit status {code}'}")
        else:
            _end("completed")
        leave(code)

    Omega.engines = property(engines.fget, replace, doc=engines.__doc__)
    for name in ("run", "step", "wait"):
        setattr(Omega, name, raising(getattr(Omega, name)))
    Omega.resetTime = reset_or_raise
    sys.exit = builtins.exit = builtins.quit = end_and_leave
    atexit.register(_end, "completed")
