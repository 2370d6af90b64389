"""Spheres of a file of any of the formats."""

import os

import pandas

from analysis.runs.table import EXACTLY
from yade_scripts.packings.foreign.arrays import of_npz, of_vtk, of_yaml
from yade_scripts.packings.foreign.spheres import FORMATS, IGNORED, require_axes, roles, spheres_of
from yade_scripts.packings.foreign.text import find_table
from yade_scripts.packings.packing import PackingError

MOST_BYTES, LONGEST_LINE = 4 << 30, 10_000
BY_START = {b"PK\x03\x04": of_npz, b"# vtk DataFile": of_vtk, b"<?xml": of_vtk, b"<VTKFile": of_vtk}


def read_spheres(path, most, names=None):
    """Spheres of a file; names: of the columns of a table, instead of its own.

    Raises PackingError, one line, where the file is none of FORMATS, has more than `most` grains or holds what is no number.
    """
    if os.path.exists(path) and not os.path.isfile(path):
        raise PackingError(f"{path}: is no regular file; must be one")
    with open(path, "rb") as file:
        start = file.read(4096)
    if os.path.getsize(path) > MOST_BYTES:
        raise PackingError(f"{path}: {os.path.getsize(path) / 1e9:.3g} GB; must be at most {MOST_BYTES / 1e9:.3g} GB")
    reader = next((reader for mark, reader in BY_START.items() if start.startswith(mark)), None)
    if reader is None and b"\0" in start:
        raise PackingError(f"{path}: of an unknown format; must be {FORMATS}")
    if reader is None and b"aggregate:" in start and b"positions:" in start:
        reader = of_yaml
    if reader and names:
        raise PackingError(f"names = {','.join(names)}: {path} is no table; must be left out")
    spheres = reader(path) if reader else _of_table(path, most, names)
    if not 2 <= len(spheres.position) <= most:
        raise PackingError(f"{path}: holds {len(spheres.position)} grains; must be 2 to {most}")
    return spheres


def _of_table(path, most, names):
    with open(path, "rb") as file:
        longest = max(map(len, file), default=0)
    if longest > LONGEST_LINE:
        raise PackingError(f"{path}: a line of {longest} characters; must be at most {LONGEST_LINE}, a grain a line")
    table = find_table(path)
    names = names or table.names
    if names is None:
        raise PackingError(
            f"{path}: {table.kind}, columns without names; must be named, as in names={IGNORED},x,y,z,{IGNORED},radius"
        )
    found = roles(names)
    require_axes(path, found, names)
    if table.rows is not None and table.rows > most:
        raise PackingError(f"{path}: holds {table.rows} grains; must be 2 to {most}")
    frame = _read(path, table, most)
    if max(found.values()) >= frame.shape[1]:
        raise PackingError(f"{path}: {frame.shape[1]} columns; must have those of {', '.join(names)}")
    if table.rows is not None and len(frame) < table.rows:
        raise PackingError(f"{path}: {len(frame)} rows of numbers; must be {table.rows}, as it says")
    numbers = {role: pandas.to_numeric(frame[column], errors="coerce").to_numpy() for role, column in found.items()}
    return spheres_of(path, table.kind, numbers, table.unit)


def _read(path, table, most):
    """All columns of a table's rows; extra ones in a row are an error, missing ones become NaN."""
    try:
        return pandas.read_csv(
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
    except ValueError as error:
        reason = " ".join(str(error).split())
        raise PackingError(
            f"{path}: not a table of numbers ({reason}); must have the same columns in all rows"
        ) from None
