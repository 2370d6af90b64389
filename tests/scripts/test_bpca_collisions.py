"""Collisions of BPCA aggregates as a user runs them: oblique, with drag, of unlike sizes, from files; their early end."""

import numpy as np
import pytest
from running import collide, collided, messages, read_arrays, read_json

from analysis.measures.fragments import fragment_labels, fragment_sizes
from analysis.runs.folder import open_run
from yade_scripts import packings
from yade_scripts.materials import MATERIALS, equilibrium_overlap

OVERLAP = equilibrium_overlap(MATERIALS["ice"])
TINY = ("packing=bpca", "grains=40", "velocity=40", "stepFraction=0.2", "threads=1")


def fragments(path):
    run = open_run(path)
    return sorted(fragment_sizes(fragment_labels(len(run.last.radius), run.last.contact_pairs)))


def completed(folder, *arguments):
    collided(folder, *arguments)
    return read_json(folder, "run", "run.json")


def test_a_collision_with_drag_ends_early_with_the_fragments_of_the_whole_time(tmp_path):
    arguments = (*TINY, "viscoelasticTime=6e-12", "impact=0.6", "duration=6e-7", "states=7", "seed=3")
    (tmp_path / "whole").mkdir()
    (tmp_path / "early").mkdir()
    whole = completed(tmp_path / "whole", *arguments, "out=run")
    early = completed(tmp_path / "early", *arguments, "endWhenApart=1", "out=run")
    assert (
        whole["timeReached"] == pytest.approx(6e-7, rel=1e-2) and len(open_run(tmp_path / "whole" / "run").states) == 7
    )
    assert early["outcome"] == "completed" and early["timeReached"] < 0.8 * whole["timeReached"]
    run = open_run(tmp_path / "early" / "run")
    assert run.ended and run.history["time"][-1] == early["timeReached"] == run.last.time
    assert fragments(tmp_path / "early" / "run") == fragments(tmp_path / "whole" / "run")
    # until then the two are the same run
    one, other = (read_arrays(tmp_path / name / "run" / "history.npz") for name in ("early", "whole"))
    assert np.array_equal(one["rollingDissipation"], other["rollingDissipation"][: len(one["time"])])
    assert one["drag"][-1] > 0 and early["derived"]["targetCharacteristicRadius"] > 0


def test_aggregates_that_pass_each_other(tmp_path):
    """Seeds that miss at B_off = 1: without a duration that is one line, with one a run that ends at once."""
    refused = collide(tmp_path, *TINY, "impact=1", "seed=1")
    assert refused.returncode == 2 and "would never meet; must be another impact or seed" in messages(refused)[0]
    run = completed(tmp_path, *TINY, "impact=1", "seed=1", "duration=4e-7", "endWhenApart=1", "out=run")
    assert run["timeReached"] < 3e-7 and "firstTouch" not in run["derived"]
    assert fragments(tmp_path / "run") == [40, 40]
    assert np.all(open_run(tmp_path / "run").history["contacts_between"] == 0)


def test_unlike_grains_and_unlike_aggregates(tmp_path):
    arguments = ("projectileGrains=20", "sizes=two", "sizeRatio=1.5", "stepFraction=0.1", "duration=5e-8", "out=run")
    run = completed(tmp_path, "packing=bpca", "grains=40", "velocity=40", "threads=1", *arguments)
    assert (run["derived"]["targetGrains"], run["derived"]["projectileGrains"]) == (40, 20)
    state = open_run(tmp_path / "run").start
    assert np.bincount(state.aggregate).tolist() == [40, 20] and set(np.unique(state.radius)) == {1e-7, 1.5e-7}
    momentum = (state.radius**3)[:, None] * state.velocity
    assert np.abs(momentum.sum(axis=0)).max() < 1e-9 * np.abs(momentum).sum()


def test_aggregates_from_files_and_one_that_is_wrong(tmp_path):
    for name, grains, index in (("a", 30, 0), ("b", 20, 1)):
        packings.save(tmp_path / f"{name}.npz", packings.bpca(grains, 1e-7, OVERLAP, 3, index))
    arguments = ("packing=file", "file=a.npz", "velocity=30", "threads=1", "duration=2e-8", "out=run")
    run = completed(tmp_path, *arguments, "projectileFile=b.npz")
    assert (run["parameters"]["grains"], run["derived"]["projectileGrains"]) == (30, 20)
    with np.load(tmp_path / "a.npz") as file:
        arrays = dict(file)
    arrays["position"][3] = np.nan
    np.savez(tmp_path / "a.npz", **arrays)
    refused = collide(tmp_path, *arguments[:-1], "out=other")
    assert refused.returncode == 2 and not (tmp_path / "other").exists()
    assert messages(refused) == ["collide.py: a.npz: position holds what is no finite number; must be finite [m]"]
