"""The scenes that are measured: the bench's own, those of the papers, and the collision that every code runs.

A scene is what a run of collide.py or compress.py starts from, and the moments of that run at which codes are measured:
files of grains with the springs of all contacts, which the engine itself has reached. They lie in build/bench/scenes:
made once, they serve every version of the engine, and are made again when the scene's definition changes.
"""

import hashlib
import json
from dataclasses import dataclass, field, replace
from math import ceil, log

import codes
import numpy as np
import scene_file

from analysis.measures.periodic_cell import filling_factor
from yade_scripts import packings
from yade_scripts.experiments import collision, compression
from yade_scripts.materials import pair_constants
from yade_scripts.packings.placing import first_touch, smallest_edge

BESIDE_LAMMPS = ("engine", "lammps")
IN_YADE = ("engine", "engine-avx2", "engine-portable", "functors")
EVERY = ("engine", "functors", "lammps", "lammps-newest", "liggghts")
FLYING = {"flying": 0.0}
SMALL_STEPS = 50  # in an O.step of a collision


@dataclass(frozen=True)
class Scene:
    """A run and its moments.

    kind: collision, compression, or materials (a collision in which every other grain, at random, is of SOFT);
    parameters: of the run, as tables have them; moments: {name: time [s] or filling factor}, in their order (None: the
    start); apart: time [s] by which a collision's first moment is moved back along straight lines, for a flight long
    enough to measure; codes: names of codes.CODES to measure.
    """

    title: str
    kind: str
    parameters: dict
    moments: dict = field(default_factory=lambda: FLYING)
    apart: float = 0.0
    codes: tuple = BESIDE_LAMMPS


@dataclass(frozen=True)
class Start:
    """A run's beginning: scene_file.SceneFile, duration [s], t0 [s], small steps in an O.step, and how far along
    (0: its beginning, 1: its end) each moment is."""

    scene: scene_file.SceneFile
    duration: float
    time_unit: float
    together: int
    progress: dict

    @property
    def step(self):
        """The small step [s]."""
        return float(self.scene.head["step"])

    @property
    def steps(self):
        """Small steps of the whole run."""
        return ceil(self.duration / self.step)


# ---- the papers' ----

A22 = {"packing": "bpca", "grains": 50_000, "impact": "(3/12)**0.5", "velocity": "10**1.7", "stepFraction": 0.2}
A22.update(duration="6.34e-6", viscoelasticTime="0")
OF_A22 = {"flying": 0.0, "compressing": 0.35e-6, "fragments": 0.7e-6, "later": 2e-6}
WITH_DRAG, SLOWLY = {**A22, "viscoelasticTime": "6e-12"}, {**A22, "velocity": 0.5}
K13 = {"grains": 16_384, "strainRate": "3e-7", "stepFraction": 0.3, "finalFilling": 0.3}
DENSE = {"phi 0.03": 0.03, "phi 0.3": 0.3}
S17 = {"packing": "bcca", "grains": 1024, "planar": 1, "neck": 0.7, "velocity": 20, "stepFraction": 0.1}
OF_S17 = {"flying": 0.0, "touching": 0.5e-6, "later": 1.5e-6}
CPE = {"packing": "cpe", "filling": 0.4, "stepFraction": 0.1, "velocity": "10**0.5"}
OF_A24 = {"flying": 0.0, "compressed": 0.4e-6, "apart": 0.8e-6}
FAST = {**CPE, "radius": 20, "velocity": 60, "duration": "120e-9"}
OF_FAST, OF_CPE = {"flying": 0.0, "compressing": 30e-9, "fragments": 110e-9}, {"flying": 0.0, "compressed": 0.2e-6}
PAPERS = {
    "a22": Scene("A22: two BPCA of 50,000 at 50.1 m/s, B_off 0.5", "collision", A22, OF_A22, 0.5e-6),
    "a22-drag": Scene("A22: the same, T_vis 6 ps", "collision", WITH_DRAG, OF_A22, 0.5e-6),
    "a22-slow": Scene("A22: the same grains at 0.5 m/s, T_vis 0", "collision", SLOWLY, FLYING, 0.5e-6),
    "k13": Scene("K13: BCCA of 16,384, C_v 3e-7", "compression", K13, {"phi 0.001": 0.001, **DENSE}),
    "k13-1024": Scene("K13: BCCA of 1,024, C_v 3e-7", "compression", {**K13, "grains": 1024}, {"start": None, **DENSE}),
    "s17": Scene("S17: 2 x 1,024 planar BCCA, beta 0.7, 20 m/s", "collision", S17, OF_S17, 0.3e-6),
    "a24": Scene("A24: two CPE, R 80, 3.16 m/s", "collision", {**CPE, "radius": 80}, OF_A24, 0.1e-6),
    "cpe-fast": Scene("two CPE, R 20, 60 m/s", "collision", FAST, OF_FAST, 0.2e-6),
    "cpe": Scene("two CPE, R 40, 3.16 m/s", "collision", {**CPE, "radius": 40}, OF_CPE, 0.1e-6),
}


