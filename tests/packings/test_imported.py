"""Aggregates of other programs: formats, units, which grains touch, and that all of it is at rest in a run."""

from dataclasses import asdict
from functools import lru_cache

import numpy as np
import pytest
import yaml
from of_ice import OVERLAP, RADIUS
from refused import refused
from running import make_packing
from scenes import *
from written_runs import losing, record, state_arrays, write_run

from analysis.export.formats import poly_data
from analysis.measures.fragments import fragment_labels
from analysis.runs.files import npz
from analysis.theory.aggregates import rolling_energy
from yade_scripts import packings
from yade_scripts.experiments.collision import CollisionParameters, place
from yade_scripts.materials import MATERIALS, equilibrium_overlap
from yade_scripts.packings.aggregate import AggregateParameters, make
from yade_scripts.packings.imported import imported
from yade_scripts.parameters import ParameterError
from yade_scripts.run.parameters import from_arguments

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
BOX = np.array([[-0.07, 3.13], [0.21, 3.41], [-0.33, 2.87]])  # um, in which aggregates are cut by its sides
PROPERTIES = "{n}\nProperties=species:S:1:pos:R:3:velo:R:3:radius:R:1 Time=0.5\n"


def legacy_vtk(t):
    radii = "\nPOINT_DATA {n}\nSCALARS radius double 1\nLOOKUP_TABLE default\n"
    return rows(t[:, :3], VTK) + rows(t[:, 3:], radii.replace("{n}", str(len(t))))


def vtp(t):
    return poly_data(t[:, :3].astype(float), {"mass": np.ones(len(t)), "radius": t[:, 3].astype(float)})


def wrapped(t, row, columns, scaled=False):
    """A periodic dump: positions within BOX, or fractions of it, and how many boxes grains have left."""
    low, edges = BOX[:, 0], np.ptp(BOX, axis=1)
    position = t[:, :3].astype(float)
    boxes = np.floor((position - low) / edges).astype(int)
    inside = position - boxes * edges
    texts = np.vectorize(repr)((inside - low) / edges if scaled else inside)
    bounds = "".join(f"{low} {high}\n" for low, high in BOX)
    head = DUMP.replace("-9 9\n" * 3, bounds) + f"ITEM: ATOMS {columns}\n"
    return rows(np.column_stack([texts, t[:, 3], boxes.astype(str)]), head, row)


def yaml_of(t):
    about = {"n_particles": len(t), "length_unit": "1", "positions": t[:, :3].astype(float).tolist()}
    return yaml.dump({"aggregate": {**about, "radii": t[:, 3].astype(float).tolist()}}, sort_keys=False)


