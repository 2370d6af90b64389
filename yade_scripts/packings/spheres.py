"""Spheres in files of other programs. What a file holds decides about its format, not its name.

npz and VTK; the YAML of pyFracAggregate; and tables of text: xyz, extended xyz, LAMMPS data and dump, DustCollider,
and columns with or without names (csv, YADE, FracVAL, PyFracVAL, aggregate_gen). Of several frames the last one is
taken.

Sources: https://github.com/libAtoms/extxyz (Properties), https://docs.lammps.org (dump, read_data), YADE's
export.textExt, and files that the others write.
"""

import locale
import re
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from analysis.arrays import numbers
from analysis.runs.files import RunFolderError, array_names, read_arrays
from analysis.runs.folder import LARGEST
from yade_scripts.packings.packing import PackingError
from yade_scripts.parameters import one_line

FORMATS = "npz, csv, xyz, LAMMPS data or dump, VTK, YAML of pyFracAggregate, text of DustCollider, FracVAL or YADE"
IN_A_METRE = {"m": 1.0, "cm": 1e2, "mm": 1e3, "um": 1e6, "nm": 1e9}
POSITIONS = ("position", "positions", "pos", "xyz", "coordinates", "coords", "points", "centers", "centres")
# What programs call a column (LAMMPS, OVITO, pandas, ParaView); unwrapped coordinates come before wrapped ones.
COLUMNS = {
    axis: [f"{axis}u", axis]
    + [f"{name}{dot}{axis}" for name in ("pos", "position", "center", "centre") for dot in "_."]
    + [f"{name}{dot}{number}" for name in ("points", "pos", "position") for dot in ":_."]
    for number, axis in enumerate("xyz")
}
COLUMNS["radius"] = ["radius", "radii", "r", "rad", "shape.radius"]
COLUMNS["diameter"] = ["diameter", "diam"]
# https://docs.lammps.org/read_data.html, "Atoms section"
ATOM_STYLES = {
    "sphere": "id type diameter density x y z",
    "bpm/sphere": "id mol type diameter density x y z",
    "atomic": "id type x y z",
    "charge": "id type q x y z",
    "full": "id mol type q x y z",
    **dict.fromkeys(("bond", "molecular"), "id mol type x y z"),
}
SAMPLE = 2000  # values whose digits tell how finely a file is written


@dataclass(frozen=True)
class Spheres:
    """Spheres of a file, in its unit of length."""

    position: np.ndarray  # (N, 3)
    radius: np.ndarray | None  # (N,); None where the file has none
    about: str  # the format, and whether there are radii
    unit: str | None = None  # the file's own, if it names one

    @property
    def resolution(self):
        """The last digit that is written of a coordinate, in the file's unit. Programs write a fixed number of
        decimals, or of significant digits; numbers have the same shortest representation as in the text."""
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
    """Spheres of a file; names: of the columns of a table, instead of its own. Raises PackingError where the file is of
    none of FORMATS, has fewer than 2 grains or more than `most`, or holds what is no number."""
    with open(path, "rb") as file:
        content = file.read()
    start = content[:4096]
    try:
        if start.startswith(b"PK\x03\x04"):
            spheres = _of_npz(path)
        elif start.startswith((b"# vtk DataFile", b"<?xml", b"<VTKFile")):
            spheres = _of_vtk(path, start)
        elif b"aggregate:" in start and b"positions:" in start:
            spheres = _of_yaml(content)
        elif b"\0" in start:
            raise ValueError(f"of an unknown format; must be {FORMATS}")
        else:
            spheres = _of_text(content.decode("utf-8-sig", errors="replace"), names)
        if not 2 <= len(spheres.position) <= most:
            raise ValueError(f"holds {len(spheres.position)} grains; must be 2 to {most}")
    except (ValueError, RunFolderError) as error:
        raise PackingError(f"{path}: {one_line(error).removeprefix(f'{path}: ')}") from None
    return spheres


def _of_npz(path):
    """Positions in one array (N, 3), or an array for each axis."""
    names = array_names(path)
    together = [name for name in names if name.lower() in POSITIONS][:1]
    found = _columns(names, axes=() if together else "xyz")
    arrays = read_arrays(path, [*together, *(names[column] for column in found.values())])
    own = {"seed", "parameters"} <= set(names)  # of make_packing.py
    by_name = {name: arrays[names[column]] for name, column in found.items()}
    return _spheres("npz", by_name, arrays[together[0]] if together else None, "m" if own else None)


