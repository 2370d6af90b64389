"""Spheres in files of other programs. What a file holds decides about its format, not its name.

npz and VTK; the YAML of pyFracAggregate; and tables of text: xyz, extended xyz, LAMMPS data and dump, DustCollider,
and columns with or without names (csv, YADE, FracVAL, PyFracVAL, aggregate_gen). Of several frames the last one is
taken.

Sources: https://github.com/libAtoms/extxyz (Properties), https://docs.lammps.org (dump, read_data), YADE's
export.textExt, and files that the others write.
"""

import codecs
import csv
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
IN_A_METRE = {"m": 1.0, "cm": 1e2, "mm": 1e3, "um": 1e6, "nm": 1e9, "angstrom": 1e10}
LAMMPS_UNITS = {"si": "m", "cgs": "cm", "micro": "um", "nano": "nm"}  # its styles of units, as far as we have theirs
METRES = "met(?:re|er)s?"
SPELLED = {  # as files write them, words in any case
    "m": f"m|(?i:{METRES})",
    "cm": f"cm|(?i:centi{METRES})|1e-0?2 m",
    "mm": f"mm|(?i:milli{METRES})|1e-0?3 m",
    "um": f"[u\u00b5\u03bc]m|(?i:micro{METRES}|microns?)|1e-0?6 m",
    "nm": f"nm|(?i:nano{METRES})|1e-0?9 m",
    "angstrom": "[\u00c5\u212b]|(?i:[a\u00e5]ngstr[o\u00f6]ms?)|1e-10 m",
}
LENGTH = f"({'|'.join(SPELLED.values())})"
COMMENT = ("#", "%", "!", "//")  # what comments begin with: Python, Matlab, Fortran, C
FORTRAN = re.compile(r"(?<=[\d.])[dD](?=[+-]?\d)")  # the exponent of a double, 1.0D+00
POSITIONS = ("position", "positions", "pos", "xyz", "coordinates", "coords", "points", "centers", "centres")
# What programs call a column (LAMMPS, OVITO, pandas, ParaView); unwrapped coordinates come before wrapped ones.
COLUMNS = {
    axis: [f"{axis}u", axis]
    + [f"{name}{dot}{axis}" for name in ("pos", "position", "center", "centre") for dot in "_. "]
    + [f"{name}{dot}{number}" for name in ("points", "pos", "position") for dot in ":_."]
    for number, axis in enumerate("xyz")
}
COLUMNS["radius"] = ["radius", "radii", "r", "rad", "shape.radius"]
COLUMNS["diameter"] = ["diameter", "diam"]
COLUMNS |= {f"i{axis}": [f"i{axis}"] for axis in "xyz"}  # LAMMPS: boxes that a grain has left along the axis
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
    resolution: float  # the last digit that is written of a coordinate
    unit: str | None = None  # the file's own, if it names one
    cell: np.ndarray | None = None  # (3,), edges of a box in which positions may be wrapped, infinite across open sides


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
        elif re.search(rb"^aggregate:", start, re.MULTILINE):
            spheres = _of_yaml(content)
        elif start.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):  # of Windows
            spheres = _of_text(content.decode("utf-16", errors="replace"), names)
        elif b"\0" in start:
            raise ValueError(f"of an unknown format; must be {FORMATS}")
        else:
            spheres = _of_text(content.decode("utf-8-sig", errors="replace"), names)
        if not 2 <= len(spheres.position) <= most:
            raise ValueError(f"holds {len(spheres.position)} grains; must be 2 to {most}")
    except (ValueError, RunFolderError, csv.Error) as error:
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
    return _spheres("YAML", {"radius": radius}, position, _unit([str(found.get("length_unit"))]))


# ---- tables of text ----


class Box(NamedTuple):
    """A box of LAMMPS along the axes, or of extended xyz."""

    low: np.ndarray  # (3,)
    edges: np.ndarray  # (3,)
    periodic: np.ndarray  # (3,), of bool


class Table(NamedTuple):
    """Where the grains are among the lines of a text."""

    kind: str
    first: int  # line at which they begin, from 0
    rows: int | None = None  # None: to the end
    names: list | None = None  # of the columns; None: not known
    separator: str | None = None  # None: blanks
    unit: str | None = None  # of length, if the format has one
    box: Box | None = None
    scaled: bool = False  # whether coordinates are fractions of the box