# ---- the bench's, and the one of all codes ----


def _two_cpe(radius, codes=("engine",), kind="collision"):
    # a flight that is enough to measure, and so short that a peer's bins are not mostly empty
    flight = max(0.1e-6, 1e-6 * min(1.0, (20 / radius) ** 3))
    title = f"two CPE, R {radius:g}" + ", two materials" * (kind == "materials")
    return Scene(title, kind, {**CPE, "radius": radius}, apart=flight, codes=codes)


BENCH = {
    "cpe-20": _two_cpe(20, IN_YADE),
    "cpe-40": _two_cpe(40, (*IN_YADE, "lammps", "liggghts")),
    "cpe-80": _two_cpe(80),
    "materials": _two_cpe(40, kind="materials"),
}
QUICK = {name: BENCH[name] for name in ("cpe-20", "cpe-40")}
TINY = {"tiny": _two_cpe(4, (*IN_YADE, "lammps"))}
OF_PEERS = {**FLYING, "compressed": 0.1e-6}
PEERS = {"peers": Scene("two CPE, R 20, 3.16 m/s", "collision", {**CPE, "radius": 20}, OF_PEERS, 1e-6, EVERY)}


# ---- small ones of every kind, for tests and sanitizers ----

# drag; a periodic cell with damping; sintered bonds in a plane, where some break
DRAG = {"packing": "bpca", "grains": 300, "velocity": 60, "viscoelasticTime": "6e-12", "stepFraction": 0.2}
CELL = {"grains": 128, "strainRate": "3e-6", "stepFraction": 0.3, "finalFilling": 0.1}
BONDS = {"packing": "bcca", "grains": 64, "planar": 1, "neck": 0.3, "velocity": 60, "stepFraction": 0.1}
SMALL = {
    "drag": Scene("", "collision", DRAG, {"flying": 0.0, "compressing": 30e-9}),
    "cell": Scene("", "compression", CELL, {"start": None, "denser": 0.03}),
    "bonds": Scene("", "collision", BONDS, {"flying": 0.0, "broken": 60e-9}),
}


# ---- where their runs begin ----

SOFT = {"young": 3e9, "poisson": 0.33, "surfaceEnergy": 0.05, "criticalRolling": 1.1e-9}


def start_of(scene):
    """Start of a Scene's run."""
    return _compressed(scene) if scene.kind == "compression" else _collided(scene)


def _collided(scene):
    parameters = collision.CollisionParameters.parse(scene.parameters)
    materials, kind = [parameters], 0
    overlap = pair_constants(parameters)["equilibriumOverlap"]
    parameters, pair, velocities = collision.place(parameters, overlap)
    numbers, radius = [packing.grains for packing in pair], np.concatenate([packing.radius for packing in pair])
    if scene.kind == "materials":
        materials.append(parameters.changed(**SOFT))
        kind = np.random.default_rng(parameters.seed).integers(2, size=sum(numbers))
    time_unit = min(pair_constants(one, (r, r))["timeUnit"] for one in materials for r in np.unique(radius))
    if parameters.duration is None:
        touch = first_touch(*pair, velocities[1] - velocities[0])
        duration = collision.default_duration(parameters, parameters.radius, time_unit, touch or 0.0)
        parameters = parameters.changed(duration=duration)
    position, velocity = np.concatenate([packing.position for packing in pair]), np.repeat(velocities, numbers, axis=0)
    step, planar = parameters.stepFraction * time_unit, bool(parameters.planar)
    made = scene_file.start(position, velocity, radius, materials, step, kind, neck=parameters.neck, planar=planar)
    progress = {name: time / parameters.duration for name, time in scene.moments.items()}
    return Start(made, parameters.duration, time_unit, SMALL_STEPS, progress)


