"""Exports, field by field: VTK files by VTK's own reader, extended XYZ by its specification."""

from xml.etree import ElementTree

import numpy as np
import pytest
from written_runs import MASS, RADIUS, losing, record, state_arrays, write_run

from analysis.__main__ import main
from analysis.export.fields import CONTACTS, GRAINS
from analysis.runs.folder import open_run
from yade_scripts.packings.spheres import read_spheres

SIZE = np.array([1e-6, 1.5e-6, 2e-6])
# A plate across z: the cell is periodic along x and y alone.
PLATE = dict(plane_axis=np.array([2]), plane_position=np.zeros(1), plane_contacts=np.empty((0, 2), int))
PLATE["plane_contact_normal_force"] = np.empty(0)
CELL_SERIES = ("filling", "pressure", "kinetic_pressure", "coordination", "edge_x", "edge_y", "edge_z")


@pytest.fixture(params=[False, True], ids=["free", "periodic"])
def run(request, tmp_path):
    """Three states of five grains of unlike size, exported; the last one has no contact."""
    periodic, random, states = request.param, np.random.default_rng(5), []
    for number in range(3):
        pairs = [(0, 1), (1, 2), (4, 3)] if number < 2 else []
        x, v = random.uniform(-1, 2, size=(5, 3)) * 1e-6, random.normal(size=(5, 3))
        state = state_arrays(number * 1e-9, x, v, np.zeros(5) if periodic else [0, 0, 0, 1, 1], pairs)
        state["contact_normal_force"] = random.normal(size=len(pairs)) * 1e-9
        state["contact_bonded"] = np.arange(len(pairs)) == 1
        state["angular_velocity"] = random.normal(size=(5, 3)) * 1e6
        state["radius"] = RADIUS * np.linspace(1.0, 1.5, 5)
        states.append({**state, **({"cell_size": SIZE, **PLATE} if periodic else {})})
    about = {**record(1e-6), "kind": "compression" if periodic else "collision"}
    history = losing(np.arange(3) * 1e-9, **{name: np.zeros(3) for name in CELL_SERIES if periodic})
    folder = write_run(tmp_path / "run", about, history, states)
    assert main(["export", str(folder), "--format", "all"]) == 0
    return open_run(folder)


def expected(state):
    """{name: array} of grains and of contacts, and the contacts' ends (M, 2, 3), written without the code under
    test."""
    pairs, size = state.contact_pairs, state.cell_size
    between = np.empty((len(pairs), 3))
    for row, (a, b) in enumerate(pairs):
        shifts = [np.zeros(3)] if size is None else [size * (np.array(k) - 4) for k in np.ndindex(9, 9, 9)]
        images = [state.position[b] - state.position[a] + shift for shift in shifts]
        between[row] = min(images, key=np.linalg.norm)
    force = np.zeros_like(state.position)
    for (a, b), f, way in zip(pairs, state.contact_normal_force, between):
        force[b] += f * way / np.linalg.norm(way)
        force[a] -= f * way / np.linalg.norm(way)
    grains = {"id": np.arange(5), "radius": state.radius, "mass": MASS * (state.radius / RADIUS) ** 3}
    grains |= {"v": state.velocity, "omega": state.angular_velocity, "aggregate": state.aggregate}
    pieces, numbers = ([0, 0, 0, 1, 1], [1, 2, 1, 1, 1]) if len(pairs) else (np.arange(5), np.zeros(5))
    grains |= {"fragment": pieces, "coordination": numbers, "normal_force": force}
    overlap = [state.radius[a] + state.radius[b] - np.linalg.norm(d) for (a, b), d in zip(pairs, between)]
    contacts = {"id1": pairs[:, 0], "id2": pairs[:, 1], "normal_force": state.contact_normal_force}
    contacts |= {"bonded": state.contact_bonded, "overlap": overlap}
    ends = np.array([[state.position[a], state.position[a] + d] for (a, _), d in zip(pairs, between)]).reshape(-1, 2, 3)
    return grains, contacts, ends


def agree(found, wanted):
    """Every field is there, and equal within rounding of its largest value."""
    for name, values in wanted.items():
        values = np.asarray(values, dtype=float)
        scale = np.abs(values).max(initial=0.0)
        assert np.allclose(np.reshape(found[name], values.shape), values, rtol=1e-12, atol=1e-12 * scale), name


def _blocks(file):
    """{name: vtkPolyData} of a .vtm, by VTK's own reader."""
    from vtkmodules.vtkCommonDataModel import vtkCompositeDataSet
    from vtkmodules.vtkIOXML import vtkXMLMultiBlockDataReader

    reader = vtkXMLMultiBlockDataReader()
    reader.SetFileName(str(file))
    reader.Update()
    assert reader.GetErrorCode() == 0
    whole = reader.GetOutput()
    names = [whole.GetMetaData(k).Get(vtkCompositeDataSet.NAME()) for k in range(whole.GetNumberOfBlocks())]
    return {name: whole.GetBlock(k) for k, name in enumerate(names)}


def _arrays(data):
    from vtkmodules.util.numpy_support import vtk_to_numpy

    return {data.GetArrayName(k): vtk_to_numpy(data.GetArray(k)) for k in range(data.GetNumberOfArrays())}


