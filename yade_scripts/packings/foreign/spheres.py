"""Spheres of a file, and which of its columns they are."""

import re
from dataclasses import dataclass

import numpy as np

from analysis.runs.folder import LARGEST
from yade_scripts.packings.packing import PackingError

FORMATS = "npz, csv, xyz, LAMMPS data or dump, VTK, YAML of pyFracAggregate, text of DustCollider, FracVAL or YADE"
IN_A_METRE = {"m": 1.0, "cm": 1e2, "mm": 1e3, "um": 1e6, "nm": 1e9}
RADII = ("radius", "radii", "r", "rad", "shape.radius")
DIAMETERS = ("diameter", "diam")
IGNORED = "-"
SAMPLE = 2000  # values whose digits tell how finely a file is written


@dataclass(frozen=True)
class Spheres:
    """position (N,3) and radius (N,), or None where the file has none, in the file's unit of length.

    about: the format and the columns that were taken, in a few words; unit: the file's own, where it says one."""

    position: np.ndarray
    radius: np.ndarray | None
    about: str
    unit: str | None = None

    @property
    def resolution(self):
        """The last digit that is written of a coordinate, in the file's unit.

        Programs write a fixed number of decimals, or of significant digits. Numbers that were read from text have the same
        shortest representation as there; so have those of 32 bits."""
        array = self.position.ravel()
        sample = array[np.linspace(0, array.size - 1, min(array.size, SAMPLE)).astype(int)]
        written = [np.format_float_scientific(number).split("e") for number in sample if number]
        if not written:
            return 0.0
        digits = [len(mantissa.strip("-0.").replace(".", "")) for mantissa, _ in written]
        decimals = max(count - 1 - int(exponent) for count, (_, exponent) in zip(digits, written))
        largest = int(np.floor(np.log10(np.abs(array).max())))
        return 10.0 ** max(-decimals, largest - (max(digits) - 1))


def roles(names):
    """{x, y, z and radius or diameter: number of the column} among the names of a file's columns, as far as they are there.

    Names go without case, quotes and a unit in brackets; unwrapped coordinates come before wrapped ones."""
    plain = [re.sub(r"[\[(].*[\])]", "", str(name)).strip(" \t\"'_").lower() for name in names]
    wanted = {axis: _of_axis(axis, number) for number, axis in enumerate("xyz")}
    wanted.update(radius=RADII, diameter=DIAMETERS)
    found = {
        role: next((plain.index(name) for name in aliases if name in plain), None) for role, aliases in wanted.items()
    }
    return {role: column for role, column in found.items() if column is not None}


def _of_axis(axis, number):
    """What programs call a coordinate: LAMMPS, OVITO, pandas, ParaView."""
    of_axis = [f"{prefix}{dot}{axis}" for prefix in ("pos", "position", "center", "centre") for dot in "_."]
    of_number = [f"{prefix}{dot}{number}" for prefix in ("points", "pos", "position") for dot in ":_."]
    return (f"{axis}u", axis, *of_axis, *of_number)


def spheres_of(path, kind, arrays, unit=None):
    """Spheres from arrays {x, y, z, and radius or diameter if there are: (N,)} of numbers, checked.

    Raises PackingError when one holds what is no finite number, or one beyond LARGEST, or a radius is not positive."""
    for name, array in arrays.items():
        if array.dtype.kind not in "fiu":
            raise PackingError(f"{path}: {name} is no finite number; must be one")
        sound = np.abs(array) < LARGEST
        if not sound.all():
            value, where = array[sound.argmin()], f"{name} of grain {sound.argmin()} is"
            what = (
                f"{value:g}; must be less than {LARGEST:g}" if np.isfinite(value) else "no finite number; must be one"
            )
            raise PackingError(f"{path}: {where} {what}")
    position = np.stack([arrays[axis] for axis in "xyz"], axis=1)
    radius = arrays.get("radius")
    if radius is None and "diameter" in arrays:
        radius = arrays["diameter"] / 2
    if radius is not None and len(radius) and radius.min() <= 0:
        raise PackingError(f"{path}: radius of grain {radius.argmin()} is {radius.min():g}; must be > 0")
    sizes = "without radii" if radius is None else "with radii" if "radius" in arrays else "with diameters"
    return Spheres(position, radius, f"{kind}, {sizes}", unit)


def require_axes(path, found, names):
    """Raise PackingError unless roles() found x, y and z among the names."""
    if missing := [axis for axis in "xyz" if axis not in found]:
        named = ", ".join(map(str, names))
        named = named if len(named) <= 100 else named[:100] + "..."
        raise PackingError(
            f"{path}: no {' '.join(missing)} among its columns {named}; must be there, or names=x,y,z,radius must name "
            f"the columns, {IGNORED} for those without use"
        )
