"""VTK's XML file format, as much of it as points with arrays, lines, blocks and time series need.

Written so that ParaView and OVITO both read it: little-endian, arrays inline in base64, neither compressed nor appended.
Source: VTK User's Guide, 11th edition, "XML file formats"; arrays keep their bits."""

import base64
from xml.sax.saxutils import quoteattr

import numpy as np

_TYPES = {"f": ("Float64", "<f8"), "i": ("Int64", "<i8"), "u": ("Int64", "<i8"), "b": ("Int64", "<i8")}


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


def multi_block(blocks):
    """Text of a .vtm file: blocks {name: file}, files as seen from its folder."""
    sets = [
        f'<DataSet index="{index}" name={quoteattr(name)} file={quoteattr(file)}/>'
        for index, (name, file) in enumerate(blocks.items())
    ]
    return _file("vtkMultiBlockDataSet", "\n".join(["<vtkMultiBlockDataSet>", *sets, "</vtkMultiBlockDataSet>"]))


def collection(files, times):
    """Text of a .pvd file: a file for each time."""
    sets = [
        f'<DataSet timestep="{time!r}" group="" part="0" file={quoteattr(file)}/>'
        for file, time in zip(files, map(float, times), strict=True)
    ]
    return _file("Collection", "\n".join(["<Collection>", *sets, "</Collection>"]))


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
    kind, layout = _TYPES[values.dtype.kind]
    components = f' NumberOfComponents="{values.shape[1]}"' if values.ndim == 2 else ""
    number = f' NumberOfTuples="{len(values)}"' if tuples else ""
    data = np.ascontiguousarray(values, dtype=layout).tobytes()
    text = base64.b64encode(np.array([len(data)], dtype="<u8").tobytes() + data).decode("ascii")
    return f'<DataArray type="{kind}" Name={quoteattr(name)}{components}{number} format="binary">{text}</DataArray>'
