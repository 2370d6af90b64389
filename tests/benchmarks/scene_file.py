"""Scenes in files, for the harness (harness/scene_file.hpp lists the same fields), YADE (in_yade.py), LAMMPS and
LIGGGHTS (codes.py).

A file holds one record of HEAD, then records of MATERIAL, GRAIN and CONTACT, as many as HEAD says; every field has
eight bytes. All is SI and of one moment. Without contacts it is a start: grains that overlap touch, with unstrained
springs (with a neck: bonded). The mean flow of a periodic cell is in the grains' velocities. Files stay readable from
one version of the engine to the next, which checkpoints do not.
"""

from dataclasses import dataclass, replace
from math import pi

import numpy as np

MAGIC, FORMAT = b"JKRscene", 1
HEAD = np.dtype(
    [("magic", "S8")]
    + [(name, "<i8") for name in ("format", "materials", "grains", "contacts")]
    + [(name, "<f8") for name in ("time", "step", "linearDamping", "neck")]  # s, s, 1, 1
    + [("cellSize", "<f8", 3), ("strainRate", "<f8", 3)]  # m (0: open space), 1/s
)
MATERIAL = np.dtype(
    [(name, "<f8") for name in ("young", "poisson", "density", "surfaceEnergy", "criticalRolling", "viscoelasticTime")]
)
GRAIN = np.dtype(
    [(name, "<f8", 3) for name in ("position", "velocity", "angularVelocity")]
    + [(name, "<f8") for name in ("radius", "mass", "inertia")]
    + [(name, "<i8") for name in ("material", "blocked")]  # blocked: bits as State.blockedDOFs
)
CONTACT = np.dtype(
    [(name, "<i8") for name in ("first", "second", "bonded")]
    + [(name, "<f8", 3) for name in ("pointer1", "pointer2")]  # frame of the laboratory
    + [(name, "<f8") for name in ("twist", "overlap", "drag", "rest")]  # 1, m, N, m
)
RECORDS = {"materials": MATERIAL, "grains": GRAIN, "contacts": CONTACT}
IN_PLANE = 4 + 8 + 16  # blocked: z, and turning about x and y


@dataclass(frozen=True)
class SceneFile:
    """head (HEAD, one record), materials (MATERIAL,), grains (GRAIN,), contacts (CONTACT,)."""

    head: np.ndarray
    materials: np.ndarray
    grains: np.ndarray
    contacts: np.ndarray

    @property
    def periodic(self):
        return self.head["cellSize"][0] > 0

    def with_strain_rate(self, rate):
        """The scene whose cell deforms at another rate (3,) [1/s]; grains get the difference of the mean flows (K13
        eq 12)."""
        head, grains = self.head.copy(), self.grains.copy()
        grains["velocity"] += (rate - head["strainRate"]) * grains["position"]
        head["strainRate"] = rate
        return replace(self, head=head, grains=grains)


def start(position, velocity, radius, materials, step, kind=0, linear_damping=0.0, neck=0.0, edge=0.0, planar=False):
    """SceneFile of grains that have no contacts yet.

    Parameters
    ----------
    position, velocity : (N, 3) [m, m/s]; radius : (N,) [m].
    materials : each anything with the names of MATERIAL as attributes; kind : (N,) or one, index into materials.
    step : small step [s]; edge : of a periodic cubic cell [m], 0 in open space.
    linear_damping, neck : k_n of K13, beta of S17; planar : the grains never leave z = 0.
    """
    material = np.array([tuple(getattr(one, name) for name in MATERIAL.names) for one in materials], MATERIAL)
    grains = np.zeros(len(radius), GRAIN)
    grains["position"], grains["velocity"], grains["radius"], grains["material"] = position, velocity, radius, kind
    grains["mass"] = 4 / 3 * pi * material["density"][grains["material"]] * radius**3
    grains["inertia"] = 2 / 5 * grains["mass"] * radius**2
    grains["blocked"] = IN_PLANE if planar else 0
    head = np.zeros((), HEAD)
    head["step"], head["linearDamping"], head["neck"], head["cellSize"] = step, linear_damping, neck, edge
    return SceneFile(head, material, grains, np.zeros(0, CONTACT))


def save(path, scene):
    """Write a SceneFile."""
    head = scene.head.copy()
    head["magic"], head["format"] = MAGIC, FORMAT
    for name in RECORDS:
        head[name] = len(getattr(scene, name))
    with open(path, "wb") as file:
        for part in (head, *(getattr(scene, name) for name in RECORDS)):
            file.write(part.tobytes())


def load(path):
    """SceneFile of a file."""
    with open(path, "rb") as file:
        found = file.read()
    head = np.frombuffer(found[: HEAD.itemsize], HEAD)[0] if len(found) >= HEAD.itemsize else None
    if head is None or head["magic"] != MAGIC or head["format"] != FORMAT:
        raise ValueError(f"{path}: must be a scene of format {FORMAT} that scene_file.py or the harness wrote")
    parts, at = [], HEAD.itemsize
    for name, record in RECORDS.items():
        parts.append(np.frombuffer(found, record, int(head[name]), at).copy())
        at += parts[-1].nbytes
    return SceneFile(np.array(head), *parts)