def _of_vtk(path, start):
    """The points of a legacy or XML file, with an array of radii."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkCommonCore import vtkLogger, vtkOutputWindow, vtkStringOutputWindow
    from vtkmodules.vtkIOLegacy import vtkGenericDataObjectReader
    from vtkmodules.vtkIOXML import vtkXMLGenericDataObjectReader

    problems = vtkStringOutputWindow()
    vtkOutputWindow.SetInstance(problems)
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)
    if start.startswith(b"# vtk"):
        reader = vtkGenericDataObjectReader()
        reader.ReadAllScalarsOn()
        reader.ReadAllFieldsOn()
    else:
        reader = vtkXMLGenericDataObjectReader()
    reader.SetFileName(path)
    own_locale = locale.setlocale(locale.LC_ALL)
    reader.Update()
    locale.setlocale(locale.LC_ALL, own_locale)  # VTK leaves C: text files would be ASCII from then on
    output = None if problems.GetOutput() else reader.GetOutputDataObject(0)
    if not hasattr(output, "GetPoints") or output.GetPoints() is None:
        raise ValueError("no points in it that VTK can read; must be points with their radii, such as grains.vtp")
    data = output.GetPointData()
    found = _columns([data.GetArrayName(number) for number in range(data.GetNumberOfArrays())], axes=())
    by_name = {name: vtk_to_numpy(data.GetArray(column)) for name, column in found.items()}
    return _spheres("VTK", by_name, vtk_to_numpy(output.GetPoints().GetData()))


def _of_yaml(content):
    """pyFracAggregate's aggregate: positions, radii, length_unit."""
    import yaml

    try:
        found = yaml.load(content, Loader=getattr(yaml, "CSafeLoader", yaml.SafeLoader))["aggregate"]
        position, radius = (np.array(found[name], dtype=float) for name in ("positions", "radii"))
    except (yaml.YAMLError, ValueError, KeyError, TypeError) as error:
        raise ValueError(f"not of pyFracAggregate ({error}); must have aggregate: positions, radii") from None
    unit = str(found.get("length_unit")).replace("\u03bc", "u").replace("\u00b5", "u")
    return _spheres("YAML", {"radius": radius}, position, unit if unit in IN_A_METRE else None)


# ---- tables of text ----


class Table(NamedTuple):
    """Where the grains are among the lines of a text."""

    kind: str
    first: int  # line at which they begin, from 0
    rows: int | None = None  # None: to the end
    names: list | None = None  # of the columns; None: not known
    separator: str | None = None  # None: blanks
    unit: str | None = None  # of length, if the format has one


def _of_text(text, names):
    lines = text.split("\n")
    table = _find_table(lines)
    names = names or table.names
    if names is None:
        raise ValueError(f"{table.kind}, columns without names; must be named, as in names=-,x,y,z,-,radius")
    found = _columns(names)
    rows = [line for line in lines[table.first :] if line.strip() and not line.startswith("#")][: table.rows]
    if len(rows) < (table.rows or 1):
        raise ValueError(f"{len(rows)} rows of numbers; must be {table.rows or '2 or more'}")
    try:
        array = np.loadtxt(rows, delimiter=table.separator, usecols=tuple(found.values()), ndmin=2)
    except ValueError as error:
        raise ValueError(f"not a table of numbers ({error})") from None
    return _spheres(table.kind, dict(zip(found, array.T)), unit=table.unit)


def _find_table(lines):
    head = [line.strip() for line in lines[:60]]
    if not any(head):
        raise ValueError("empty; must be a file of grains")
    if next(filter(None, head)).startswith("ITEM:"):
        return _dump(lines)
    if atoms := [number for number, line in enumerate(head) if re.match(r"\d+\s+atoms\b", line)]:
        return _data(lines, _count(lines, atoms[0]))
    if head[0].isdecimal():
        return _xyz(lines)
    words, rows = head[0].split(), [line.split() for line in head[5:] if line]
    if 3 <= len(words) < 7 and words[0].isdecimal() and rows and all(len(row) == 7 for row in rows):
        # aggregate.txt of DustCollider: N and two radii, four lines, the grains in nm
        names = ["x", "y", "z", "-", "radius", "-", "material"]
        return Table("DustCollider", 5, int(words[0]), names, unit="nm")
    return _plain(head)


def _count(lines, number):
    """The number of grains that a line begins with."""
    word = lines[number].split()[0] if lines[number].strip() else ""
    if not word.isdecimal():
        raise ValueError(f"line {number + 1}: '{word[:40]}' grains; must be a whole number > 0")
    return int(word)


def _frames(frames):
    return f"the last of {len(frames)} frames" if len(frames) > 1 else "one frame"