# What each program writes, from a table (N,4) of texts x y z radius in um.
FORMATS = {
    "csv": lambda t: rows(t, "x,y,z,radius\n", separator=","),
    "csv of ParaView": lambda t: rows(t, '"radius","Points:0","Points:1","Points:2"\n', "{4},{1},{2},{3}"),
    "csv without names": lambda t: rows(t, separator=", "),
    "csv of Excel": lambda t: rows(np.char.replace(t, ".", ","), "X;Y;Z;Radius\n", separator=";"),
    "csv of pandas": lambda t: rows(t, "   x y z radius\n", "{i} {}"),
    "Fortran": lambda t: rows(np.char.add(t, "D+00"), "! about the x y z axes\n"),
    "OVITO": lambda t: rows(t, '# "Particle Identifier" "Position.X" "Position.Y" "Position.Z" "Radius"\n', "{i} {}"),
    "xyz": lambda t: rows(t, "{n}\n{n} atoms\n", "Si {}"),
    "xyz, two frames": lambda t: "2\nfirst\nC 0 0 0\nC 9 9 9\n" + rows(t, "{n}\nlast\n", "C {}"),
    "extended xyz": lambda t: rows(t, PROPERTIES, "X {1} {2} {3} 0 0 0 {4}"),
    "LAMMPS data": lambda t: rows(twice(t), DATA, "{i} 1 {4} 1000 {1} {2} {3} 0 0 0")
    + "\nVelocities\n\n1 0 0 0 0 0 0\n",
    "LAMMPS dump": lambda t: rows(t, DUMP + "ITEM: ATOMS id type xu yu zu radius\n", "{i} 1 {}"),
    "LAMMPS dump, scaled": lambda t: wrapped(t, "{i} 1 {}", "id type xs ys zs radius ix iy iz", scaled=True),
    "LAMMPS dump, not wrapped": lambda t: rows(t, DUMP + "ITEM: ATOMS id ix iy iz xu yu zu radius\n", "{i} 1 2 3 {}"),
    "LAMMPS dump, first frame empty": lambda t: DUMP.format(n=0)
    + "ITEM: ATOMS id x y z radius\n"
    + rows(t, DUMP + "ITEM: ATOMS id x y z radius\n", "{i} {}"),
    "DustCollider, dump": lambda t: rows(t, DUMP + "ITEM: ATOMS id mol type x y z radius\n", "{i} 0 1 {}"),
    "legacy VTK": legacy_vtk,
    "XML of VTK": vtp,
    "pyFracAggregate": yaml_of,
    "a count and rows": lambda t: rows(t, "{n}\n"),
    "FracVAL": lambda t: rows(t, row="  {1}  {2}  {3}  {4}    "),
    "PyFracVAL": lambda t: rows(t, "# simulation_parameters:\n#   N: {n}\n#   - -242.92\n"),
    "npz": lambda t: npz(pos=t[:, :3].astype(float), radii=t[:, 3].astype(float)),
    "YADE": lambda t: rows(t, "#format id_x_y_z_r_matId\n", "{i}\t{1}\t{2}\t{3}\t{4}\t0"),
}


def twice(table):
    """With diameters in the place of radii."""
    return np.column_stack([table[:, :3], [repr(2 * float(x)) for x in table[:, 3]]])


def pairs_of(packing):
    return set(map(tuple, packings.contacts(packing)))


def write(path, packing, decimals, form="csv"):
    table = np.column_stack([packing.position, packing.radius]) * 1e6
    content = FORMATS[form](np.vectorize(lambda x: f"{x:.{decimals}f}")(table))
    path.write_bytes(content.encode() if isinstance(content, str) else content)
    return str(path)


def pieces(packing):
    return int(fragment_labels(packing.grains, packings.contacts(packing)).max()) + 1


@pytest.mark.parametrize("decimals", [4, 17])
@pytest.mark.parametrize("form", FORMATS)
def test_a_round_trip_gives_the_same_contacts(tmp_path, form, decimals):
    """Lengths in um: four decimals are a thousandth of a grain's radius."""
    for name in OURS:
        packing = ours(name)
        back, _ = imported(write(tmp_path / "a", packing, decimals, form), dict(unit="um", pieces=pieces(packing)))
        assert pairs_of(back) == pairs_of(packing), name
        assert np.abs(back.position - packings.centred(packing.position, packing.radius)).max() < 0.05 * RADIUS


def test_an_aggregate_that_a_periodic_box_cuts_is_whole(tmp_path):
    packing = ours("bpca")
    table = np.vectorize(lambda x: f"{x:.5f}")(np.column_stack([packing.position, packing.radius]) * 1e6)
    (tmp_path / "a").write_text(wrapped(table, "{i} {1} {2} {3} {4}", "id x y z radius"))
    back, lines = imported(str(tmp_path / "a"), dict(unit="um"))
    assert "periodic" in lines[0] and pairs_of(back) == pairs_of(packing)
    through = np.array([[repr(0.2 * i), "1", "1", "0.1"] for i in range(16)])
    (tmp_path / "b").write_text(wrapped(through, "{i} {1} {2} {3} {4}", "id x y z radius"))
    with refused(packings.PackingError, "touch their own images"):
        imported(str(tmp_path / "b"), dict(unit="um", pieces="largest"))


