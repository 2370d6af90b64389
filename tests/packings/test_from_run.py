"""Packings out of runs: spheres cut out of a compression, the largest piece of a collision; contacts are at rest."""

import os

import pytest
from of_ice import GRAINS, ICE, OVERLAP
from of_ice import SPACING as APART
from running import COMPRESS, completed, make_packing
from scenes import *
from written_runs import PAIR, cubic_lattice, losing, record, state_arrays, write_run

from yade_scripts import packings
from yade_scripts.packings.from_run import CutParameters, PeriodicState, cut, largest_piece_of_run, turned
from yade_scripts.packings.packing import packing_from_file


def pressed_lattice(noise=0.0):
    """A simple cubic lattice in its cell, neighbours closer than at rest by a strain of 0.004, sites moved by `noise`
    [m]."""
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


# ---- what a collision left ----

R = 1e-7
AT_REST = 2 * R - PAIR.equilibrium_overlap


def made_run(path, bonded=False):
    """Seven grains: a vibrating bent chain of four, a piece of two, and one alone."""
    stretched = np.array([0.0, 0.999, 2.003, 2.9, 10.0, 10.95, 20.0]) * 2 * R
    position = np.column_stack([stretched, np.zeros(7), np.zeros(7)])
    position[3] = position[2] + 1.002 * AT_REST * np.array([0.6, 0.8, 0.0])
    state = state_arrays(1e-9, position, 0 * position, [0, 0, 0, 0, 1, 1, 1], [[0, 1], [1, 2], [2, 3], [4, 5]])
    state["contact_bonded"][:] = bonded
    about = record(4 * R, {"packing": "bcca", "seed": 5})
    return write_run(path, about, losing(np.array([0, 1e-9])), [{**state, "time": 0.0}, state])


def test_the_largest_piece_of_a_collision_is_at_rest_and_hardly_moved(tmp_path):
    packing = largest_piece_of_run(made_run(tmp_path / "run"))
    assert packing.grains == 4 and packing.seed == 5 and packing.parameters["of"] == 7
    assert packings.contacts(packing).tolist() == [[0, 1], [1, 2], [2, 3]]
    distance = np.linalg.norm(np.diff(packing.position, axis=0), axis=1)
    assert distance == pytest.approx(AT_REST, abs=2e-3 * PAIR.equilibrium_overlap)
    assert 0 < packing.parameters["largestMotion"] < 0.02 * R
    assert packing.position.mean(axis=0) == pytest.approx(0, abs=1e-12 * R)
    assert np.all(packing.position[:, 2] == 0)
    one, other = turned(packing, 3, 0), turned(packing, 3, 1)
    assert np.all(one.position[:, 2] == 0) and not np.allclose(one.position, other.position)
    assert packings.gyration_radius(one) == pytest.approx(packings.gyration_radius(packing), rel=1e-12)
    packings.save(tmp_path / "a.npz", one)
    back = packing_from_file(str(tmp_path / "a.npz"), GRAINS, PAIR.equilibrium_overlap, planar=True)
    assert np.allclose(back.position, one.position, atol=1e-12 * R)
    assert packings.load(tmp_path / "a.npz").parameters["packing"] == "collided"
