"""Collisions without YADE, many at once: each by a block of a GPU's threads, or on a processor.

    from yade_scripts.run.ensemble import Collision, Library
    library = Library()
    collisions = [Collision(library, grains, steps=10_000, time_step=2e-11, interval=50) for grains in ...]
    library.run(collisions, 1_000)
    collisions[0].read().samples()["kinetic"]

The law is that of contact_law/kernel, by the same code as in YADE.
"""

import ctypes
from copy import copy
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

BUILT = Path(__file__).parents[2] / "build" / "gpu"
PROCESSOR, DEVICE = BUILT / "libprocessor.so", BUILT / "libdevice.so"
WHOLE_PROCESSOR, WHOLE_DEVICE = BUILT / "libprocessor-whole.so", BUILT / "libdevice-whole.so"
MECHANISMS = {"sliding": 1, "rolling": 2, "twisting": 4, "drag": 8}
LIMITS = ("held", "cut")
MATERIAL = ("young", "poisson", "density", "surfaceEnergy", "criticalRolling", "viscoelasticTime")
FAILURES = (
    None,
    "more contacts than there is room for",
    "more neighbours than there is room for",
    "a grain has more contacts than there is room for",
    "a grain moves more than half a radius in a step: the step is too long",
)
BROKEN_BONDS = ("brokenByStretching", "brokenBySliding", "brokenByRolling", "brokenByTwisting")
SIDES = tuple(f"{side}_{what}" for side in ("right", "left") for what in ("grains", "position", "velocity"))
BONDED, TOUCHING = 3, 2
SKIN = 0.6  # grain radii between the surfaces of neighbours


class DeviceError(RuntimeError):
    """A device that has failed, or lacks memory; the message is one line."""


class _Input(ctypes.Structure):
    _fields_ = [
        *((name, ctypes.c_int) for name in "grains contacts kinds bonded mechanisms limit interval".split()),
        *((name, ctypes.c_int) for name in "slots pairs contactsOfAGrain intervalAfter".split()),
        *((name, ctypes.c_longlong) for name in "steps changesAt".split()),
        *((name, ctypes.c_double) for name in "dt dtAfter neck linearDamping".split()),
        *(
            (name, ctypes.c_double)
            for name in "slidingStiffnessFactor rollingStiffnessFactor mixedSurfaceEnergyFactor skin".split()
        ),
        *((name, ctypes.c_void_p) for name in "position velocity spin mass inertia radius materials".split()),
        *((name, ctypes.c_void_p) for name in "kind aggregate touching".split()),
    ]


class Library:
    """The compiled ensemble of one back end: PROCESSOR (make), or DEVICE (make gpu). In those named WHOLE all threads
    work on one collision after another, for large ones; results are the same but for the rounding of sums.

    Attributes
    ----------
    device : str
        Its name.
    channels : tuple of str
        Energy channels, in the order of the samples.
    at_once : int
        Collisions that it computes at the same time.
    large : Library or None
        Of the same back end, for large collisions.
    """

    large = None

    def __init__(self, path=PROCESSOR):
        self._of = ctypes.CDLL(str(path))
        for name in ("ensemble_error", "ensemble_device", "ensemble_channels"):
            getattr(self._of, name).restype = ctypes.c_char_p
        for name in ("collision_start", "collision_resume"):
            getattr(self._of, name).restype = ctypes.c_void_p
        self._of.collision_size.restype = ctypes.c_longlong
        self.device = self._of.ensemble_device().decode()
        self.channels = tuple(self._of.ensemble_channels().decode().split())
        self.at_once = self._of.ensemble_at_once()

    def runs(self, mechanisms):
        """Whether collisions with these mechanisms (a sum of MECHANISMS) are compiled."""
        return bool(self._of.ensemble_runs(mechanisms))

    def run(self, collisions, steps):
        """Bring collisions on by so many steps (of all, or a list with those of each), or to their ends.

        Raises
        ------
        DeviceError
        """
        handles = (ctypes.c_void_p * len(collisions))(*(each.handle.value for each in collisions))
        each = np.ascontiguousarray(np.broadcast_to(steps, len(collisions)), dtype=np.int64)
        self.require(self._of.ensemble_run(handles, len(collisions), _pointer(each)))

    def require(self, result):
        """`result` of a call; raises DeviceError if it is none."""
        if not result:
            raise DeviceError(self._of.ensemble_error().decode() or "the device has no memory left")
        return result


@dataclass
class Grains:
    """Grains at the start of a collision, at rest on or apart from each other; overlapping ones touch.

    position, velocity, spin : (N, 3) [m, m/s, rad/s]
    radius : (N,) [m]
    kind : (N,) int, the row of `materials`
    aggregate : (N,) int
    materials : (K, 6), columns MATERIAL
    """

    position: np.ndarray
    velocity: np.ndarray
    radius: np.ndarray
    materials: np.ndarray
    kind: np.ndarray = None
    aggregate: np.ndarray = None
    spin: np.ndarray = None


