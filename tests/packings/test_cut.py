"""Spheres cut out of a compression: what is kept, contacts at rest, and what moves when they are set free."""

import os
from dataclasses import replace

import pytest
from of_ice import ICE, OVERLAP
from of_ice import SPACING as APART
from running import COMPRESS, completed, make_packing
from scenes import *
from written_runs import cubic_lattice

from yade_scripts import packings
from yade_scripts.packings.cut import CutParameters, PeriodicState, cut
from yade_scripts.parameters import ParameterError


def pressed_lattice(noise=0.0):
    """A simple cubic lattice in its cell, neighbours closer than at rest by a strain of 0.004, sites moved by `noise` [m]."""
    side, edge = 8, APART * (1 - 0.004)
    site, pairs = cubic_lattice(side)
    position = edge * site + noise * np.random.default_rng(1).normal(size=site.shape)
    return PeriodicState(position, np.full(len(site), 1e-7), pairs, np.full(3, side * edge), OVERLAP)


def overlaps(packing):
    first, second = packings.contacts(packing).T
    return 2e-7 - np.linalg.norm(packing.position[first] - packing.position[second], axis=1)


@pytest.mark.parametrize("noise", [0.0, 1e-10])
def test_contacts_come_to_rest_by_a_small_motion(noise):
    state = pressed_lattice(noise=noise)
    packing = cut(state, CutParameters.parse({"radius": 6, "seed": 2}))
    assert overlaps(packing) == pytest.approx(OVERLAP, rel=2e-3)
    # Strained by 0.4 %, a sphere of 6 radii is too small by 0.024 radii at its surface.
    assert 0 < packing.parameters["largestMotion"] < 0.04e-7 + 20 * noise
    assert packing.grains == pytest.approx(4 / 3 * np.pi * (6e-7 / APART) ** 3, rel=0.1)
    assert packing.parameters["filling"] == pytest.approx(packing.grains / 6**3)
    assert packings.extent(packing) < 6.8e-7
    assert len(packings.contacts(packing)) > 2 * packing.grains


def test_a_function_of_state_seed_and_index_without_grains_that_lost_their_neighbours():
    state = pressed_lattice()
    one, same, other = (cut(state, CutParameters.parse({"radius": 5, "seed": 3}), index) for index in (0, 0, 1))
    assert np.array_equal(one.position, same.position)
    assert one.grains != other.grains or not np.allclose(one.position, other.position)
    loose = PeriodicState(state.position * 1.3, state.radius, state.contact_pairs[:40], state.cell_size * 1.3, OVERLAP)
    packing = cut(loose, CutParameters.parse({"radius": 7, "seed": 1}))
    assert packing.parameters["dropped"] > packing.grains
    first, second = packings.contacts(packing).T
    assert len(set(first) | set(second)) == packing.grains


def test_between_walls_the_sphere_is_too():
    """The layer fills a third of its cell."""
    state = pressed_lattice()
    edge = state.cell_size[2]
    walls = np.array([-1.0, 7.0]) * edge / 8
    layer = replace(state, cell_size=state.cell_size * [1, 1, 3], axis=2, walls=walls)
    for seed in range(8):
        given = CutParameters.parse({"radius": 7, "seed": seed})
        between, free = (cut(own, given).parameters["filling"] for own in (layer, state))
        assert between > 0.9 * free
    with pytest.raises(ParameterError, match="^radius = 9: a larger sphere than the space between the walls holds"):
        cut(layer, CutParameters.parse({"radius": 9}))


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """A fast compression to a filling of 0.4, in the folder run."""
    folder = tmp_path_factory.mktemp("cut")
    given = ("grains=512", "strainRate=1e-4", "stepFraction=0.2", "finalFilling=0.4", "threads=1")
    completed(folder, *given, script=COMPRESS)
    return folder


def last_state(run):
    return f"from=run/states/{sorted(os.listdir(run / 'run' / 'states'))[-1]}"


def test_command_line(run):
    done = make_packing(run, "a.npz", "b.npz", last_state(run), "radius=7", "seed=1")
    assert done.returncode == 0, done.stderr
    for name in ("a.npz", "b.npz"):
        packing = packings.load(run / name)
        assert 0.25 < packing.parameters["filling"] < 0.55
        assert overlaps(packing) == pytest.approx(OVERLAP, rel=2e-3)
        assert all(packing.parameters[name] == getattr(ICE, name) for name in ("young", "poisson", "surfaceEnergy"))
        assert f"{name}: {packing.grains} grains" in done.stdout


STATE = "run/states/000020.npz"
WRONG = {
    f"from={STATE}": "radius: not given; must be that of the sphere to cut [grain radii]",
    f"from={STATE} radius=90": "radius = 90: a larger sphere than the cell holds; must be at most",
    "from=run/states/none.npz radius=5": "run/states/none.npz: No such file or directory",
    "from=run/run.json radius=5": "run/run.json: of an unknown format; must be npz, csv, xyz, LAMMPS",
    f"from={STATE} radius=5 filling=0.4": "filling: unknown parameter; must be one of radius, seed",
    f"{STATE} from={STATE} radius=5": f"make_packing.py: {STATE}: is what is read; must be another file",
}


@pytest.mark.parametrize("arguments", WRONG)
def test_wrong_input_gives_one_line(run, arguments):
    done = make_packing(run, "x.npz", *arguments.split())
    assert done.returncode != 0 and done.stderr.count("\n") == 1 and WRONG[arguments] in done.stderr
    assert not (run / "x.npz").exists()


@pytest.mark.in_yade
def test_what_moves_when_a_cut_sphere_is_set_free(run):
    """Without any damping, over 2000 t0: no contact breaks or forms, and grains move by thousandths of a radius."""
    assert make_packing(run, "c.npz", last_state(run), "radius=7", "seed=2").returncode == 0
    packing, c = packings.load(run / "c.npz"), constants(ice(), 1e-7)
    before, after, kinetic = set_free(packing, ice())
    assert len(before["contact_pairs"]) == len(after["contact_pairs"]) > 100
    assert np.abs(before["contact_normal_force"]).max() < 5e-3 * c["pullOffForce"]
    assert np.linalg.norm(after["position"] - before["position"], axis=1).max() < 5e-3 * 1e-7
    assert kinetic < 1e-5 * c["pullOffForce"] * c["pullOffOverlap"] * packing.grains
