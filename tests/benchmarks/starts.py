"""Where the runs of the scenes begin: grains, cell and step, from the packings and parameters of the scripts.

Kinds: collision and compression, as of collide.py and compress.py;
materials  the grains of a collision, every other (at random) softer: E = 3 GPa, nu = 0.33, gamma = 0.05 J/m^2, so that three
           kinds of contact occur; equilibrium overlaps differ by up to 7 %, so the packing starts close to rest
radii      ice in a rock-salt lattice: grains of 0.1 um on the sites of CPE, grains 0.41 times as large in the gaps between
           them, every neighbour at its equilibrium overlap, the same fraction of sites removed at random
"""

from dataclasses import dataclass, replace
from math import ceil, log, sqrt

import numpy as np
import scene_file

from analysis.measures.fragments import fragment_labels
from analysis.measures.virial import filling_factor
from yade_scripts import packings
from yade_scripts.experiments import collision, compression
from yade_scripts.materials import pair_constants
from yade_scripts.packings.approach import first_touch
from yade_scripts.packings.periodic import smallest_edge

SMALL_STEPS = 50  # in an O.step of a collision
SOFT = {"young": 3e9, "poisson": 0.33, "surfaceEnergy": 0.05, "criticalRolling": 1.1e-9}


@dataclass(frozen=True)
class Start:
    """A run's beginning: scene_file.SceneFile, the run's duration [s], t0 [s], small steps in an O.step, and how far along
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


def of(scene):
    """Start of a measured_scenes.Scene's run."""
    return compressed(scene) if scene.kind == "compression" else collided(scene)


def collided(scene):
    parameters = collision.CollisionParameters.parse(scene.parameters)
    materials, kind = [parameters], 0
    if scene.kind == "radii":
        where = collision.placements(parameters.radius, parameters.grainRadius, parameters.velocity, parameters.impact)
        pair = [packings.moved(rock_salt(parameters, index), centre) for index, (centre, _) in enumerate(where)]
        velocities = [velocity for _, velocity in where]
    else:
        overlap = pair_constants(parameters)["equilibriumOverlap"]
        parameters, pair, velocities = collision.place(parameters, overlap)
    numbers, radius = [packing.grains for packing in pair], np.concatenate([packing.radius for packing in pair])
    if scene.kind == "materials":
        materials.append(parameters.changed(**SOFT))
        kind = np.random.default_rng(parameters.seed).integers(2, size=sum(numbers))
    time_unit = min(pair_constants(one, (r, r))["timeUnit"] for one in materials for r in np.unique(radius))
    parameters = collision.with_duration(parameters, time_unit, first_touch(*pair, velocities[1] - velocities[0]))
    position, velocity = np.concatenate([packing.position for packing in pair]), np.repeat(velocities, numbers, axis=0)
    step, planar = parameters.stepFraction * time_unit, bool(parameters.planar)
    made = scene_file.start(position, velocity, radius, materials, step, kind, neck=parameters.neck, planar=planar)
    progress = {name: time / parameters.duration for name, time in scene.moments.items()}
    return Start(made, parameters.duration, time_unit, SMALL_STEPS, progress)


def rock_salt(parameters, index):
    """Packing of two sizes (see above), centred; index of the aggregate."""
    large, overlap = parameters.grainRadius, pair_constants(parameters)["equilibriumOverlap"]
    spacing = (2 * large - overlap) / sqrt(2)  # of large and small
    small = spacing - large
    for _ in range(20):  # until they overlap by their equilibrium overlap; converges by a factor of some 200 a turn
        small = spacing - large + pair_constants(parameters, (large, small))["equilibriumOverlap"]
    random = packings.random_stream(parameters.seed, index)
    outside = parameters.radius * large
    reach = np.arange(-int(outside / spacing) - 2, int(outside / spacing) + 3)
    site = np.stack(np.meshgrid(reach, reach, reach, indexing="ij"), axis=-1).reshape(-1, 3)
    position = site * spacing - random.uniform(0, 2 * spacing, 3)
    kept = np.linalg.norm(position, axis=1) < outside
    kept &= random.random(len(site)) < parameters.filling / packings.maximum_filling(large, overlap)
    radius = np.where(site.sum(axis=1) % 2 == 0, large, small)
    return packings.Packing(position[kept], radius[kept], parameters.seed)


def compressed(scene):
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
    return Start(made.with_strain_rate(rate), duration, time_unit, compression._interval(parameters), progress)


def moved_back(start, apart):
    """The SceneFile of a start whose grains are back by so much time [s] on straight lines."""
    grains = start.scene.grains.copy()
    grains["position"] -= apart * grains["velocity"]
    return replace(start.scene, grains=grains)


def rung(start, rate):
    """SceneFile of the first aggregate of a collision, or of its largest part whose grains touch, stretched along x and
    squeezed across at a rate [1/s]: v = rate (x, -y/2, -z/2)."""
    grains = start.scene.grains[: len(start.scene.grains) // 2]
    touching = packings.contacts(packings.Packing(grains["position"], grains["radius"], 1))
    part = fragment_labels(len(grains), touching)
    grains = grains[part == np.bincount(part).argmax()].copy()
    grains["position"] -= grains["position"].mean(axis=0)
    grains["velocity"] = rate * grains["position"] * (1, -0.5, -0.5)
    return replace(start.scene, grains=grains)


def pairs(gaps, speed, parameters, step):
    """SceneFile of pairs of grains (0 and 1, 2 and 3, ...) that fly at each other, far from other pairs.

    gaps (n,) [m] between their surfaces; speed [m/s]; parameters: of the grains, as collide.py has them; step [s].
    """
    radius = parameters.grainRadius
    position, velocity = np.zeros((2 * len(gaps), 3)), np.zeros((2 * len(gaps), 3))
    position[:, 1] = np.repeat(np.arange(len(gaps)), 2) * 10 * radius
    position[1::2, 0], velocity[1::2, 0] = 2 * radius + gaps, -speed
    return scene_file.start(position, velocity, np.full(len(position), radius), [parameters], step)
