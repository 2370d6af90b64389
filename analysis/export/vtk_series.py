"""A run as files of VTK: run.pvd -> state_000000.vtm -> state_000000/grains.vtp and contacts.vtp."""

import numpy as np

from ..progress import progress
from ..runs.files import make_folder, write_file
from . import vtk_xml
from .fields import contact_fields, exported_states, grain_fields

SERIES = "run.pvd"


def write_vtk(run, folder):
    """Write the states of a RunFolder; returns the Path of the .pvd, which is written last. RunFolderError when a state is
    damaged or there is none.

    Grains are points with the fields of fields.GRAINS. Contacts are lines from the first grain's centre to the second's
    nearest image, with fields.CONTACTS; each has its own two points. `time` [s] and, of a periodic run, `cell_size` [m]
    are field data of the grains. (OVITO 3.17 shows the contacts of an earlier state where a state has none.)"""
    make_folder(folder)
    names, times = [], []
    for number, exported in enumerate(progress(exported_states(run), "writing states", len(run.states))):
        names.append(f"state_{number:06d}")
        times.append(exported.state.time)
        (folder / names[-1]).mkdir(parents=True, exist_ok=True)
        blocks = {part: f"{names[-1]}/{part}.vtp" for part in ("grains", "contacts")}
        write_file(folder / blocks["grains"], _grains(exported))
        write_file(folder / blocks["contacts"], _contacts(exported))
        write_file(folder / f"{names[-1]}.vtm", vtk_xml.multi_block(blocks))
    series = folder / SERIES
    write_file(series, vtk_xml.collection([f"{name}.vtm" for name in names], times))
    return series


def _grains(exported):
    state = exported.state
    whole = {"time": np.array([state.time])}
    if state.cell_size is not None:
        whole["cell_size"] = state.cell_size
    return vtk_xml.poly_data(state.position, grain_fields(exported), field_data=whole)


def _contacts(exported):
    begin = exported.state.position[exported.first]
    points = np.stack([begin, begin + exported.between], axis=1).reshape(-1, 3)
    lines = np.arange(len(points)).reshape(-1, 2)
    if not len(lines):  # a point that no line has: OVITO takes a file of no point for one of no particle
        points = exported.state.position[:1]
    return vtk_xml.poly_data(points, {}, lines, contact_fields(exported))
