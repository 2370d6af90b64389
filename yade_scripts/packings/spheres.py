"""Spheres in files of other programs: npz, VTK, the YAML of pyFracAggregate, and tables of text (text_table.py).

What a file holds decides about its format, not its name.
"""

import locale
import os
import re
from dataclasses import dataclass

import numpy as np
import pandas

from analysis.runs.files import RunFolderError, array_names, read_arrays
from analysis.runs.folder import LARGEST
from analysis.runs.table import EXACTLY
from yade_scripts.packings.packing import PackingError
from yade_scripts.packings.text_table import FORMATS, find_table

IN_A_METRE = {"m": 1.0, "cm": 1e2, "mm": 1e3, "um": 1e6, "nm": 1e9}
POSITIONS = ("position", "positions", "pos", "xyz", "coordinates", "coords", "points", "centers", "centres")
RADII = ("radius", "radii", "r", "rad", "shape.radius")
DIAMETERS = ("diameter", "diam")
IGNORED = "-"
SAMPLE = 2000  # values whose digits tell how finely a file is written


@dataclass(frozen=True)
class Spheres:
    """Spheres of a file.

    Attributes
    ----------
    position : (N, 3) array
    radius : (N,) array or None
        None where the file has none; in the file's unit of length.
    about : str
        The format and the columns that were taken, in a few words.
    unit : str or None
        The file's own, if it names one.
    """

    position: np.ndarray
    radius: np.ndarray | None
    about: str
    unit: str | None = None

    @property
    def resolution(self):
        """The last digit that is written of a coordinate, in the file's unit.

        Programs write a fixed number of decimals, or of significant digits. Numbers that were read from text have the
        same shortest representation as there; so have those of 32 bits.
        """
        array = self.position.ravel()
        sample = array[np.linspace(0, array.size - 1, min(array.size, SAMPLE)).astype(int)]
        written = [np.format_float_scientific(number).split("e") for number in sample if number]
        if not written:
            return 0.0
        digits = [len(mantissa.strip("-0.").replace(".", "")) for mantissa, _ in written]
        decimals = max(count - 1 - int(exponent) for count, (_, exponent) in zip(digits, written))
        largest = int(np.floor(np.log10(np.abs(array).max())))
        return 10.0 ** max(-decimals, largest - (max(digits) - 1))


def read_spheres(path, most, names=None):
    """Spheres of a file.

    Parameters
    ----------
    path : str
    most : int
        Largest number of grains.
    names : list of str, optional
        Of the columns of a table, instead of its own.

    Returns
    -------
    Spheres

    Raises
    ------
    PackingError
        Where the file is none of FORMATS, has too many grains or holds what is no number.
    """
    if os.path.exists(path) and not os.path.isfile(path):
        raise PackingError(f"{path}: is no regular file; must be one")
    with open(path, "rb") as file:
        start = file.read(4096)
    if start.startswith(b"PK\x03\x04"):
        reader = _of_npz
    elif start.startswith((b"# vtk DataFile", b"<?xml", b"<VTKFile")):
        reader = _of_vtk
    elif b"aggregate:" in start and b"positions:" in start:
        reader = _of_yaml
    elif b"\0" in start:
        raise PackingError(f"{path}: of an unknown format; must be {FORMATS}")
    else:
        reader = None
    if reader and names:
        raise PackingError(f"names = {','.join(names)}: {path} is no table; must be left out")
    spheres = reader(path) if reader else _of_table(path, most, names)
    if not 2 <= len(spheres.position) <= most:
        raise PackingError(f"{path}: holds {len(spheres.position)} grains; must be 2 to {most}")
    return spheres


