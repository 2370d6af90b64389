"""A run as one extended XYZ file, a frame for each state (OVITO, ASE).

Source: https://github.com/libAtoms/extxyz (the format's specification). Numbers have 17 digits, which keep their bits."""

import numpy as np

from ..progress import progress
from ..runs.files import make_folder, replacing
from .fields import exported_states, grain_fields

FILE = "run.xyz"
SPECIES = "X"  # no element
_TYPES = {"f": "R", "i": "I", "u": "I"}
# where the format has a word of its own for a field
_NAMES = {"v": "velo"}


def write_xyz(run, folder):
    """Write the states of a RunFolder; returns the file's Path. Columns: species, pos [m] and fields.GRAINS (v is called
    velo); a frame's line has Time [s] and, of a periodic run, the cell (under a piston not periodic across its
    planes)."""
    file = folder / FILE
    make_folder(folder)
    with replacing(file) as out:
        for exported in progress(exported_states(run), "writing states", len(run.states)):
            _write_frame(out, exported)
    return file


def _write_frame(out, exported):
    state = exported.state
    columns = {"pos": state.position, **grain_fields(exported)}
    properties = ":".join(["species:S:1", *(_property(name, array) for name, array in columns.items())])
    words = [f"Properties={properties}", f"Time={state.time!r}"]
    if state.cell_size is None:
        words.append('pbc="F F F"')
    else:
        edges = " ".join(f"{number:.17g}" for number in np.diag(state.cell_size).ravel())
        across = () if state.plane_axis is None else state.plane_axis  # planes end the cell
        periodic = " ".join("F" if axis in across else "T" for axis in range(3))
        words += [f'Lattice="{edges}"', f'pbc="{periodic}"']
    out.write(f"{len(state.radius)}\n{' '.join(words)}\n".encode("ascii"))
    table = np.hstack([np.asarray(array, dtype=float).reshape(len(state.radius), -1) for array in columns.values()])
    np.savetxt(out, table, fmt=f"{SPECIES} " + " ".join(_formats(columns)))


def _property(name, array):
    return f"{_NAMES.get(name, name)}:{_TYPES[array.dtype.kind]}:{1 if array.ndim == 1 else array.shape[1]}"


def _formats(columns):
    """printf's format of every number of a line."""
    for array in columns.values():
        yield from ["%d" if array.dtype.kind in "iu" else "%.17g"] * (1 if array.ndim == 1 else array.shape[1])
