"""The largest piece that a collision left, as a packing."""

import numpy as np
import pytest
from written_runs import PAIR, RADIUS, losing, record, state_arrays, write_run

from yade_scripts.packings import contacts, gyration_radius, load, save
from yade_scripts.packings.collided import largest_piece_of_run, turned
from yade_scripts.packings.from_file import packing_from_file
from yade_scripts.packings.packing import PackingError

REST = 2 * RADIUS - PAIR.equilibrium_overlap


def made_run(path, bonded=False):
    """Seven grains: a vibrating bent chain of four, a piece of two, and one alone."""
    stretched = np.array([0.0, 0.999, 2.003, 2.9, 10.0, 10.95, 20.0]) * 2 * RADIUS
    position = np.column_stack([stretched, np.zeros(7), np.zeros(7)])
    position[3] = position[2] + 1.002 * REST * np.array([0.6, 0.8, 0.0])
    state = state_arrays(1e-9, position, 0 * position, [0, 0, 0, 0, 1, 1, 1], [[0, 1], [1, 2], [2, 3], [4, 5]])
    state["contact_bonded"][:] = bonded
    about = record(4 * RADIUS, {"packing": "bcca", "seed": 5})
    return write_run(path, about, losing(np.array([0, 1e-9])), [{**state, "time": 0.0}, state])


def test_at_rest_hardly_moved_turned_in_its_plane_and_saved_for_the_next_run(tmp_path):
    packing = largest_piece_of_run(made_run(tmp_path / "run"))
    assert packing.grains == 4 and packing.seed == 5 and packing.parameters["of"] == 7
    assert contacts(packing).tolist() == [[0, 1], [1, 2], [2, 3]]
    distance = np.linalg.norm(np.diff(packing.position, axis=0), axis=1)
    assert distance == pytest.approx(REST, abs=2e-3 * PAIR.equilibrium_overlap)
    assert 0 < packing.parameters["largestMotion"] < 0.02 * RADIUS
    assert packing.position.mean(axis=0) == pytest.approx(0, abs=1e-12 * RADIUS)
    assert np.all(packing.position[:, 2] == 0)
    one, other = turned(packing, 3, 0), turned(packing, 3, 1)
    assert np.all(one.position[:, 2] == 0) and not np.allclose(one.position, other.position)
    assert gyration_radius(one) == pytest.approx(gyration_radius(packing), rel=1e-12)
    save(tmp_path / "a.npz", one)
    back = packing_from_file(str(tmp_path / "a.npz"), RADIUS, PAIR.equilibrium_overlap, planar=True)
    assert np.allclose(back.position, one.position, atol=1e-12 * RADIUS)
    assert load(tmp_path / "a.npz").parameters["packing"] == "collided"


def test_what_is_no_such_run_is_refused(tmp_path):
    with pytest.raises(PackingError, match="must be a run folder"):
        largest_piece_of_run(tmp_path)
    with pytest.raises(PackingError, match="with sintered bonds"):
        largest_piece_of_run(made_run(tmp_path / "bonded", bonded=True))
