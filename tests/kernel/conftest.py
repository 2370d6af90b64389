"""Builds the kernel's probe once and wraps it with numpy."""

import ctypes
import os
import subprocess
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

HERE = Path(__file__).resolve().parent
MATERIALS = {
    "ice": (7e9, 0.25, 1000.0, 0.1, 0.8e-9, 0.0),
    "silicate": (54e9, 0.17, 2650.0, 0.02, 2e-9, 0.0),
    "viscous": (3e9, 0.33, 1300.0, 0.05, 1.1e-9, 4e-12),
}


def array(values):
    return np.ascontiguousarray(values, dtype=float)


class Kernel:
    """The C++ kernel by way of ctypes; vectors are arrays of 3, SI units, materials names."""

    materials = MATERIALS

    def __init__(self, library):
        self.library = library
        self.constant_names = self.names("constantNames")
        self.bond_constant_names = self.names("bondConstantNames")

    def names(self, function):
        getattr(self.library, function).restype = ctypes.c_char_p
        return getattr(self.library, function)().decode().split()

    def call(self, name, *arguments):
        as_c = {int: ctypes.c_int, float: ctypes.c_double, np.ndarray: lambda a: a.ctypes.data_as(ctypes.c_void_p)}
        getattr(self.library, name)(*(as_c[type(a)](a) for a in arguments))

    def constants(
        self,
        material1="ice",
        radius1=1e-7,
        material2="ice",
        radius2=1e-7,
        damping=0.0,
        sliding=1.0,
        rolling=1.0,
        springs=0.0,
        mixed=1.0,
    ):
        out = np.empty(len(self.constant_names))
        one, other = array(MATERIALS[material1]), array(MATERIALS[material2])
        options = map(float, (damping, sliding, rolling, springs, mixed))
        self.call("pairConstants", one, radius1, other, radius2, *options, out)
        return SimpleNamespace(array=out, **dict(zip(self.constant_names, out)))

    def cube_root(self, x):
        self.library.cubeRootOf.restype, self.library.cubeRootOf.argtypes = ctypes.c_double, [ctypes.c_double]
        return self.library.cubeRootOf(x)

    def normal_law(self, overlap):
        overlap = array(overlap)
        u, force, energy = np.empty((3, overlap.size))
        self.call("normalLaw", overlap.size, overlap, u, force, energy)
        return u, force, energy

    def contact(self, constants, separation, n1, n2, velocity=(0, 0, 0), twist=0.0):
        out = np.empty(14)
        self.call("contactAt", constants.array, array([*separation, *n1, *n2, *velocity, twist]), out)
        return SimpleNamespace(force=out[:3], drag=out[3], torque1=out[4:7], torque2=out[7:10], energies=out[10:])

    def return_to_limit(self, constants, normal, n1, n2, which, limit):
        pointers = array([*n1, *n2])
        self.call("returnToLimit", constants.array, array(normal), pointers, which, float(limit))
        return pointers[:3], pointers[3:]

    def neck(self, beta):
        out = np.empty(4)
        self.call("neckGeometry", beta, out)
        return SimpleNamespace(fillet=out[0], length=out[1], volume=out[2], shrunk_radius=out[3])

    def bond_constants(self, beta, material1="ice", radius1=1e-7, material2="ice", radius2=1e-7):
        out = np.empty(len(self.bond_constant_names))
        one, other = array(MATERIALS[material1]), array(MATERIALS[material2])
        self.call("bondConstants", one, radius1, other, radius2, beta, out)
        return SimpleNamespace(array=out, **dict(zip(self.bond_constant_names, out)))

    def bond(self, constants, rest, separation, n1, n2, twist=0.0):
        out = np.empty(13)
        self.call("bondAt", constants.array, float(rest), array([*separation, *n1, *n2, twist]), out)
        return SimpleNamespace(force=out[:3], torque1=out[3:6], torque2=out[6:9], energies=out[9:])

    def cut_passage(self, before, trial, limit):
        """(displacement of the last spring, mean displacement of all) of one that is cut at a limit on its way."""
        out = np.empty(6)
        self.call("cutPassage", array(before), array(trial), float(limit), out)
        return out[:3], out[3:]

    def turn(self, v, angle):
        out = np.empty(3)
        self.call("turn", array(v), array(angle), out)
        return out


@pytest.fixture(scope="session")
def kernel(tmp_path_factory):
    library = tmp_path_factory.mktemp("kernel") / "kernel_probe.so"
    compiler = os.environ.get("CXX", "g++")
    flags = "-std=c++17 -O2 -ffp-contract=off -Wall -Wextra -Werror -fPIC -shared".split()
    flags += os.environ.get("PROBE_FLAGS", "").split()  # tests/drivers/sanitizers.py
    subprocess.run([compiler, *flags, str(HERE / "kernel_probe.cpp"), "-o", str(library)], check=True)
    return Kernel(ctypes.CDLL(str(library)))