def _compressed(scene):
    parameters = compression.CompressionParameters.parse(scene.parameters)
    constants, damping = pair_constants(parameters), parameters.linearDamping
    time_unit, overlap = constants["timeUnit"], constants["equilibriumOverlap"]
    cluster = packings.bcca(parameters.grains, parameters.grainRadius, overlap, parameters.seed)
    edge, at_rest, step = smallest_edge(cluster), np.zeros((cluster.grains, 3)), parameters.stepFraction * time_unit
    cell = {"linear_damping": damping, "edge": edge}
    made = scene_file.start(cluster.position, at_rest, cluster.radius, [parameters], step, **cell)
    first = filling_factor(cluster.radius, np.full(3, edge))
    whole = log(parameters.finalFilling / first)
    progress = {name: log((filling or first) / first) / whole for name, filling in scene.moments.items()}
    duration, rate = whole * time_unit / (6 * parameters.strainRate), -2 * parameters.strainRate / time_unit
    together = min(compression.BETWEEN_SAMPLES, compression.FINEST_FILLING / (6 * parameters.strainRate))
    together = max(1, round(together / parameters.stepFraction))  # between samples, as compress.py has it
    return Start(made.with_strain_rate(rate), duration, time_unit, together, progress)


# ---- the files of their moments ----

FOLDER = codes.TOP / "build/bench/scenes"
FAST_STRAIN = 1e-5  # 1/t0: at which the denser cells are made
RELAXED = 3000.0  # t0 at the paper's own rate before a denser cell is measured, in which what was stirred up dies down
LARGE = 1e6  # bytes of a scene's file from which on two threads pay


def make(name, scene, folder=FOLDER):
    """Start of a Scene, and {moment: its file}; a file that exists is not made again."""
    start = start_of(scene)
    made = [FAST_STRAIN, RELAXED] if scene.kind == "compression" else [scene.apart]
    definition = json.dumps([scene.kind, scene.parameters, scene.moments, *made, scene_file.FORMAT], sort_keys=True)
    key = hashlib.sha256(definition.encode()).hexdigest()[:8]
    paths = {moment: folder / f"{name}-{moment.replace(' ', '')}-{key}.scene" for moment in scene.moments}
    if not all(path.exists() for path in paths.values()):
        print(f"making the moments of {name}", flush=True)
        folder.mkdir(parents=True, exist_ok=True)
        here = folder / f"{name}-{key}.begin"
        (_make_cells if scene.kind == "compression" else _make_collision)(scene, start, paths, here)
        here.unlink()
    return start, paths


def _make_collision(scene, start, paths, here):
    scene_file.save(here, start.scene)
    grains = start.scene.grains.copy()
    grains["position"] -= scene.apart * grains["velocity"]
    first, *later = paths
    scene_file.save(paths[first], replace(start.scene, grains=grains))
    time = 0.0
    for moment in later:
        advance(here, here, (scene.moments[moment] - time) / start.step, start.together)
        paths[moment].write_bytes(here.read_bytes())
        time = scene.moments[moment]


def _make_cells(scene, start, paths, here):
    """The denser cells are made at FAST_STRAIN, and then follow the paper's rate for RELAXED t0."""
    own, fast = start.scene.head["strainRate"].copy(), np.full(3, -2 * FAST_STRAIN / start.time_unit)
    scene_file.save(here, start.scene.with_strain_rate(fast))
    for moment, path in paths.items():
        filling = scene.moments[moment]
        if filling is None:
            scene_file.save(path, start.scene)
            continue
        relaxing = RELAXED * start.time_unit
        growth = log(filling / filling_of(scene_file.load(here)))
        growth += 3 * own[0] * relaxing  # less what the relaxation brings
        advance(here, here, growth / (-3 * fast[0]) / start.step, start.together)
        slowed = path.with_suffix(".own")
        scene_file.save(slowed, scene_file.load(here).with_strain_rate(own))
        advance(slowed, path, relaxing / start.step, start.together)
        slowed.unlink()


def filling_of(scene):
    """Volume filling factor of a periodic SceneFile."""
    return filling_factor(scene.grains["radius"], scene.head["cellSize"])


def advance(begin, end, steps, together):
    """Take the scene of one file to another by the engine, so many small steps on, in whole O.steps."""
    new, threads = end.with_suffix(".new"), 2 if begin.stat().st_size > LARGE else 1  # the same bits
    steps = max(1, round(steps / together)) * together
    codes.harness(begin, steps=steps, together=together, threads=threads, out=new)
    new.replace(end)
