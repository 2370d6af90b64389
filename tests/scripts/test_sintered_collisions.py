"""Sintered collisions in a plane: bonds break, by mode; the ledger has bondBreaking, and closes."""

import numpy as np
import pytest
from running import completed, read_arrays, read_json, states

from analysis.runs.folder import open_run
from analysis.runs.format import BROKEN_BONDS, CHANNELS

PLANAR = "radius=6 filling=0.7 planar=1 velocity=60 duration=6e-9 seed=2 stepFraction=0.05 neck=0.5".split()


@pytest.fixture(scope="module", params=["fused", "functors"])
def run(request, tmp_path_factory):
    folder = tmp_path_factory.mktemp(request.param)
    completed(folder, *PLANAR, f"engine={request.param}")
    return folder / "run"


def test_bonds_break_new_contacts_are_none_and_a_plane_stays_one_to_the_bit(run):
    all_states = states(run)
    assert all_states[0]["contact_bonded"].all() and len(all_states[0]["contact_bonded"]) >= 50
    number = [state["contact_bonded"].sum() for state in all_states]
    assert number == sorted(number, reverse=True) and number[-1] < number[0]
    end = all_states[-1]
    sides = end["aggregate"][end["contact_pairs"]]
    between = sides[:, 0] != sides[:, 1]
    assert between.any() and not end["contact_bonded"][between].any()
    for state in all_states:
        assert np.all(state["position"][:, 2] == 0) and np.all(state["velocity"][:, 2] == 0)
        assert np.all(state["angular_velocity"][:, :2] == 0)
    assert np.any(end["angular_velocity"][:, 2] != 0)


def test_broken_bonds_by_mode_are_in_history_and_states(run):
    """As many as the states have lost; read back by the analysis."""
    read, history = open_run(run), read_arrays(run, "history.npz")
    broken = np.stack([history[name] for name in BROKEN_BONDS], axis=1)
    assert broken.dtype.kind == "i" and not broken[0].any() and (np.diff(broken, axis=0) >= 0).all()
    assert broken[-1, 3] == 0 and broken[-1].sum() > 5  # in a plane nothing twists
    first = read.start.contact_bonded.sum()
    for state in read.states:
        assert state.contact_neck.tolist() == (0.5 * state.contact_bonded).tolist()
        assert first - state.contact_bonded.sum() == state.bonds_broken.sum()
        assert state.bonds_broken.tolist() in broken.tolist()
    assert (read.last.bonds_broken == broken[-1]).all()
    assert all((read.history[name] == history[name]).all() for name in BROKEN_BONDS)


def test_runs_without_bonds_have_no_columns_for_them(tmp_path):
    completed(tmp_path, "radius=3", "velocity=10", "duration=1e-9")
    read = open_run(tmp_path / "run")
    assert not set(BROKEN_BONDS) & set(read.history) and read.last.contact_neck is None is read.last.bonds_broken


def test_ledger_has_bond_breaking_and_closes_and_run_json_tells_of_the_bonds(run):
    history = read_arrays(run, "history.npz")
    broken = history["bondBreaking"]
    assert broken[0] == 0 and broken[-1] > 0
    total = sum(history[channel] for channel in CHANNELS)
    assert np.abs(total - total[0]).max() < 2e-3 * history["kinetic"][0]
    assert np.all(history["twisting"] == 0)
    about = read_json(run, "run.json")
    parameters, derived = about["parameters"], about["derived"]
    assert parameters["neck"] == 0.5 and parameters["planar"] == 1
    assert derived["neckRadius"] == pytest.approx(0.5e-7)
    assert derived["shrunkRadius"] == pytest.approx(0.9806e-7, rel=1e-4)
    assert derived["breakingEnergy"] == pytest.approx(np.pi * 0.25e-14 * 0.1)
    assert derived["aggregateRadius"] == pytest.approx(parameters["radius"] * 1e-7)