def _dump(lines):
    """ITEM: NUMBER OF ATOMS, a line with it, ..., ITEM: ATOMS and names, the grains; again for each frame."""
    counts = [number + 1 for number, line in enumerate(lines) if line.startswith("ITEM: NUMBER OF ATOMS")]
    frames = [number for number, line in enumerate(lines) if line.startswith("ITEM: ATOMS")]
    if not frames:
        raise ValueError("no ITEM: ATOMS; must have one")
    rows = _count(lines, counts[-1]) if counts else None
    return Table(f"LAMMPS dump, {_frames(frames)}", frames[-1] + 1, rows, lines[frames[-1]].split()[2:])


def _data(lines, rows):
    """N atoms in the header; Atoms # style, an empty line, the grains."""
    for number, line in enumerate(lines):
        if section := re.match(r"Atoms\b\s*(?:#\s*(\S+))?", line):
            names = ATOM_STYLES[section[1]].split() if section[1] in ATOM_STYLES else None
            return Table(f"LAMMPS data, atom style {section[1] or 'without name'}", number + 1, rows, names)
    raise ValueError("no section Atoms; must have one")


def _xyz(lines):
    """A number of grains, a line about them, the grains; again for each frame."""
    frames = [0]
    while (after := frames[-1] + 2 + _count(lines, frames[-1])) < len(lines) and lines[after].strip():
        frames.append(after)
    about, first = (lines[frames[-1] + 1 : frames[-1] + 3] + ["", ""])[:2]
    kind, names, row = "xyz", None, first.split()
    if properties := re.search(r'Properties="?([^"\s]+)', about):  # species:S:1:pos:R:3:radius:R:1
        kind, names, words = "extended xyz", [], properties[1].split(":")
        for name, count in zip(words[::3], words[2::3]):
            together = "xyz" if name.lower() in POSITIONS else [f"{name}_{part}" for part in range(int(count))]
            names += [name] if count == "1" else together
    elif len(row) in (4, 5) and not ("." in row[0] and _is_number(row[0])):
        names = ["species", "x", "y", "z", "radius"][: len(row)]  # x y z may be without a species: then not known
    return Table(f"{kind}, {_frames(frames)}", frames[-1] + 2, _count(lines, frames[-1]), names)


def _plain(head):
    """Comments with #, a line of names or none, the grains."""
    comments = [line.lstrip("# ") for line in head if line.startswith("#")]
    at = next((number for number, line in enumerate(head) if line and not line.startswith("#")), None)
    if at is None:
        raise ValueError(f"{len(head)} lines of comments; must be followed by grains")
    separator = next((mark for mark in ",;" if mark in head[at]), None)
    words = head[at].split(separator)
    if len(words) == 1:
        raise ValueError(f"of an unknown format; must be {FORMATS}")
    if not any(map(_is_number, words)):
        return Table("table", at + 1, None, words, separator)
    names = ["x", "y", "z", "radius"][: len(words)] if len(words) <= 4 else None
    for comment in comments:
        of_yade = re.match(r"format (x_y_z_\S*|\S+_x_y_z_\S*)$", comment)
        in_comment = of_yade[1].split("_") if of_yade else comment.split(separator)
        if {"x", "y", "z"} <= {word.strip().lower() for word in in_comment}:
            names = in_comment
    return Table("table", at, None, names, separator)


def _is_number(word):
    try:
        float(word)
    except ValueError:
        return False
    return True


# ---- columns ----


def _columns(names, axes="xyz"):
    """{name of COLUMNS: number of the column} of the names of a file's columns, which must have `axes` among them;
    names go without case, quotes and a unit in brackets."""
    plain = [re.sub(r"[\[(].*[\])]", "", str(name)).strip(" \t\"'_").lower() for name in names]
    found = {}
    for name, aliases in COLUMNS.items():
        if there := [alias for alias in aliases if alias in plain]:
            found[name] = plain.index(there[0])
    if missing := [axis for axis in axes if axis not in found]:
        raise ValueError(
            f"no {' '.join(missing)} among its columns {', '.join(map(str, names))[:100]}; must be there, or "
            "names=x,y,z,radius must name the columns, - for those without use"
        )
    return {name: column for name, column in found.items() if axes or name not in "xyz"}


def _spheres(kind, by_name, position=None, unit=None):
    """Spheres of arrays (N,) by the names of COLUMNS; position (N, 3) in place of x, y, z."""
    if position is None:
        position = np.stack([by_name[axis] for axis in "xyz"], axis=-1)
    numbers("position", position, (None, 3), least=-LARGEST, most=LARGEST)
    name = next((name for name in ("radius", "diameter") if name in by_name), None)
    if name is None:
        return Spheres(position, None, f"{kind}, without radii", unit)
    sizes = numbers(name, by_name[name], (len(position),), positive=True, most=LARGEST)
    radius = sizes / 2 if name == "diameter" else by_name[name]
    return Spheres(position, radius, f"{kind}, with {'radii' if name == 'radius' else 'diameters'}", unit)