class Collision:
    """One collision of a Library.

    Parameters
    ----------
    library : Library
    grains : Grains
    steps, interval : int
        Small steps until the end, and between samples.
    time_step : float [s]
    mechanisms : int
        Sum of MECHANISMS.
    limit : str
        Of LIMITS.
    neck : float
        Of sintered bonds between grains that touch, over their radius; 0: none.
    linear_damping, sliding_stiffness_factor, rolling_stiffness_factor, mixed_surface_energy_factor : float
    change : (int, float, int), optional
        After so many steps, at a sample, time_step and interval become these.

    Raises
    ------
    DeviceError
        The device has no memory left.
    """

    def __init__(
        self,
        library,
        grains,
        steps,
        time_step,
        interval,
        mechanisms=7,
        limit="held",
        neck=0.0,
        linear_damping=0.0,
        sliding_stiffness_factor=1.0,
        rolling_stiffness_factor=1.0,
        mixed_surface_energy_factor=1.0,
        change=None,
    ):
        self.library, self._of = library, library._of
        number = len(grains.position)
        as_floats = lambda values: np.ascontiguousarray(values, dtype=float)
        as_integers = lambda values: np.ascontiguousarray(np.broadcast_to(values, number), dtype=np.int32)
        kind = as_integers(0 if grains.kind is None else grains.kind)
        materials = as_floats(np.atleast_2d(grains.materials))
        radius = as_floats(grains.radius)
        mass = 4 / 3 * np.pi * radius**3 * materials[kind, MATERIAL.index("density")]
        touching = touching_pairs(grains.position, radius, 1e-12 if neck else -1e-15)
        arrays = {
            "position": as_floats(grains.position),
            "velocity": as_floats(grains.velocity),
            "spin": as_floats(np.zeros((number, 3)) if grains.spin is None else grains.spin),
            "mass": mass,
            "inertia": 0.4 * mass * radius**2,
            "radius": radius,
            "materials": materials,
            "kind": kind,
            "aggregate": as_integers(0 if grains.aggregate is None else grains.aggregate),
            "touching": touching,
        }
        self.grains, self.aggregate, self.radius = number, arrays["aggregate"], radius
        change = dict(zip(("changesAt", "dtAfter", "intervalAfter"), change or (0, time_step, interval)))
        unlike = radius.max() / radius.min()
        given = _Input(
            grains=number,
            contacts=len(touching),
            kinds=len(materials),
            bonded=bool(neck),
            mechanisms=mechanisms,
            limit=LIMITS.index(limit),
            interval=interval,
            slots=len(touching) + 4 * number + 64,
            pairs=24 * number + 64,
            contactsOfAGrain=int(16 * unlike**2),
            steps=steps,
            dt=time_step,
            neck=neck,
            linearDamping=linear_damping,
            slidingStiffnessFactor=sliding_stiffness_factor,
            rollingStiffnessFactor=rolling_stiffness_factor,
            mixedSurfaceEnergyFactor=mixed_surface_energy_factor,
            skin=SKIN * radius.min(),
            **change,
            **{name: array.ctypes.data for name, array in arrays.items()},
        )
        self.handle = ctypes.c_void_p(library.require(self._of.collision_start(ctypes.byref(given))))

    def __del__(self):
        if getattr(self, "handle", None):
            self._of.collision_end(self.handle)

    def read(self):
        """Fetch the state from the device; returns self."""
        numbers = np.zeros(5, dtype=np.int64)
        self.library.require(self._of.collision_read(self.handle, _pointer(numbers)))
        self.step, self.steps_left, self._samples, self._slots, failure = map(int, numbers)
        self.failure = FAILURES[failure]
        return self

    def motion(self):
        """Positions [m], velocities [m/s], angular velocities [rad/s], (N, 3) each, at the latest sample."""
        found = np.empty((3, self.grains, 3))
        self._of.collision_grains(self.handle, *(_pointer(array) for array in found))
        return found

    def contacts(self):
        """Pairs (M, 2) that touch, in order, normal forces (M,) [N], positive when repulsive, bonded (M,) bool."""
        pairs, state = np.empty((self._slots, 2), dtype=np.int32), np.empty(self._slots, dtype=np.int32)
        force = np.empty(self._slots)
        self._of.collision_slots(self.handle, _pointer(pairs), _pointer(state), _pointer(force))
        used = np.flatnonzero(state >= TOUCHING)
        pairs = np.sort(pairs[used], axis=1)
        order = np.lexsort(pairs.T[::-1])
        return pairs[order], force[used][order], (state[used] == BONDED)[order]

    def samples(self):
        """{name: (T,)} of the history so far: time [s], energies [J], counts, and sums over grains on either side."""
        names = (
            "time",
            *self.library.channels,
            "contacts",
            "contacts_between",
            "formed",
            "broken",
            *BROKEN_BONDS,
            *SIDES,
        )
        rows = np.empty((self._samples, len(names)))
        self._of.collision_samples(self.handle, _pointer(rows))
        return dict(zip(names, rows.T, strict=True))

    def save(self):
        """The whole state, bytes, for resumed() with the same library."""
        to = np.empty(self._of.collision_size(self.handle), dtype=np.uint8)
        self.library.require(self._of.collision_save(self.handle, _pointer(to)))
        return to.tobytes()

    def resumed(self, saved):
        """A Collision of these grains that goes on where save() left it."""
        other = copy(self)
        other.handle = ctypes.c_void_p(
            self.library.require(self._of.collision_resume(saved, ctypes.c_longlong(len(saved))))
        )
        return other.read()


def touching_pairs(position, radius, reach):
    """(M, 2) int32: pairs of grains that are no further apart than their radii, and `reach` of these more, in order."""
    tree = cKDTree(position)
    pairs = tree.query_pairs(2.001 * radius.max(), output_type="ndarray")
    apart = np.linalg.norm(position[pairs[:, 0]] - position[pairs[:, 1]], axis=1)
    pairs = np.sort(pairs[apart <= (1 + reach) * radius[pairs].sum(axis=1)], axis=1)
    return np.ascontiguousarray(pairs[np.lexsort(pairs.T[::-1])], dtype=np.int32)


def _pointer(array):
    return array.ctypes.data_as(ctypes.c_void_p)
