"""A throw-away integration of two clusters with JKR normal forces and drag only: test data that obeys the
contact law."""

import numpy as np
from scipy.spatial import cKDTree
from written_runs import MASS, PAIR, RADIUS, record, state_arrays

from analysis.measures.compression import compression_length, mutual_velocity
from analysis.runs.format import CHANNELS
from analysis.theory import normalised_energy, normalised_force

DRAG = 2e-9  # [N s/m] at every contact, so that the clusters don't ring for long
_CONTACT, _SEPARATION = 2.0 * RADIUS, 2.0 * RADIUS + PAIR.pull_off_overlap


def cluster(radius, filling=None, seed=0):
    """Grain centres (N,3) [m] of a close-packed ball of `radius` grain radii, thinned to N = filling radius^3
    if asked."""
    random = np.random.default_rng(seed)
    spacing = (2.0 * RADIUS - PAIR.equilibrium_overlap) / RADIUS
    n = int(radius / spacing * 1.5) + 3
    cells = np.stack(np.meshgrid(*[np.arange(-n, n + 1)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    centres = cells[cells.sum(axis=1) % 2 == 0] * spacing / np.sqrt(2.0) - random.uniform(-1.0, 1.0, 3)
    centres = centres[np.linalg.norm(centres, axis=1) <= radius]
    if filling is not None:
        centres = centres[random.permutation(len(centres))[: int(filling * radius**3)]]
    turn, _ = np.linalg.qr(random.normal(size=(3, 3)))
    return centres @ turn * RADIUS


def collide_clusters(centres, velocity, duration, samples=300, states=12, step=0.1):
    """(record, history, states) of the cluster meeting its mirror image head-on with `velocity` [m/s]."""
    radius = np.linalg.norm(centres, axis=1).max()
    shift = np.array([radius + RADIUS, 0.0, 0.0])
    x = np.concatenate([centres - shift, -(centres - shift)])
    aggregate = np.repeat([0, 1], len(centres))
    v = np.where(aggregate[:, None] == 0, 1.0, -1.0) * np.array([0.5 * velocity, 0.0, 0.0])
    dt = step * PAIR.time_unit
    total = int(np.ceil(duration / dt))
    every, save = max(1, total // samples), np.linspace(0, total, states).astype(int)
    motion = _Motion(x, v, aggregate, radius, dt)
    history, kept = [motion.sample(0.0)], [motion.state(0.0)]
    for number in range(1, total + 1):
        motion.step()
        if number % every == 0 or number == total:
            history.append(motion.sample(number * dt))
        if number in save:
            kept.append(motion.state(number * dt))
    columns = {name: np.array([row[name] for row in history]) for name in history[0]}
    return record(radius, {"radius": radius / RADIUS, "velocity": velocity}), columns, kept


class _Motion:
    def __init__(self, x, v, aggregate, radius, dt):
        self.x, self.v, self.aggregate, self.radius, self.dt = x, v, aggregate, radius, dt
        self.lost = dict.fromkeys(("connection", "disconnection", "drag"), 0.0)
        self._search()
        self.touching = self.distance <= _CONTACT
        self.force, self.rate = self._forces()

    def _search(self):
        old = None if not hasattr(self, "pairs") else set(map(tuple, self.pairs[self.touching]))
        self.pairs = cKDTree(self.x).query_pairs(_SEPARATION + 0.2 * RADIUS, output_type="ndarray")
        self.searched = self.x.copy()
        self._measure()
        if old is not None:
            self.touching = np.array([tuple(p) in old for p in self.pairs], dtype=bool)

    def _measure(self):
        i, j = self.pairs.T
        between = self.x[i] - self.x[j]
        self.distance = np.linalg.norm(between, axis=1)
        self.normal = between / self.distance[:, None]

    def _forces(self):
        i, j = self.pairs.T
        rate = -np.einsum("ij,ij->i", self.v[i] - self.v[j], self.normal)
        elastic = PAIR.pull_off_force * normalised_force((_CONTACT - self.distance) / PAIR.equilibrium_overlap)
        return np.where(self.touching, elastic, 0.0), np.where(self.touching, rate, 0.0)

    def _acceleration(self):
        pull = (self.force + DRAG * self.rate)[:, None] * self.normal / MASS
        a = np.zeros_like(self.x)
        for k in range(3):
            a[:, k] = np.bincount(self.pairs[:, 0], pull[:, k], len(a)) - np.bincount(
                self.pairs[:, 1], pull[:, k], len(a)
            )
        return a

    def step(self):
        self.v = self.v + 0.5 * self.dt * self._acceleration()
        self.x = self.x + self.dt * self.v
        if np.abs(self.x - self.searched).max() > 0.05 * RADIUS:
            self._search()
        else:
            self._measure()
        self._events()
        self.force, self.rate = self._forces()
        self.v = self.v + 0.5 * self.dt * self._acceleration()
        self.lost["drag"] += DRAG * np.sum(self.rate**2) * self.dt

    def _events(self):
        formed = ~self.touching & (self.distance <= _CONTACT)
        broken = self.touching & (self.distance > _SEPARATION)
        self.touching = (self.touching | formed) & ~broken
        self.lost["connection"] -= self._energy()[formed].sum()
        self.lost["disconnection"] += broken.sum() * 4.0 / 45.0 * PAIR.pull_off_force * PAIR.pull_off_overlap

    def _energy(self):
        normalised = normalised_energy((_CONTACT - self.distance) / PAIR.equilibrium_overlap)
        return np.where(self.touching, PAIR.pull_off_force * PAIR.pull_off_overlap * normalised, 0.0)

    def sample(self, time):
        i, j = self.pairs[self.touching].T
        return {
            **dict.fromkeys(CHANNELS, 0.0),
            "time": time,
            "kinetic": 0.5 * MASS * np.sum(self.v**2),
            "normal": self._energy().sum(),
            **self.lost,
            "d": compression_length(self.x[:, 0], self.radius),
            "v": mutual_velocity(self.x[:, 0], self.v[:, 0]),
            "contacts": len(i),
            "contacts_between": int(np.sum(self.aggregate[i] != self.aggregate[j])),
        }

    def state(self, time):
        return state_arrays(time, self.x, self.v, self.aggregate, self.pairs[self.touching], self.force[self.touching])
