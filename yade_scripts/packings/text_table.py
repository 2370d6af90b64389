"""Where the table of grains stands in a text file, and what its columns are: xyz, extended xyz, LAMMPS data and dump,
DustCollider, and plain tables with or without names (csv, YADE, FracVAL, PyFracVAL, aggregate_gen).

Sources: https://github.com/libAtoms/extxyz (Properties), https://docs.lammps.org (dump, read_data), YADE's export.textExt,
and files that the others write. Of several frames the last one is taken.
"""

import re
from dataclasses import dataclass, replace
from itertools import islice

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


class _Lines:
    """Lines of a file, counted: `read` of them so far."""

    def __init__(self, path, file):
        self.path, self.file, self.read = path, file, 0

    def next(self):
        self.read += 1
        return self.file.readline()

    def skip(self, rows):
        if sum(1 for _ in islice(self.file, rows)) < rows:
            raise PackingError(f"{self.path}: ends within the {rows} rows after line {self.read}; must hold them all")
        self.read += rows

    def count(self, text):
        """The number of grains that a line says."""
        word = text.split()[0] if text.split() else ""
        if not word.isdecimal() or len(word) > 9 or int(word) < 1:
            raise PackingError(
                f"{self.path}: line {self.read}: '{word[:40]}' grains; must be a whole number > 0, below 1e9"
            )
        return int(word)


def find_table(path):
    """The Table of a text file; raises PackingError when it has none."""
    with open(path, encoding="utf-8-sig", errors="replace") as file:
        head = [line.strip() for line in islice(file, HEAD)]
        file.seek(0)
        lines, first = _Lines(path, file), next((line for line in head if line), None)
        if first is None:
            raise PackingError(f"{path}: empty; must be a file of grains")
        if first.startswith("ITEM:"):
            return _dump(lines)
        if any(_ATOMS.match(line) for line in head):
            return _data(lines)
        if head[0].isdecimal():
            return _xyz(lines)
    return _dust_collider(head) or _plain(path, head)


def _xyz(lines):
    """A number of grains, a line about them, the grains; again for each frame."""
    frames = 0
    while (counted := lines.next()).strip():
        rows, about = lines.count(counted), lines.next()
        if properties := re.search(r'Properties="?([^"\s]+)', about):
            kind, names = "extended xyz", _properties(lines.path, properties[1])
        else:
            kind, names = "xyz", None
        table, frames = Table(kind, lines.read, rows, names), frames + 1
        row = lines.next().split()
        # of others nobody says what the columns are; and x y z may be without a species
        if not properties and len(row) in (4, 5) and not ("." in row[0] and _is_number(row[0])):
            table = replace(table, names=("species", "x", "y", "z", "radius")[: len(row)])
        lines.skip(rows - 1)
    return _of_frames(table, frames)


def _properties(path, text):
    """Names of all columns, of species:S:1:pos:R:3:radius:R:1."""
    words, names = text.split(":"), []
    for name, count in zip(words[::3], words[2::3]):
        if not count.isdecimal() or int(count) > 100:
            raise PackingError(
                f"{path}: Properties={text[:60]}: not understood; must be name:type:columns, again and again"
            )
        parts = "xyz" if name.lower() in ("pos", "position", "positions") else range(int(count))
        names += [name] if count == "1" else [f"{name}_{part}" for part in parts]
    return tuple(names)


def _dump(lines):
    """ITEM: NUMBER OF ATOMS, a line with it, ..., ITEM: ATOMS and names, the grains; again for each frame."""
    rows, frames, table = 0, 0, None
    while text := lines.next():
        if text.startswith("ITEM: NUMBER OF ATOMS"):
            rows = lines.count(lines.next())
        elif text.startswith("ITEM: ATOMS"):
            table, frames = Table("LAMMPS dump", lines.read, rows, tuple(text.split()[2:])), frames + 1
            lines.skip(rows)
    if table is None:
        raise PackingError(f"{lines.path}: no ITEM: ATOMS; must have one")
    return _of_frames(table, frames)


def _of_frames(table, frames):
    return replace(table, kind=f"{table.kind}, the last of {frames} frames") if frames > 1 else table


def _data(lines):
    """N atoms in the header; Atoms # style, an empty line, the grains."""
    rows = 0
    while text := lines.next():
        if _ATOMS.match(text):
            rows = lines.count(text)
        if section := re.match(r"Atoms\b\s*(?:#\s*(\S+))?", text):
            style, names = section[1], ATOM_STYLES.get(section[1])
            kind = f"LAMMPS data, atom style {style or 'not said'}"
            return Table(kind, lines.read, rows, names and tuple(names.split()))
    raise PackingError(f"{lines.path}: no section Atoms; must have one")


def _dust_collider(head):
    """aggregate.txt of DustCollider: N and two radii, four lines, then x y z, a column, radius, a column, material; nm."""
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
