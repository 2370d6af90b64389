"""Aggregates of other programs: formats, units, which grains touch, and that all of it is at rest in a run."""

from dataclasses import asdict
from functools import lru_cache

import numpy as np
import pytest
import yaml
from scenes import *

from analysis.export.vtk_xml import poly_data
from analysis.measures.fragments import fragment_labels
from analysis.theory.compression import rolling_energy
from yade_scripts import packings
from yade_scripts.materials import MATERIALS, equilibrium_overlap
from yade_scripts.packings.aggregate import AggregateParameters, make
from yade_scripts.packings.imported import imported

RADIUS = MATERIALS["ice"].grainRadius
OVERLAP = equilibrium_overlap(MATERIALS["ice"])
OURS = {
    "cpe": dict(radius=6, filling=0.5),
    "bpca": dict(packing="bpca", grains=150),
    "bcca": dict(packing="bcca", grains=150),
    "planar": dict(packing="bcca", grains=60, planar=1),
    "two": dict(packing="bpca", grains=100, sizes="two", sizeRatio=0.4),
    "lognormal": dict(packing="bcca", grains=100, sizes="lognormal", sizeSpread=0.4),
}


@lru_cache
def ours(name):
    return make(AggregateParameters.parse(OURS[name]), OVERLAP, 0)


def rows(table, head="", row="{}", separator=" "):
    """Text of a table (N,K) of texts; row: a format that takes the texts and, as i, the grain's number from 1."""
    filled = (row.format(separator.join(line), *line, i=i) for i, line in enumerate(table, 1))
    return head.format(n=len(table)) + "\n".join(filled) + "\n"


DATA = "made by hand\n\n{n} atoms\n1 atom types\n\n-9 9 xlo xhi\n-9 9 ylo yhi\n-9 9 zlo zhi\n\nAtoms # sphere\n\n"
DUMP = "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n{n}\nITEM: BOX BOUNDS pp pp pp\n-9 9\n-9 9\n-9 9\n"
VTK = "# vtk DataFile Version 3.0.\nof YADE\nASCII\n\nDATASET POLYDATA\nPOINTS {n} double\n"
PROPERTIES = "{n}\nProperties=species:S:1:pos:R:3:velo:R:3:radius:R:1 Time=0.5\n"


def legacy_vtk(t):
    radii = "\nPOINT_DATA {n}\nSCALARS radius double 1\nLOOKUP_TABLE default\n"
    return rows(t[:, :3], VTK) + rows(t[:, 3:], radii.replace("{n}", str(len(t))))


def vtp(t):
    return poly_data(t[:, :3].astype(float), {"mass": np.ones(len(t)), "radius": t[:, 3].astype(float)})


def yaml_of(t):
    about = {"n_particles": len(t), "length_unit": "um", "positions": t[:, :3].astype(float).tolist()}
    return yaml.dump({"aggregate": {**about, "radii": t[:, 3].astype(float).tolist()}}, sort_keys=False)


# What each program writes, from a table (N,4) of texts x y z radius in um.
FORMATS = {
    "csv": lambda t: rows(t, "x,y,z,radius\n", separator=","),
    "csv of ParaView": lambda t: rows(t, '"radius","Points:0","Points:1","Points:2"\n', "{4},{1},{2},{3}"),
    "csv without names": lambda t: rows(t, separator=", "),
    "xyz": lambda t: rows(t, "{n}\na line\n", "Si {}"),
    "xyz, two frames": lambda t: "2\nfirst\nC 0 0 0\nC 9 9 9\n" + rows(t, "{n}\nlast\n", "C {}"),
    "extended xyz": lambda t: rows(t, PROPERTIES, "X {1} {2} {3} 0 0 0 {4}"),
    "LAMMPS data": lambda t: rows(twice(t), DATA, "{i} 1 {4} 1000 {1} {2} {3} 0 0 0") + "\nVelocities\n\n1 0 0 0 0 0 0\n",
    "LAMMPS dump": lambda t: rows(t, DUMP + "ITEM: ATOMS id type xu yu zu radius\n", "{i} 1 {}"),
    "DustCollider, dump": lambda t: rows(t, DUMP + "ITEM: ATOMS id mol type x y z radius\n", "{i} 0 1 {}"),
    "legacy VTK": legacy_vtk,
    "XML of VTK": vtp,
    "pyFracAggregate": yaml_of,
    "FracVAL": lambda t: rows(t, row="  {1}  {2}  {3}  {4}    "),
    "PyFracVAL": lambda t: rows(t, "# simulation_parameters:\n#   N: {n}\n#   - -242.92\n"),
    "YADE": lambda t: rows(t, "#format id_x_y_z_r_matId\n", "{i}\t{1}\t{2}\t{3}\t{4}\t0"),
}


def twice(table):
    """With diameters in the place of radii."""
    return np.column_stack([table[:, :3], [repr(2 * float(x)) for x in table[:, 3]]])


def pairs_of(packing):
    return set(map(tuple, packings.contacts(packing)))


def write(path, packing, decimals, form="csv"):
    table = np.column_stack([packing.position, packing.radius]) * 1e6
    path.write_text(FORMATS[form](np.vectorize(lambda x: f"{x:.{decimals}f}")(table)))
    return str(path)


def pieces(packing):
    return int(fragment_labels(packing.grains, packings.contacts(packing)).max()) + 1


@pytest.mark.parametrize("decimals", [4, 7, 17])
@pytest.mark.parametrize("form", FORMATS)
def test_a_round_trip_gives_the_same_contacts(tmp_path, form, decimals):
    """Lengths in um: four decimals are a thousandth of a grain's radius."""
    for name in OURS:
        packing = ours(name)
        back, _ = imported(write(tmp_path / "a", packing, decimals, form), dict(unit="um", pieces=pieces(packing)))
        assert pairs_of(back) == pairs_of(packing), name
        assert np.abs(back.position - packings.centred(packing.position, packing.radius)).max() < 0.05 * RADIUS


def touching_at_the_sum_of_radii(name):
    return make(AggregateParameters.parse(OURS[name]), 1e-9 * OVERLAP, 0)


@pytest.mark.in_yade
@pytest.mark.parametrize("name", ["cpe", "bpca", "bcca", "lognormal"])
@pytest.mark.parametrize("material", ["ice", "silicate"])
def test_nothing_moves_in_a_run(tmp_path, name, material):
    """Grains that other programs write 2 r apart, to four decimals: over 2000 t0 without damping no contact breaks or forms."""
    written = touching_at_the_sum_of_radii(name)
    packing, _ = imported(
        write(tmp_path / "a.csv", written, 4), dict(unit="um", pieces=pieces(written), material=material)
    )
    of = asdict(MATERIALS[material])
    del of["grainRadius"]
    new_scene(0.1 * constants(JKRMat(**of), packing.radius.min())["timeUnit"])
    for x, r in zip(packing.position, packing.radius):
        grain(x, r, JKRMat(**of))
    fused_engine(subSteps=100)
    O.dt *= 100
    O.engines[0].prepare()
    before, kinetic = contact_law.snapshot(), []
    for _ in range(20):
        O.run(10, True)
        kinetic.append(energies()["kinetic"])
    after = contact_law.snapshot()
    assert len(before["contact_pairs"]) == len(after["contact_pairs"]) == len(packings.contacts(packing))
    assert max(kinetic) < 1e-8 * rolling_energy(of["surfaceEnergy"], packing.radius.min(), of["criticalRolling"])
    assert np.linalg.norm(after["position"] - before["position"], axis=1).max() < 1e-5 * packing.radius.min()
