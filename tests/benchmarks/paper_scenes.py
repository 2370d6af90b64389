"""The scenes of the papers: their grains, and the moments of their runs at which speed is measured. Needs no YADE.

A scene is what a run of collide.py or compress.py starts from. Later moments are reached by the harness (harness/) and kept in scene files, with the springs
of all contacts, in build/bench/scenes: made once, they serve every version of the engine. A moment's file is made again when the scene's definition changes.
"""

import hashlib
import json
import subprocess
from dataclasses import dataclass, field, replace
from math import ceil, log

import numpy as np
import scene_file
from measured_on import TOP

from analysis.measures.virial import filling_factor
from yade_scripts import packings
from yade_scripts.experiments import collision, compression
from yade_scripts.materials import pair_constants
from yade_scripts.packings.approach import first_touch
from yade_scripts.packings.periodic import smallest_edge

HARNESS = TOP / "build/harness"
FOLDER = TOP / "build/bench/scenes"
FAST_STRAIN = 1e-5  # 1/t0: at which the denser cells are made
RELAXED = 3000.0  # t0 at the paper's own rate before a denser cell is measured, in which vibrations and slips that the fast making left die down
START = "start"


@dataclass(frozen=True)
class PaperScene:
    """title, in words; kind: collision or compression; parameters of the run, as tables have them; moments: {name: time [s] or filling
    factor}, in their order (None: the start); apart: time [s] by which the first moment of a collision is moved back along straight lines, for a flight long
    enough to measure; lammps: whether it can run the grains."""

    title: str
    kind: str
    parameters: dict
    moments: dict
    apart: float = 0.0
    lammps: bool = True

    def names(self):
        return list(self.moments)


A22 = {"packing": "bpca", "grains": 50_000, "impact": "(3/12)**0.5", "velocity": "10**1.7", "stepFraction": 0.2}
A22.update(duration="6.34e-6", viscoelasticTime="0")
OF_A22 = {"flying": 0.0, "compressing": 0.35e-6, "fragments": 0.7e-6, "later": 2e-6}
K13 = {"grains": 16_384, "strainRate": "3e-7", "stepFraction": 0.3, "finalFilling": 0.3}
DENSE = {"phi 0.03": 0.03, "phi 0.3": 0.3}
CPE = {"packing": "cpe", "filling": 0.4, "stepFraction": 0.1}
SCENES = {
    "a22": PaperScene("A22: two BPCA of 50,000 at 50.1 m/s, B_off 0.5", "collision", A22, OF_A22, apart=0.5e-6),
    "a22-drag": PaperScene(
        "A22: the same, T_vis 6 ps", "collision", {**A22, "viscoelasticTime": "6e-12"}, OF_A22, apart=0.5e-6
    ),
    "a22-slow": PaperScene(
        "A22: the same grains at 0.5 m/s, T_vis 0", "collision", {**A22, "velocity": 0.5}, {"flying": 0.0}, apart=0.5e-6
    ),
    "k13": PaperScene("K13: BCCA of 16,384, C_v 3e-7", "compression", K13, {"phi 0.001": 0.001, **DENSE}),
    "k13-1024": PaperScene(
        "K13: BCCA of 1,024, C_v 3e-7", "compression", {**K13, "grains": 1024}, {START: None, **DENSE}
    ),
    "s17": PaperScene(
        "S17: 2 x 1,024 planar BCCA, beta 0.7, 20 m/s",
        "collision",
        {"packing": "bcca", "grains": 1024, "planar": 1, "neck": 0.7, "velocity": 20, "stepFraction": 0.1},
        {"flying": 0.0, "touching": 0.5e-6, "later": 1.5e-6},
        apart=0.3e-6,
        lammps=False,  # no sintered bonds
    ),
    "a24": PaperScene(
        "A24: two CPE, R 80, 3.16 m/s",
        "collision",
        {**CPE, "radius": 80, "velocity": "10**0.5"},
        {"flying": 0.0, "compressed": 0.4e-6, "apart": 0.8e-6},
        apart=0.1e-6,
    ),
    "cpe-fast": PaperScene(
        "two CPE, R 20, 60 m/s",
        "collision",
        {**CPE, "radius": 20, "velocity": 60, "duration": "120e-9"},
        {"flying": 0.0, "compressing": 30e-9, "fragments": 110e-9},
        apart=0.2e-6,
    ),
    "cpe": PaperScene(
        "two CPE, R 40, 3.16 m/s",
        "collision",
        {**CPE, "radius": 40, "velocity": "10**0.5"},
        {"flying": 0.0, "compressed": 0.2e-6},
        apart=0.1e-6,
    ),
}


@dataclass(frozen=True)
class Start:
    """A run's beginning: the scene, its duration [s], t0 [s], small steps in an O.step, and how far along (0: its beginning, 1: its end) each moment is."""

    scene: scene_file.SceneFile
    duration: float
    time_unit: float
    together: int
    progress: dict = field(default_factory=dict)

    @property
    def steps(self):
        """Small steps of the whole run."""
        return ceil(self.duration / float(self.scene.head["step"]))


def start_of(scene):
    """Start of a PaperScene's run."""
    return {"collision": _collision, "compression": _compression}[scene.kind](scene)


