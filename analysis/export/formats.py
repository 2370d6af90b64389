"""The states of a run as files of other programs: VTK's XML files (ParaView, OVITO, VisIt) and extended XYZ (OVITO,
ASE).

VTK: run.pvd -> state_000000.vtm -> state_000000/grains.vtp and contacts.vtp, little-endian, arrays inline in base64,
neither compressed nor appended, so that ParaView and OVITO both read them (VTK User's Guide, 11th edition, "XML file
formats"). Extended XYZ: https://github.com/libAtoms/extxyz; a frame for each state in one file. Arrays keep their
bits in both, lengths of xyz in metres: numbers of text have 17 digits.
"""

import base64
from xml.sax.saxutils import quoteattr

import numpy as np

from ..progress import progress
from ..runs.files import make_folder, replacing, write_file
from .fields import CONTACTS, GRAINS, UNITS, exported_states, grain_fields

_VTK_TYPES = {"f": ("Float64", "<f8"), "i": ("Int64", "<i8"), "u": ("Int64", "<i8"), "b": ("Int64", "<i8")}
_XYZ_NAMES = {"v": "velo"}  # where the format has a word of its own for a field
SPECIES = "X"  # no element


# ---- VTK ----


def write_vtk(run, folder, first=0):
    """Write the states of a RunFolder, numbered from `first` on; returns the Path of the .pvd, which is written last.
    RunFolderError when a state is damaged or there is none.

    Grains are points with the fields of fields.GRAINS. Contacts are lines from the first grain's centre to the second's
    nearest image, with fields.CONTACTS; each has its own two points. `time` [s] and, of a periodic run, `cell_size` [m]
    are field data of the grains. (OVITO 3.17 shows the contacts of an earlier state where a state has none.)"""
    make_folder(folder)
    names, times = [], []
    states = progress(exported_states(run), "writing states", len(run.states))
    for number, exported in enumerate(states, first):
        names.append(f"state_{number:06d}")
        times.append(exported.state.time)
        (folder / names[-1]).mkdir(parents=True, exist_ok=True)
        write_file(folder / names[-1] / "grains.vtp", _grains(exported))
        write_file(folder / names[-1] / "contacts.vtp", _contacts(exported))
        parts = [{"index": k, "name": p, "file": f"{names[-1]}/{p}.vtp"} for k, p in enumerate(("grains", "contacts"))]
        write_file(folder / f"{names[-1]}.vtm", _data_sets("vtkMultiBlockDataSet", parts))
    series = folder / "run.pvd"
    states = zip(names, map(float, times))
    entries = [{"timestep": time, "group": "", "part": 0, "file": f"{name}.vtm"} for name, time in states]
    write_file(series, _data_sets("Collection", entries))
    return series


def _grains(exported):
    state = exported.state
    whole = {"time": np.array([state.time])}
    if state.cell_size is not None:
        whole["cell_size"] = state.cell_size
    return poly_data(state.position, grain_fields(exported), field_data=whole)


def _contacts(exported):
    begin = exported.state.position[exported.first]
    points = np.stack([begin, begin + exported.between], axis=1).reshape(-1, 3)
    lines = np.arange(len(points)).reshape(-1, 2)
    if not len(lines):  # a point that no line has: OVITO takes a file of no point for one of no particle
        points = exported.state.position[:1]
    return poly_data(points, {}, lines, {field.name: field.values(exported) for field in CONTACTS})


def poly_data(points, point_fields, lines=None, cell_fields=None, field_data=None):
    """Text of a .vtp file.

    points (P, 3). point_fields {name: (P,) or (P, 3)}. lines (L, 2) int, rows of points, or None: then every point is a
    vertex. cell_fields {name: (L,) or (L, 3)}, of the lines. field_data {name: (K,)}, of the whole."""
    vertices = np.arange(len(points)).reshape(-1, 1) if lines is None else np.empty((0, 1), dtype=int)
    lines = np.empty((0, 2), dtype=int) if lines is None else np.asarray(lines)
    piece = (
        f'<Piece NumberOfPoints="{len(points)}" NumberOfVerts="{len(vertices)}" NumberOfLines="{len(lines)}" '
        'NumberOfStrips="0" NumberOfPolys="0">'
    )
    body = [
        piece,
        *_section("PointData", point_fields),
        *_section("CellData", cell_fields),
        "<Points>",
        _array("Points", np.asarray(points, dtype=float)),
        "</Points>",
        *_cells("Verts", vertices),
        *_cells("Lines", lines),
        "</Piece>",
        *_section("FieldData", field_data, tuples=True),  # after the piece: before it, OVITO finds no particles
    ]
    return _file("PolyData", "\n".join(["<PolyData>", *body, "</PolyData>"]))