def touching_at_the_sum_of_radii(name):
    return make(AggregateParameters.parse(OURS[name]), 1e-9 * OVERLAP, 0)


@pytest.mark.in_yade
@pytest.mark.parametrize("name, material", [("cpe", "silicate"), ("bpca", "ice"), ("lognormal", "ice")])
def test_nothing_moves_in_a_run(tmp_path, name, material):
    """Grains that other programs write 2 r apart, to four decimals: over 2000 t0 no contact breaks or forms."""
    written = touching_at_the_sum_of_radii(name)
    file, given = write(tmp_path / "a.csv", written, 4), dict(unit="um", pieces=pieces(written), material=material)
    packing, _ = imported(file, given)
    of = asdict(MATERIALS[material])
    del of["grainRadius"]
    before, after, kinetic = set_free(packing, JKRMat(**of))
    assert len(before["contact_pairs"]) == len(after["contact_pairs"]) == len(packings.contacts(packing))
    assert kinetic < 1e-8 * rolling_energy(of["surfaceEnergy"], packing.radius.min(), of["criticalRolling"])
    assert np.linalg.norm(after["position"] - before["position"], axis=1).max() < 1e-5 * packing.radius.min()


# Five tetrahedra around an edge, with a gap of 7.4 degrees that contacts of all neighbours would have to close.
BIPYRAMID = "0 0 1\n0 0 -1\n" + "".join(
    f"{1.701302 * np.cos(a):.6f} {1.701302 * np.sin(a):.6f} 0\n" for a in np.arange(5) * 0.4 * np.pi
)
LINE = "x,y,z\n0,0,0\n0.2,0,0\n"
UM = dict(unit="um", radius="0.1")


WRONG = [
    (LINE.replace("0.2", "nan"), UM, "position: must be "),
    ("x,y\n0,0\n0.2,0\n", UM, "no z among its columns x, y"),
    (LINE, dict(UM, radius="0.09"), "in 2 pieces of 1, 1 grains, up to 0.223 radii of the smallest apart"),
    ("x [nm],y [nm],z [nm]\n0,0,0\n0.2,0,0\n", UM, "must be left out"),
    ("# lengths in nm\n0 0 0\n0.2 0 0\n", UM, "must be left out"),
    ("# coordinates (nanometres)\n0 0 0\n0.2 0 0\n", UM, "is in nm; must be left out"),
    ("x [\u00c5],y [nm],z [nm]\n0,0,0\n0.2,0,0\n", UM, "names several units of length, angstrom, nm"),
    ("# x y z\n0 0 0 7 7\n0.2 0 0 7 7\n", UM, "columns without a name"),
    (LINE, dict(radius="0.1"), "as with unit=cm or unit=mm or unit=um"),
    (DATA.format(n=9) + "1 1 0.2 1 0 0 0\n", dict(unit="um"), "1 rows of numbers; must be 9"),
    (2 * (DUMP + "ITEM: ATOMS id x y z\n").format(n=0), UM, "LAMMPS dump, the last of 2 frames: 0 rows of numbers"),
    (BIPYRAMID, dict(unit="radius"), "cannot be brought to rest together: grains 0 and 1"),
    ("GIF89a\0\0\0", UM, "of an unknown format"),
]


@pytest.mark.parametrize("text, given, message", WRONG)
def test_what_is_wrong_gives_one_line(tmp_path, capfd, text, given, message):
    path = tmp_path / "a"
    path.write_text(text)
    with refused((packings.PackingError, ParameterError), message):
        imported(str(path), given)
    assert capfd.readouterr() == ("", "")


YAML = "# ----\naggregate:\n  length_unit: um\n  positions: [[0, 0, 0], [0.2, 0, 0]]\n  radii: [0.1, 0.1]\n"