def _of_text(text, names):
    lines = re.split(r"\r\n?|\n", text)
    table = _find_table(lines)
    names = names or table.names
    if names is None:
        raise ValueError(f"{table.kind}, columns without a name; must be named, as in names=-,x,y,z,-,radius")
    found = _columns(names)
    is_row = lambda line: line.strip() and not line.lstrip().startswith(COMMENT)
    rows = list(filter(is_row, lines[table.first :]))[: table.rows]
    if len(rows) < (table.rows or 1):
        raise ValueError(f"{table.kind}: {len(rows)} rows of numbers; must be {table.rows or '2 or more'}")
    rows = [FORTRAN.sub("e", line.replace(",", ".") if table.separator == ";" else line) for line in rows]
    try:
        array = np.loadtxt(rows, delimiter=table.separator, usecols=tuple(found.values()), ndmin=2, quotechar='"')
    except ValueError as error:
        raise ValueError(f"not a table of numbers ({error})") from None
    unit = _unit([table.unit, *(_parted(names[column])[1] for column in found.values())])
    return _spheres(table.kind, dict(zip(found, array.T)), unit=unit, box=table.box, scaled=table.scaled)


def _find_table(lines):
    head = [line.strip() for line in lines[:60]]
    if not any(head):
        raise ValueError("empty; must be a file of grains")
    if next(filter(None, head)).startswith("ITEM:"):
        return _dump(lines)
    if head[0].isdecimal():
        if head[1:2] != [""] and sum(map(bool, map(str.strip, lines))) == int(head[0]) + 1:  # without a line about them
            return _plain(["", *lines[1:]])
        return _xyz(lines)
    atoms = [number for number, line in enumerate(head) if re.match(r"\d+\s+atoms\b", line)]
    if atoms and (section := next((n for n, line in enumerate(lines) if re.match(r"Atoms\b", line)), None)):
        return _data(lines, _count(lines, atoms[0]), section)
    words, rows = head[0].split(), [line.split() for line in head[5:] if line]
    if 3 <= len(words) < 7 and words[0].isdecimal() and rows and all(len(row) == 7 for row in rows):
        # aggregate.txt of DustCollider: N and two radii, four lines, the grains in nm
        names = ["x", "y", "z", "-", "radius", "-", "material"]
        return Table("DustCollider", 5, int(words[0]), names, unit="nm")
    return _plain(lines)


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
    items = {}
    for number, line in enumerate(lines):
        if item := re.match(r"ITEM: (UNITS|NUMBER OF ATOMS|BOX BOUNDS|ATOMS)\b", line):
            items.setdefault(item[1], []).append(number)
    frames = items.get("ATOMS")
    if not frames:
        raise ValueError("no ITEM: ATOMS; must have one")
    rows = _count(lines, items["NUMBER OF ATOMS"][-1] + 1) if "NUMBER OF ATOMS" in items else None
    names = lines[frames[-1]].split()[2:]
    scaled = not {"x", "xu"} & set(names)  # xs, xsu: of the box
    if scaled:
        names = [re.sub(r"^([xyz])s(u?)$", r"\1\2", name) for name in names]
    unwrapped = "xu" in names
    if unwrapped:
        names = ["-" if name in ("ix", "iy", "iz") else name for name in names]
    unit = LAMMPS_UNITS.get(lines[items["UNITS"][0] + 1].strip()) if "UNITS" in items else None
    at = items.get("BOX BOUNDS", [None])[-1]
    box = None
    if at is not None and (scaled or not unwrapped):
        box = _box([line.split()[:3] for line in lines[at + 1 : at + 4]], lines[at].split()[-3:])
    if scaled and box is None:
        raise ValueError("coordinates in units of a box, and no box; must be x y z or xu yu zu")
    kind = f"LAMMPS dump, {_frames(frames)}"
    return Table(kind, frames[-1] + 1, rows, names, unit=unit, box=box, scaled=scaled)