def test_vtk_reads_every_field(run):
    pytest.importorskip("vtkmodules", reason="python3-vtk9 is not installed")
    from vtkmodules.util.numpy_support import vtk_to_numpy

    series = ElementTree.parse(run.path / "export/run.pvd").getroot().findall("Collection/DataSet")
    assert [float(entry.get("timestep")) for entry in series] == list(run.states.times)
    for state, entry in zip(run.states, series, strict=True):
        grains, contacts, ends = expected(state)
        blocks = _blocks(run.path / "export" / entry.get("file"))
        assert list(blocks) == ["grains", "contacts"]
        points = blocks["grains"]
        assert points.GetNumberOfPoints() == points.GetNumberOfVerts() == 5
        assert np.array_equal(vtk_to_numpy(points.GetPoints().GetData()), state.position)
        agree(_arrays(points.GetPointData()), grains)
        whole = _arrays(points.GetFieldData())
        assert whole["time"] == [state.time]
        assert np.array_equal(whole.get("cell_size"), state.cell_size)
        lines = blocks["contacts"]
        assert lines.GetNumberOfLines() == len(ends) and lines.GetNumberOfVerts() == 0
        agree(_arrays(lines.GetCellData()), contacts)
        if len(ends):
            found = vtk_to_numpy(lines.GetPoints().GetData())
            order = vtk_to_numpy(lines.GetLines().GetConnectivityArray())
            agree({"ends": found[order].reshape(-1, 2, 3)}, {"ends": ends})


def test_xyz_has_every_field_to_the_bit(run):
    lines = (run.path / "export/run.xyz").read_text().splitlines()
    assert len(lines) == 3 * 7
    for number, state in enumerate(run.states):
        count, about, *rows = lines[7 * number : 7 * number + 7]
        assert int(count) == 5
        properties = about.split("Properties=")[1].split()[0].split(":")
        table, column, found = [row.split() for row in rows], 0, {}
        for name, _, width in zip(properties[::3], properties[1::3], map(int, properties[2::3])):
            cells = [row[column : column + width] for row in table]
            found[name] = np.array(cells, dtype=str if name == "species" else float).squeeze()
            column += width
        assert column == len(table[0])
        grains, contacts, _ = expected(state)
        assert [field.name for field in GRAINS if field.name != "material"] == list(grains) and [
            field.name for field in CONTACTS
        ] == list(contacts)
        for name, values in {"pos": state.position, "velo": state.velocity, "omega": state.angular_velocity}.items():
            assert np.array_equal(found[name], values), name
        found["v"] = found["velo"]
        agree(found, grains)
        assert f"Time={state.time!r}" in about
        assert ('pbc="T T F"' in about) == ("Lattice=" in about) == (state.cell_size is not None)


def test_xyz_in_another_unit_is_read_back(run):
    assert main(["export", str(run.path), "--format", "xyz", "--unit", "um", "--out", str(run.path)]) == 0
    found, last = read_spheres(str(run.path / "run.xyz"), 5), run.last
    assert found.unit == "um" and (found.cell is None) == (last.cell_size is None)
    wanted = [last.position, last.radius] + [np.where([1, 1, 0], SIZE, np.inf)] * (last.cell_size is not None)
    for ours, lengths in zip((found.position, found.radius, found.cell), wanted):
        assert ours == pytest.approx(1e6 * lengths, rel=1e-15)


def test_optics_codes_get_the_spheres_and_the_dipoles_of_a_fragment(run):
    """x y z radius as MSTM (pymstm) reads them; DDSCAT's dipoles fill the spheres' volume and lie in them."""
    of_last = ["--state", "1", "--fragment", "0", "--unit", "um"]
    for form in ("mstm", "ddscat"):
        assert main(["export", str(run.path), "--format", form, "--out", str(run.path / form), *of_last]) == 0
    state = run.states[1]
    spheres = np.loadtxt(run.path / "mstm/000001.pos")
    ends = expected(state)[-1][:2]  # of the contacts of grains 0, 1 and 1, 2, as nearest images
    assert spheres[:, 3] == pytest.approx(1e6 * state.radius[:3]) and spheres.shape == (3, 4)
    assert np.diff(spheres[:, :3], axis=0) == pytest.approx(1e6 * np.diff(ends, axis=1)[:, 0])
    lines = (run.path / "ddscat/000001.dat").read_text().splitlines()
    spacing, effective = (float(lines[0].replace(",", "").split()[k]) for k in (2, 6))
    dipoles = np.array([line.split() for line in lines[7:]], dtype=int)
    assert len(dipoles) == int(lines[1].split()[0]) and np.all(dipoles[:, 4:] == 1)
    assert 4 / 3 * np.pi * effective**3 == pytest.approx(len(dipoles) * spacing**3, rel=1e-4)
    away = np.linalg.norm(dipoles[:, None, 1:4] * spacing - spheres[:, :3], axis=2) - spheres[:, 3]
    assert np.all(away.min(axis=1) < 1e-4) and np.all((away < -spacing).any(axis=0))
    for wrong in (["--state", "9"], ["--fragment", "7"], ["--unit", "um"]):
        assert main(["export", str(run.path), *wrong]) == 2
