"""The scenes whose speed is measured, as arrays: the same grains for every code. Needs no YADE.

Two aggregates (A24 section 3) with their centres at -/+(R_agg + r), flying at each other. Kinds:

uniform    ice grains of 0.1 um, CPE, filling 0.4
materials  the same packing, every other grain (at random) softer: E = 3 GPa, nu = 0.33, gamma = 0.05 J/m^2, so that three kinds of contact occur; their
           equilibrium overlaps differ by up to 7 %, so the packing starts close to rest
radii      ice in a rock-salt lattice: grains of 0.1 um on the sites of CPE, grains 0.41 times as large in the gaps between them, every neighbour at
           its equilibrium overlap, the same fraction of sites removed at random
"""

from dataclasses import dataclass, replace
from math import sqrt

import numpy as np

from analysis.theory import ICE, Material, pair_constants
from yade_scripts import packings

FILLING = 0.4
SPEED = 10**0.5  # m/s, relative
STEP = 0.1  # of the shortest time unit t0 of the scene's contacts
GRAIN_RADIUS = 1e-7  # m
SOFT = Material(young=3e9, poisson=0.33, density=1000.0, surface_energy=0.05, critical_rolling=1.1e-9)
SEED = 1


@dataclass(frozen=True)
class Scene:
    """position, velocity (N,3) [m, m/s]; radius (N,) [m]; material (N,) index into materials; time step [s]; spin (N,3) [rad/s], None: 0; edge [m] of a
    periodic cubic cell, 0: open space."""

    position: np.ndarray
    velocity: np.ndarray
    radius: np.ndarray
    material: np.ndarray
    materials: tuple
    step: float
    spin: np.ndarray = None
    edge: float = 0.0

    @property
    def grains(self):
        return len(self.radius)


def make(kind, aggregate_radius, speed=SPEED):
    """Scene of a kind (see above); aggregate_radius in GRAIN_RADIUS, speed [m/s] of the aggregates to each other."""
    pack = rock_salt if kind == "radii" else close_packing
    aggregates = [pack(aggregate_radius, index) for index in (0, 1)]
    reach = (aggregate_radius + 1) * GRAIN_RADIUS
    position = np.concatenate([a.position + (side * reach, 0, 0) for a, side in zip(aggregates, (-1, 1))])
    velocity = np.concatenate(
        [np.tile([-side * speed / 2, 0, 0], (a.grains, 1)) for a, side in zip(aggregates, (-1, 1))]
    )
    radius = np.concatenate([a.radius for a in aggregates])
    scene = Scene(position, velocity, radius, np.zeros(len(radius), int), (ICE,), 0)
    if kind == "materials":
        scene = replace(
            scene, material=np.random.default_rng(SEED).integers(2, size=scene.grains), materials=(ICE, SOFT)
        )
    return replace(
        scene, step=STEP * min(pair_constants(m, r).time_unit for m in scene.materials for r in np.unique(radius))
    )


def close_packing(aggregate_radius, index):
    overlap = pair_constants(ICE, GRAIN_RADIUS).equilibrium_overlap
    return packings.cpe(FILLING, aggregate_radius * GRAIN_RADIUS, GRAIN_RADIUS, overlap, SEED, index)


def rock_salt(aggregate_radius, index):
    """Packing of two sizes (see above)."""
    overlap = pair_constants(ICE, GRAIN_RADIUS).equilibrium_overlap
    spacing = (2 * GRAIN_RADIUS - overlap) / sqrt(2)  # of large and small
    small = small_radius(spacing)
    random = packings.random_stream(SEED, index)
    outside = aggregate_radius * GRAIN_RADIUS
    reach = np.arange(-int(outside / spacing) - 2, int(outside / spacing) + 3)
    site = np.stack(np.meshgrid(reach, reach, reach, indexing="ij"), axis=-1).reshape(-1, 3)
    position = site * spacing - random.uniform(0, 2 * spacing, 3)
    kept = (np.linalg.norm(position, axis=1) < outside) & (
        random.random(len(site)) < FILLING / packings.maximum_filling(GRAIN_RADIUS, overlap)
    )
    radius = np.where(site.sum(axis=1) % 2 == 0, GRAIN_RADIUS, small)
    return packings.Packing(position[kept], radius[kept], SEED)


def small_radius(spacing):
    """Radius [m] of the grain that is at its equilibrium overlap with a grain of GRAIN_RADIUS at this distance [m]."""
    small = spacing - GRAIN_RADIUS
    for _ in range(20):  # converges by a factor of some 200 a turn
        small = spacing - GRAIN_RADIUS + pair_constants(ICE, GRAIN_RADIUS, ICE, small).equilibrium_overlap
    return small


def touching(scene):
    """Number of pairs of grains that overlap."""
    return len(packings.contacts(packings.Packing(scene.position, scene.radius, SEED)))