def _data(lines, rows, section):
    """N atoms and the box in the header; Atoms # style, an empty line, the grains."""
    style = re.match(r"Atoms\b\s*(?:#\s*(\S+))?", lines[section])[1]
    names = ATOM_STYLES[style].split() + ["ix", "iy", "iz"] if style in ATOM_STYLES else None
    first = next((line.partition("#")[0].split() for line in lines[section + 1 :] if line.strip()), [])
    if names and len(first) < len(names):
        names = names[:-3]
    head = [line.split() for line in lines[:section]]
    bounds = [next((line[:2] for line in head if line[2:4] == [f"{axis}lo", f"{axis}hi"]), []) for axis in "xyz"]
    tilts = next((line[:3] for line in head if line[3:6] == ["xy", "xz", "yz"]), "000")
    box = _box([[*bound, tilt] for bound, tilt in zip(bounds, tilts)], ["pp"] * 3)
    unit = re.search(r"\bunits = (\w+)", lines[0])
    kind = f"LAMMPS data, atom style {style or 'without name'}"
    return Table(kind, section + 1, rows, names, unit=LAMMPS_UNITS.get(unit and unit[1]), box=box)


def _box(bounds, boundaries):
    """Box of texts low, high and maybe a tilt for each axis; None where it is not given."""
    try:
        numbers = [[float(text) for text in bound] for bound in bounds]
        low, high = np.array([bound[:2] for bound in numbers]).T
    except ValueError:
        return None
    if any(tilt for bound in numbers for tilt in bound[2:]):
        raise ValueError("in a tilted box; must be in coordinates that go on beyond it, xu yu zu")
    return Box(low, high - low, np.array([text == "pp" for text in boundaries]))


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
    rows, unit = _count(lines, frames[-1]), _unit_in([about])
    return Table(f"{kind}, {_frames(frames)}", frames[-1] + 2, rows, names, unit=unit, box=_lattice(about))


def _lattice(about):
    """Box of the line about a frame, Lattice="Lx 0 0 0 Ly 0 0 0 Lz" pbc="T T F"; None without, and of a tilted one."""
    found = re.search(r'Lattice="([^"]*)"', about)
    edges = np.array(found[1].split() if found else [], dtype=float)
    if edges.size != 9 or np.count_nonzero(edges) != 3 or not edges[::4].all():
        return None
    periodic = re.search(r'pbc="(\S+) (\S+) (\S+)"', about) or " TTT"
    return Box(np.zeros(3), edges[::4], np.array([periodic[side][0] in "T1" for side in (1, 2, 3)]))


def _plain(lines):
    """Comments, a line of names or none, the grains."""
    used, comments = ((number, line.strip()) for number, line in enumerate(lines) if line.strip()), []
    for at, line in used:
        if not line.startswith(COMMENT):
            break
        comments.append(line.lstrip("#%!/ \t"))
    else:
        raise ValueError(f"{len(comments)} lines of comments; must be followed by grains")
    second, row = next(used, (at, line))
    separator, unit = next((mark for mark in ";,\t" if mark in line), None), _unit_in(comments)
    head, row = _words(line, separator), _words(row, separator)
    if len(head) < 2:
        raise ValueError(f"of an unknown format; must be {FORMATS}")
    if not any(map(_is_number, head)):
        if len(row) == len(head) + 1 and not separator:  # of pandas and R: the number of a row has no name
            head = ["-", *head]
        if len(row) != len(head):
            return Table(f"table with {len(head)} names", second, None, None, separator, unit)
        return Table("table", second, None, head, separator, unit)
    names = ["x", "y", "z", "radius"][: len(head)] if len(head) <= 4 else None
    for comment in comments:
        of_yade = re.match(r"format (x_y_z_\S*|\S+_x_y_z_\S*)$", comment)
        plain = re.sub(r"^[\w ]+[:=]\s", "", comment)  # columns: x y z
        for words in (of_yade[1].split("_") if of_yade else [], _words(plain, separator), _words(plain)):
            if len(words) == len(head) and {"x", "y", "z"} <= set(_found(words)):
                names = words
    return Table("table", at, None, names, separator, unit)


def _words(line, separator=None):
    """The cells of a line, without a comment and a separator at its end."""
    line = re.sub(r"\s#\s.*", "", line).strip()
    if separator == "\t" or separator and separator in line:
        (words,) = csv.reader([line.rstrip(separator)], delimiter=separator, skipinitialspace=True)
        return [word.strip() for word in words]
    return re.findall(r'"[^"]*"|[^\s,;]+', re.sub(r"\s+(?=[\[(])", "", line))


def _is_number(word):
    try:
        float(FORTRAN.sub("e", word.strip('"').replace(",", ".")))
    except ValueError:
        return False
    return True