def _data_sets(kind, of_each):
    """Text of a file that lists others: attributes {name: value} of each, files relative to its folder."""
    lines = (" ".join(f"{name}={quoteattr(str(value))}" for name, value in own.items()) for own in of_each)
    return _file(kind, "\n".join([f"<{kind}>", *(f"<DataSet {line}/>" for line in lines), f"</{kind}>"]))


def _file(kind, body):
    head = f'<VTKFile type="{kind}" version="1.0" byte_order="LittleEndian" header_type="UInt64">'
    return f'<?xml version="1.0"?>\n{head}\n{body}\n</VTKFile>\n'


def _section(name, fields, tuples=False):
    if not fields:
        return []
    return [f"<{name}>", *(_array(key, values, tuples) for key, values in fields.items()), f"</{name}>"]


def _cells(name, connectivity):
    rows, columns = connectivity.shape
    ends = np.arange(1, rows + 1) * columns
    return [f"<{name}>", _array("connectivity", connectivity.ravel()), _array("offsets", ends), f"</{name}>"]


def _array(name, values, tuples=False):
    values = np.asarray(values)
    kind, layout = _VTK_TYPES[values.dtype.kind]
    components = f' NumberOfComponents="{values.shape[1]}"' if values.ndim == 2 else ""
    number = f' NumberOfTuples="{len(values)}"' if tuples else ""
    data = np.ascontiguousarray(values, dtype=layout).tobytes()
    text = base64.b64encode(np.array([len(data)], dtype="<u8").tobytes() + data).decode("ascii")
    return f'<DataArray type="{kind}" Name={quoteattr(name)}{components}{number} format="binary">{text}</DataArray>'


# ---- extended XYZ ----


def write_xyz(run, folder, unit="m"):
    """Write the states of a RunFolder; returns the file's Path. Columns: species, pos and fields.GRAINS (v is called
    velo); a frame's line has Time [s], length_unit and, of a periodic run, the cell (under a piston not periodic across
    its planes)."""
    file = folder / "run.xyz"
    make_folder(folder)
    with replacing(file) as out:
        for exported in progress(exported_states(run), "writing states", len(run.states)):
            _write_frame(out, exported, unit)
    return file


def _write_frame(out, exported, unit):
    state = exported.state
    columns = {"pos": state.position, **grain_fields(exported)}
    for name in ("pos", *(field.name for field in GRAINS if field.unit == "m")):
        columns[name] = columns[name] / UNITS[unit]
    properties, formats = ["species:S:1"], [SPECIES]
    for name, array in columns.items():
        width, is_whole = array[0].size, array.dtype.kind in "iu"
        properties.append(f"{_XYZ_NAMES.get(name, name)}:{'I' if is_whole else 'R'}:{width}")
        formats += ["%d" if is_whole else "%.17g"] * width
    words = [f"Properties={':'.join(properties)}", f"Time={state.time!r}", f"length_unit={unit}"]
    if state.cell_size is None:
        words.append('pbc="F F F"')
    else:
        vectors = np.diag(state.cell_size) if state.cell_vectors is None else state.cell_vectors.T  # an edge a row
        edges = " ".join(f"{number:.17g}" for number in vectors.ravel() / UNITS[unit])
        across = () if state.plane_axis is None else state.plane_axis  # planes end the cell
        periodic = " ".join("F" if axis in across else "T" for axis in range(3))
        words += [f'Lattice="{edges}"', f'pbc="{periodic}"']
    out.write(f"{len(state.radius)}\n{' '.join(words)}\n".encode("ascii"))
    table = np.hstack([np.asarray(array, dtype=float).reshape(len(state.radius), -1) for array in columns.values()])
    np.savetxt(out, table, fmt=" ".join(formats))
