"""Where the table of grains stands in a text file, and what its columns are: xyz, extended xyz, LAMMPS data and dump,
DustCollider, and plain tables with or without names (csv, YADE, FracVAL, PyFracVAL, aggregate_gen).

Sources: https://github.com/libAtoms/extxyz (Properties), https://docs.lammps.org (dump, read_data), YADE's
export.textExt, and files that the others write. Of several frames the last one is taken."""

import re
from dataclasses import dataclass

from yade_scripts.packings.packing import PackingError

FORMATS = "npz, csv, xyz, LAMMPS data or dump, VTK, YAML of pyFracAggregate, text of DustCollider, FracVAL or YADE"
HEAD = 60  # lines in which names, comments and headers stand
# https://docs.lammps.org/read_data.html, "Atoms section"
ATOM_STYLES = {
    "sphere": "id type diameter density x y z",
    "bpm/sphere": "id mol type diameter density x y z",
    "atomic": "id type x y z",
    "bond": "id mol type x y z",
    "molecular": "id mol type x y z",
    "charge": "id type q x y z",
    "full": "id mol type q x y z",
}
_ATOMS = re.compile(r"\s*\d+\s+atoms\b")


@dataclass(frozen=True)
class Table:
    """Where the rows of numbers are in a file."""

    kind: str
    first: int  # lines before them
    rows: int | None  # None: to the end
    names: tuple | None  # of the columns; None: not known
    separator: str = r"\s+"
    unit: str | None = None  # of length, if the format has one


def find_table(path):
    """The Table of a text file; raises PackingError when it has none."""
    with open(path, encoding="utf-8-sig", errors="replace") as file:
        lines = file.read().split("\n")
    head = [line.strip() for line in lines[:HEAD]]
    begin = next((line for line in head if line), None)
    if begin is None:
        raise PackingError(f"{path}: empty; must be a file of grains")
    if begin.startswith("ITEM:"):
        return _dump(path, lines)
    if any(_ATOMS.match(line) for line in head):
        return _data(path, lines)
    if head[0].isdecimal():
        return _xyz(path, lines)
    return _dust_collider(head) or _plain(path, head)


def _count(path, lines, number):
    """The number of grains in line `number`, from 0; so many must follow in the file."""
    word = (lines[number].split() or [""])[0]
    if not word.isdecimal() or int(word[:10]) < 1:
        raise PackingError(f"{path}: line {number + 1}: '{word[:40]}' grains; must be a whole number > 0")
    rows = int(word[:10])
    if rows >= len(lines) - number:
        raise PackingError(f"{path}: ends within the {rows} rows after line {number + 1}; must hold them all")
    return rows


def _xyz(path, lines):
    """A number of grains, a line about them, the grains; again for each frame."""
    at = frames = 0
    while at < len(lines) and lines[at].strip():
        rows, first, frames = _count(path, lines, at), at + 2, frames + 1
        at = first + rows
    properties = re.search(r'Properties="?([^"\s]+)', lines[first - 1])
    if properties:
        return Table(_of_frames("extended xyz", frames), first, rows, _properties(path, properties[1]))
    row, names = lines[first].split() if first < len(lines) else [], None
    # other columns have no names; x y z may be without a species
    if len(row) in (4, 5) and not ("." in row[0] and _is_number(row[0])):
        names = ("species", "x", "y", "z", "radius")[: len(row)]
    return Table(_of_frames("xyz", frames), first, rows, names)


def _properties(path, text):
    """Names of all columns, of species:S:1:pos:R:3:radius:R:1."""
    words, names = text.split(":"), []
    for name, count in zip(words[::3], words[2::3]):
        if count not in map(str, range(1, 101)):
            raise PackingError(
                f"{path}: Properties={text[:60]}: not understood; must be name:type:columns, again and again"
            )
        parts = "xyz" if name.lower() in ("pos", "position", "positions") else range(int(count))
        names += [name] if count == "1" else [f"{name}_{part}" for part in parts]
    return tuple(names)


def _dump(path, lines):
    """ITEM: NUMBER OF ATOMS, a line with it, ..., ITEM: ATOMS and names, the grains; again for each frame."""
    rows, frames = 0, [number for number, line in enumerate(lines) if line.startswith("ITEM: ATOMS")]
    for number, line in enumerate(lines[:-1]):
        if line.startswith("ITEM: NUMBER OF ATOMS"):
            rows = _count(path, lines, number + 1)
    if not frames:
        raise PackingError(f"{path}: no ITEM: ATOMS; must have one")
    names = tuple(lines[frames[-1]].split()[2:])
    return Table(_of_frames("LAMMPS dump", len(frames)), frames[-1] + 1, rows, names)


def _data(path, lines):
    """N atoms in the header; Atoms # style, an empty line, the grains."""
    rows = 0
    for number, line in enumerate(lines):
        if _ATOMS.match(line):
            rows = _count(path, lines, number)
        if section := re.match(r"Atoms\b\s*(?:#\s*(\S+))?", line):
            style, names = section[1], ATOM_STYLES.get(section[1])
            kind = f"LAMMPS data, atom style {style or 'without name'}"
            return Table(kind, number + 1, rows, names and tuple(names.split()))
    raise PackingError(f"{path}: no section Atoms; must have one")


def _of_frames(kind, frames):
    return f"{kind}, the last of {frames} frames" if frames > 1 else kind


def _dust_collider(head):
    """aggregate.txt of DustCollider: N and two radii, four lines, then x y z, a column, radius, a column, material;
    nm."""
    first, rows = head[0].split(), [line.split() for line in head[5:] if line]
    if 3 <= len(first) < 7 and first[0].isdecimal() and rows and all(len(row) == 7 for row in rows):
        return Table("DustCollider", 5, int(first[0]), ("x", "y", "z", "-", "radius", "-", "material"), unit="nm")
    return None


def _plain(path, head):
    """Comments with #, a line of names or none, the grains."""
    comments = [line.lstrip("# ") for line in head if line.startswith("#")]
    at = next((k for k, line in enumerate(head) if line and not line.startswith("#")), None)
    if at is None:
        raise PackingError(f"{path}: {len(head)} lines of comments; must be followed by grains")
    separator = next((mark for mark in ",;" if mark in head[at]), r"\s+")
    words = [word.strip() for word in re.split(separator, head[at])]
    if len(words) == 1:
        raise PackingError(f"{path}: of an unknown format; must be {FORMATS}")
    if not any(map(_is_number, words)):
        return Table("table", at + 1, None, tuple(words), separator)
    names = next(filter(None, (_names_in(line, separator) for line in reversed(comments))), None)
    if names is None and len(words) <= 4:
        names = ("x", "y", "z", "radius")[: len(words)]
    return Table("table", at, None, names, separator)


def _names_in(comment, separator):
    """Names of columns in a comment, x y z ..., or in YADE's format x_y_z_r; None if it has none."""
    of_yade = re.match(r"format (x_y_z_\S*|\S+_x_y_z_\S*)$", comment)
    words = tuple(word.strip() for word in re.split("_" if of_yade else separator, of_yade[1] if of_yade else comment))
    return words if {"x", "y", "z"} <= {word.lower() for word in words} else None


def _is_number(word):
    try:
        float(word)
    except ValueError:
        return False
    return True