@pytest.mark.parametrize(
    "text, given, radius",
    [
        ("X [nm] , Y [nm], Z [nm]\n0, 0, 0\n200, 0, 0\n", dict(unit="nm", radius="100"), 1e-7),
        ("x [\u00c5],y [\u00c5],z [\u00c5]\n0,0,0\n2000,0,0\n", dict(radius="1000"), 1e-7),
        ("# lengths in Microns, velocities in metres per second\n0 0 0\n0.2 0 0\n", dict(radius="0.1"), 1e-7),
        ("# all lengths in 1e-6 m\n0 0 0\n0.2 0 0\n", dict(radius="0.1"), 1e-7),
        ('x,y,z,radius,note\n0,0,0,0.1,"a, b"\n0.2,0,0,0.1,"c"\n', dict(unit="um"), 1e-7),
        ("-1.0 0.0 0.0\n1.0 0.0 0.0\n", dict(unit="radius", grainRadius="2e-7"), 2e-7),
        ("2 400 300\n# four\n# lines\n# of\n# text\n0 0 0 0 100 0 1\n200 0 0 0 100 0 1\n", {}, 1e-7),
        (YAML, {}, 1e-7),
        ("0.1 7 0 0 0\n0.1 7 0.2 0 0\n", dict(unit="um", names="radius,-,x,y,z"), 1e-7),
        ("0 0 0\n0.205 0 0\n", dict(UM, tolerance="0.06"), 1e-7),
    ],
)
def test_units_names_and_tolerance(tmp_path, text, given, radius):
    (tmp_path / "a").write_text(text)
    packing, _ = imported(str(tmp_path / "a"), given)
    assert packing.radius.tolist() == pytest.approx([radius] * 2, rel=1e-12)
    depth = 2 * radius - np.linalg.norm(np.diff(packing.position, axis=0))
    assert depth == pytest.approx(OVERLAP * (radius / RADIUS) ** (1 / 3), rel=1e-3)


def test_a_state_and_a_packing_are_of_the_material_that_they_say(tmp_path):
    """Grains of silicate, 0.6 um, that were taken for ice would have contacts out of rest."""
    made = AggregateParameters.parse(dict(packing="bpca", grains=40, material="silicate"))
    overlap = equilibrium_overlap(made)
    packing = make(made, overlap, 0)
    packings.save(tmp_path / "a.npz", packing)
    still = 0 * packing.position
    state = state_arrays(0.0, packing.position, still, np.zeros(40), packings.contacts(packing))
    state["radius"] = packing.radius
    run = write_run(tmp_path / "run", {**record(1e-6), "derived": made.as_dict()}, losing(np.array([0, 1e-9])), [state])
    for file in (tmp_path / "a.npz", run / "states" / "000000.npz"):
        done = make_packing(tmp_path, "b.npz", f"from={file}")
        assert done.stdout.endswith("in a run: packing=file file=b.npz material=silicate\n"), done.stderr
        assert packings.load(tmp_path / "b.npz").parameters["overlap"] == pytest.approx(overlap)
        assert imported(str(file), dict(material="ice", pieces="largest"))[0].parameters["young"] == 7e9
    (run / "states" / "000000.npz").rename(tmp_path / "000000.npz")
    with refused(packings.PackingError, "a state of a run, but ", "must be in RUN/states, or material be given"):
        imported(str(tmp_path / "000000.npz"), {})


def test_the_command_names_the_run_that_takes_the_packing(tmp_path):
    written = touching_at_the_sum_of_radii("lognormal")
    source, file = write(tmp_path / "a.xyz", written, 4, "xyz"), tmp_path / "a.npz"
    done = make_packing(tmp_path, str(file), f"from={source}", "unit=um", "material=silicate")
    assert done.returncode == 0, done.stderr
    assert "100 grains in 1 piece, 99 contacts" in done.stdout
    of_run = CollisionParameters.parse(from_arguments(done.stdout.split("in a run: ")[1].split()))
    assert place(of_run, equilibrium_overlap(of_run))[1][0].grains == 100
