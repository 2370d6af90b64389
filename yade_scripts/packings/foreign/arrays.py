"""Spheres of files that hold whole arrays: npz, VTK, and the YAML of pyFracAggregate."""

import locale
import re

import numpy as np

from analysis.runs.files import RunFolderError, array_names, read_arrays
from yade_scripts.packings.foreign.spheres import IN_A_METRE, require_axes, roles, spheres_of
from yade_scripts.packings.packing import PackingError

POSITIONS = ("position", "positions", "pos", "xyz", "coordinates", "coords", "points", "centers", "centres")


def of_npz(path):
    """Spheres of an .npz, which may be a packing of ours; pickled objects are refused, never loaded."""
    try:
        names = array_names(path)
        together = next((name for name in names if name.lower() in POSITIONS), None)
        found = roles(names)
        wanted = [*([together] if together else []), *(names[column] for column in found.values())]
        arrays = read_arrays(path, wanted)
    except RunFolderError as error:
        raise PackingError(f"{error}; must be an .npz with position (N, 3) and radius (N,)") from None
    if together is None:
        require_axes(path, found, names)
    by_role = {role: arrays[names[column]] for role, column in found.items()}
    return _spheres(path, "npz", arrays.get(together), by_role, "m" if {"seed", "parameters"} <= set(names) else None)


def of_vtk(path):
    """Spheres of a legacy or XML file of VTK: its points, with an array of radii."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkCommonCore import vtkLogger, vtkOutputWindow, vtkStringOutputWindow
    from vtkmodules.vtkIOLegacy import vtkGenericDataObjectReader
    from vtkmodules.vtkIOXML import vtkXMLGenericDataObjectReader

    with open(path, "rb") as file:
        legacy = file.read(5) == b"# vtk"
    reader = vtkGenericDataObjectReader() if legacy else vtkXMLGenericDataObjectReader()
    problems = vtkStringOutputWindow()
    vtkOutputWindow.SetInstance(problems)
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)
    reader.SetFileName(path)
    if legacy:
        reader.ReadAllScalarsOn()
        reader.ReadAllFieldsOn()
    spoken = locale.setlocale(locale.LC_ALL)
    try:
        reader.Update()
    finally:
        locale.setlocale(locale.LC_ALL, spoken)  # which VTK leaves as C: text files would be ASCII from then on
    output = None if problems.GetOutput() else reader.GetOutputDataObject(0)
    if not hasattr(output, "GetPoints") or output.GetPoints() is None:
        must = "must be a file of points with their radii, such as state_NNNNNN/grains.vtp of an export"
        raise PackingError(f"{path}: no points in it that VTK can read; {must}")
    data = output.GetPointData()
    names = [data.GetArrayName(number) for number in range(data.GetNumberOfArrays())]
    by_role = {role: vtk_to_numpy(data.GetArray(column)) for role, column in roles(names).items() if role not in "xyz"}
    return _spheres(path, "VTK", vtk_to_numpy(output.GetPoints().GetData()), by_role)


_DEEP = re.compile(r"(?:[\[{]\s*){9}|(?:- +){9}|^ {99}", re.MULTILINE)


def of_yaml(path):
    """Spheres of pyFracAggregate: aggregate: positions, radii, length_unit."""
    import yaml

    with open(path, encoding="utf-8", errors="replace") as file:
        text = file.read()
    try:
        if "&" in text:
            raise ValueError("anchors in it")
        if _DEEP.search(text):  # libyaml has no limit of its own
            raise ValueError("nested too deep")
        found = yaml.load(text, Loader=getattr(yaml, "CSafeLoader", yaml.SafeLoader))["aggregate"]
        position, radius = (np.array(found[name], dtype=float) for name in ("positions", "radii"))
    except (yaml.YAMLError, ValueError, KeyError, TypeError, RecursionError) as error:
        reason = " ".join(str(error).split())[:100]
        raise PackingError(
            f"{path}: not of pyFracAggregate ({reason}); must have aggregate: positions, radii"
        ) from None
    unit = str(found.get("length_unit")).replace("\u03bc", "u").replace("\u00b5", "u")
    return _spheres(path, "YAML", position, {"radius": radius}, unit if unit in IN_A_METRE else None)


def _spheres(path, kind, position, by_role, unit=None):
    """Spheres of an array of positions, or of x, y, z beside the radius by_role; shapes are checked."""
    if position is not None:
        if position.ndim != 2 or position.shape[1] != 3:
            raise PackingError(f"{path}: positions have the shape {position.shape}; must be (N, 3)")
        by_role = {**by_role, **dict(zip("xyz", position.T))}
    grains = len(by_role["x"]) if by_role["x"].ndim else 0
    for role, array in by_role.items():
        if array.shape != (grains,):
            raise PackingError(
                f"{path}: {role} has the shape {array.shape}, positions are {grains}; must be ({grains},)"
            )
    return spheres_of(path, kind, by_role, unit)