def _of_npz(path):
    """Pickled objects are refused, never loaded."""
    try:
        names = array_names(path)
        together = next((name for name in names if name.lower() in POSITIONS), None)
        found = _roles(names)
        arrays = read_arrays(path, [*([together] if together else []), *(names[column] for column in found.values())])
    except RunFolderError as error:
        raise PackingError(f"{error}; must be an .npz with position (N, 3) and radius (N,)") from None
    if together is None:
        _require_axes(path, found, names)
    by_role = {role: arrays[names[column]] for role, column in found.items()}
    return _spheres(path, "npz", by_role, "m" if {"seed", "parameters"} <= set(names) else None, arrays.get(together))


def _of_vtk(path):
    """A legacy or XML file of VTK: its points, with an array of radii."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkCommonCore import vtkLogger, vtkOutputWindow, vtkStringOutputWindow
    from vtkmodules.vtkIOLegacy import vtkGenericDataObjectReader
    from vtkmodules.vtkIOXML import vtkXMLGenericDataObjectReader

    with open(path, "rb") as file:
        legacy = file.read(5) == b"# vtk"
    reader = vtkGenericDataObjectReader() if legacy else vtkXMLGenericDataObjectReader()
    problems = vtkStringOutputWindow()
    vtkOutputWindow.SetInstance(problems)
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)
    reader.SetFileName(path)
    if legacy:
        reader.ReadAllScalarsOn()
        reader.ReadAllFieldsOn()
    own_locale = locale.setlocale(locale.LC_ALL)
    try:
        reader.Update()
    finally:
        locale.setlocale(locale.LC_ALL, own_locale)  # VTK leaves C: text files would be ASCII from then on
    output = None if problems.GetOutput() else reader.GetOutputDataObject(0)
    if not hasattr(output, "GetPoints") or output.GetPoints() is None:
        must = "must be a file of points with their radii, such as state_NNNNNN/grains.vtp of an export"
        raise PackingError(f"{path}: no points in it that VTK can read; {must}")
    data = output.GetPointData()
    names = [data.GetArrayName(number) for number in range(data.GetNumberOfArrays())]
    by_role = {role: vtk_to_numpy(data.GetArray(column)) for role, column in _roles(names).items() if role not in "xyz"}
    return _spheres(path, "VTK", by_role, None, vtk_to_numpy(output.GetPoints().GetData()))


def _of_yaml(path):
    """pyFracAggregate's aggregate: positions, radii, length_unit."""
    import yaml

    try:
        with open(path, encoding="utf-8", errors="replace") as file:
            found = yaml.load(file, Loader=getattr(yaml, "CSafeLoader", yaml.SafeLoader))["aggregate"]
        position, radius = (np.array(found[name], dtype=float) for name in ("positions", "radii"))
    except (yaml.YAMLError, ValueError, KeyError, TypeError, RecursionError) as error:
        reason = " ".join(str(error).split())[:100]
        raise PackingError(
            f"{path}: not of pyFracAggregate ({reason}); must have aggregate: positions, radii"
        ) from None
    unit = str(found.get("length_unit")).replace("\u03bc", "u").replace("\u00b5", "u")
    return _spheres(path, "YAML", {"radius": radius}, unit if unit in IN_A_METRE else None, position)


def _of_table(path, most, names):
    table = find_table(path)
    names = names or table.names
    if names is None:
        raise PackingError(
            f"{path}: {table.kind}, columns without names; must be named, as in names={IGNORED},x,y,z,{IGNORED},radius"
        )
    found = _roles(names)
    _require_axes(path, found, names)
    if table.rows is not None and table.rows > most:
        raise PackingError(f"{path}: holds {table.rows} grains; must be 2 to {most}")
    try:
        frame = pandas.read_csv(
            path,
            sep=table.separator,
            header=None,
            skiprows=table.first,
            nrows=most + 1 if table.rows is None else table.rows,
            comment="#",
            skipinitialspace=True,
            encoding="utf-8-sig",
            encoding_errors="replace",
            low_memory=False,
            **EXACTLY,
        )
    except pandas.errors.EmptyDataError:
        raise PackingError(f"{path}: no rows of numbers; must have 2 or more") from None
    except ValueError as error:  # rows of unequal length
        reason = " ".join(str(error).split())
        raise PackingError(
            f"{path}: not a table of numbers ({reason}); must have the same columns in all rows"
        ) from None
    if max(found.values()) >= frame.shape[1]:
        raise PackingError(f"{path}: {frame.shape[1]} columns; must have those of {', '.join(names)}")
    if table.rows is not None and len(frame) < table.rows:
        raise PackingError(f"{path}: {len(frame)} rows of numbers; must be {table.rows}, by its header")
    numbers = {role: pandas.to_numeric(frame[column], errors="coerce").to_numpy() for role, column in found.items()}
    return _spheres(path, table.kind, numbers, table.unit)