# ---- columns ----


def _columns(names, axes="xyz"):
    """{name of COLUMNS: number of the column} of the names of a file's columns, which must have `axes` among them."""
    found = _found(names)
    if missing := [axis for axis in axes if axis not in found]:
        raise ValueError(
            f"no {' '.join(missing)} among its columns {', '.join(map(str, names))[:100]}; must be there, or "
            "names=x,y,z,radius must name the columns, - for those without use"
        )
    return {name: column for name, column in found.items() if axes or name not in "xyz"}


def _found(names):
    """{name of COLUMNS: number of the column} of names, whatever their case, quotes and units."""
    plain = [_parted(name)[0] for name in names]
    first = {name: next((alias for alias in aliases if alias in plain), None) for name, aliases in COLUMNS.items()}
    return {name: plain.index(alias) for name, alias in first.items() if alias}


def _parted(name):
    """(name in small letters, unit or None) of a column such as x, "X [nm]", x (m), x_um or 1:x."""
    name = re.sub(r"^[\[(]?\d+[\])]?[:=]", "", str(name).strip(" \t\"'"))
    unit = re.search(rf"[\[(]\s*{LENGTH}\s*[\])]|[_ ]{LENGTH}$", name)
    plain = name[: unit.start()] if unit else re.sub(r"[\[(].*[\])]", "", name)
    return plain.strip(" \t\"'_").lower(), unit and (unit[1] or unit[2])


def _unit_in(comments):
    """The unit of length that comments name, as in: lengths in nm, unit: um, (nanometres); None without one."""
    after = rf"(?:\bin\s+|(?:\b|_)units?\b[\w ]{{0,12}}[:=\s]\s*){LENGTH}(?![\w/^*]|\s+per\b)"
    found = [re.findall(rf"{after}|[\[(]\s*{LENGTH}\s*[\])]", line) for line in comments]
    return _unit([unit for units in found for pair in units for unit in pair])


def _unit(units):
    """The one of IN_A_METRE that all of a list name, as far as they name one; None where none does."""
    known = {name for unit in units for name, spelled in SPELLED.items() if re.fullmatch(spelled, str(unit))}
    if len(known) > 1:
        raise ValueError(f"names several units of length, {', '.join(sorted(known))}; must be in one")
    return next(iter(known), None)


def _spheres(kind, by_name, position=None, unit=None, box=None, scaled=False):
    """Spheres of arrays (N,) by the names of COLUMNS; position (N, 3) in place of x, y, z."""
    if position is None:
        position = np.stack([by_name[axis] for axis in "xyz"], axis=-1)
    numbers("position", position, (None, 3), least=-LARGEST, most=LARGEST)
    digit = _resolution(position) * (box.edges.max() if scaled else 1.0)
    cell = None
    if scaled:
        position = box.low + position * box.edges
    if box is not None:
        cell = np.where(box.periodic, box.edges, np.inf)
        if {"ix", "iy", "iz"} <= set(by_name):
            position = position + box.edges * np.stack([by_name[f"i{axis}"] for axis in "xyz"], axis=-1)
    name = next((name for name in ("radius", "diameter") if name in by_name), None)
    if name is None:
        return Spheres(position, None, f"{kind}, without radii", digit, unit, cell)
    sizes = numbers(name, by_name[name], (len(position),), positive=True, most=LARGEST)
    radius = sizes / 2 if name == "diameter" else by_name[name]
    about = f"{kind}, with {'radii' if name == 'radius' else 'diameters'}"
    return Spheres(position, radius, about, digit, unit, cell)


def _resolution(position):
    """The last digit that is written of a coordinate. Programs write a fixed number of decimals, or of significant
    digits; numbers have the same shortest representation as in the text."""
    array = position.ravel()
    sample = array[np.linspace(0, array.size - 1, min(array.size, SAMPLE)).astype(int)]
    written = [np.format_float_scientific(number).split("e") for number in sample if number]
    if not written:
        return 0.0
    digits = [len(mantissa.strip("-0.").replace(".", "")) for mantissa, _ in written]
    decimals = max(count - 1 - int(exponent) for count, (_, exponent) in zip(digits, written))
    largest = int(np.floor(np.log10(np.abs(array).max())))
    return 10.0 ** max(-decimals, largest - (max(digits) - 1))