def _collision(scene):
    parameters = collision.CollisionParameters.parse(scene.parameters)
    constants = pair_constants(parameters)
    parameters, pair, velocities = collision.place(parameters, constants["equilibriumOverlap"])
    touch = first_touch(*pair, velocities[1] - velocities[0])
    time_unit = constants["timeUnit"]
    parameters = collision.with_duration(parameters, time_unit, touch)
    made = scene_file.start(
        np.concatenate([packing.position for packing in pair]),
        np.repeat(velocities, [packing.grains for packing in pair], axis=0),
        np.concatenate([packing.radius for packing in pair]),
        parameters,
        parameters.stepFraction * time_unit,
        neck=parameters.neck,
        planar=bool(parameters.planar),
    )
    progress = {name: time / parameters.duration for name, time in scene.moments.items()}
    return Start(made, parameters.duration, time_unit, 50, progress)


def _compression(scene):
    parameters = compression.CompressionParameters.parse(scene.parameters)
    constants = pair_constants(parameters)
    time_unit = constants["timeUnit"]
    cluster = packings.bcca(parameters.grains, parameters.grainRadius, constants["equilibriumOverlap"], parameters.seed)
    edge = smallest_edge(cluster)
    first = filling_factor(cluster.radius, np.full(3, edge))
    made = scene_file.start(
        cluster.position,
        np.zeros_like(cluster.position),
        cluster.radius,
        parameters,
        parameters.stepFraction * time_unit,
        linear_damping=parameters.linearDamping,
        edge=edge,
    ).with_strain_rate(-2 * parameters.strainRate / time_unit)
    whole = log(parameters.finalFilling / first)
    fillings = {name: filling or first for name, filling in scene.moments.items()}
    progress = {name: log(filling / first) / whole for name, filling in fillings.items()}
    duration = whole * time_unit / (6 * parameters.strainRate)
    return Start(made, duration, time_unit, compression._interval(parameters), progress)


def filling_of(scene):
    """Volume filling factor of a periodic SceneFile."""
    return filling_factor(scene.grains["radius"], scene.head["cellSize"])


# ---- moments ----


def path_of(name, moment, scene=None, folder=FOLDER):
    """File of a moment of a scene; its name changes with the scene's definition."""
    scene = scene or SCENES[name]
    made = [FAST_STRAIN, RELAXED] if scene.kind == "compression" else [scene.apart]
    definition = json.dumps([scene.kind, scene.parameters, scene.moments, *made, scene_file.FORMAT], sort_keys=True)
    key = hashlib.sha256(definition.encode()).hexdigest()[:8]
    return folder / f"{name}-{moment.replace(' ', '')}-{key}.scene"


def make(name, scene=None, folder=FOLDER, say=print):
    """Start of a scene, whose moments all have their files afterwards; what is there is not made again. scene: SCENES[name] when left out."""
    scene = scene or SCENES[name]
    begin = start_of(scene)
    paths = [path_of(name, moment, scene, folder) for moment in scene.moments]
    if all(path.exists() for path in paths):
        return begin
    folder.mkdir(parents=True, exist_ok=True)
    {"collision": _make_collision, "compression": _make_compression}[scene.kind](scene, begin, paths, say)
    return begin


def _make_collision(scene, begin, paths, say):
    moved_back = replace(begin.scene, grains=begin.scene.grains.copy())
    moved_back.grains["position"] -= scene.apart * moved_back.grains["velocity"]
    _save(paths[0], moved_back)
    here = paths[0].with_suffix(".begin")
    _save(here, begin.scene)
    time = 0.0
    for (moment, until), path in list(zip(scene.moments.items(), paths))[1:]:
        if not path.exists():
            say(f"making {path.name}", flush=True)
            advance(here, path, (until - time) / begin.scene.head["step"], begin.together)
        here, time = path, until
    paths[0].with_suffix(".begin").unlink()


def _make_compression(scene, begin, paths, say):
    """The denser cells are made at FAST_STRAIN, and then follow the paper's rate for RELAXED t0."""
    own, fast = begin.scene.strain_rate.copy(), np.full(3, -2 * FAST_STRAIN / begin.time_unit)
    here, step = paths[0].with_suffix(".fast"), begin.scene.head["step"]
    _save(here, begin.scene.with_strain_rate(fast))
    for (moment, filling), path in zip(scene.moments.items(), paths):
        if filling is None:
            _save(path, begin.scene)
            continue
        say(f"making {path.name}", flush=True)
        relaxing = RELAXED * begin.time_unit
        growth = log(filling / filling_of(scene_file.load(here)))
        growth += 3 * own[0] * relaxing  # less what the relaxation brings
        advance(here, here, growth / (-3 * fast[0]) / step, begin.together)
        _save(path.with_suffix(".own"), scene_file.load(here).with_strain_rate(own))
        advance(path.with_suffix(".own"), path, relaxing / step, begin.together)
        path.with_suffix(".own").unlink()
    here.unlink()


def _save(path, scene):
    new = path.with_suffix(".new")
    scene_file.save(new, scene)
    new.replace(path)


def advance(begin, end, steps, together):
    """Have the harness take the scene of one file to another, so many small steps on, by whole O.steps. Raises RuntimeError with its words."""
    steps = max(1, round(steps / together)) * together
    new = end.with_suffix(".new")
    command = [str(HARNESS), str(begin), f"steps={steps}", f"together={together}", "threads=2", f"out={new}"]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        raise RuntimeError(done.stderr.strip() or f"{HARNESS} failed with status {done.returncode}")
    new.replace(end)