def _roles(names):
    """{x, y, z and radius or diameter: number of the column} among the names of a file's columns, where they are there.

    Names go without case, quotes and a unit in brackets; unwrapped coordinates come before wrapped ones.
    """
    plain = [re.sub(r"[\[(].*[\])]", "", str(name)).strip(" \t\"'_").lower() for name in names]
    wanted = {axis: _names_of_axis(axis, number) for number, axis in enumerate("xyz")}
    wanted.update(radius=RADII, diameter=DIAMETERS)
    found = {
        role: next((plain.index(name) for name in aliases if name in plain), None) for role, aliases in wanted.items()
    }
    return {role: column for role, column in found.items() if column is not None}


def _names_of_axis(axis, number):
    """What programs call a coordinate: LAMMPS, OVITO, pandas, ParaView."""
    of_axis = [f"{prefix}{dot}{axis}" for prefix in ("pos", "position", "center", "centre") for dot in "_."]
    of_number = [f"{prefix}{dot}{number}" for prefix in ("points", "pos", "position") for dot in ":_."]
    return (f"{axis}u", axis, *of_axis, *of_number)


def _require_axes(path, found, names):
    """Raise PackingError unless _roles() found x, y and z among the names."""
    if missing := [axis for axis in "xyz" if axis not in found]:
        named = ", ".join(map(str, names))
        named = named if len(named) <= 100 else named[:100] + "..."
        raise PackingError(
            f"{path}: no {' '.join(missing)} among its columns {named}; must be there, or names=x,y,z,radius must name "
            f"the columns, {IGNORED} for those without use"
        )


def _spheres(path, kind, by_role, unit=None, position=None):
    """Spheres of arrays {x, y, z, and radius or diameter if there are: (N,)}, or of positions (N, 3) in place of x, y,
    z."""
    if position is not None:
        if position.ndim != 2 or position.shape[1] != 3:
            raise PackingError(f"{path}: positions have the shape {position.shape}; must be (N, 3)")
        by_role = {**by_role, **dict(zip("xyz", position.T))}
    grains = len(by_role["x"]) if by_role["x"].ndim else 0
    for role, array in by_role.items():
        if array.shape != (grains,):
            raise PackingError(
                f"{path}: {role} has the shape {array.shape}, positions are {grains}; must be ({grains},)"
            )
        if array.dtype.kind not in "fiu":
            raise PackingError(f"{path}: {role} is no finite number; must be one")
        for number in np.flatnonzero(~(np.abs(array) < LARGEST))[:1]:
            must = f"must be a finite number below {LARGEST:g}"
            raise PackingError(f"{path}: {role} of grain {number} is {array[number]:g}; {must}")
    radius = by_role.get("radius")
    if radius is None and "diameter" in by_role:
        radius = by_role["diameter"] / 2
    if radius is not None and len(radius) and radius.min() <= 0:
        raise PackingError(f"{path}: radius of grain {radius.argmin()} is {radius.min():g}; must be > 0")
    sizes = "without radii" if radius is None else "with radii" if "radius" in by_role else "with diameters"
    position = np.stack([by_role[axis] for axis in "xyz"], axis=1)
    return Spheres(position, radius, f"{kind}, {sizes}", unit)
