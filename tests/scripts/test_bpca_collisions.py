"""Collisions of BPCA aggregates as a user runs them: oblique, with drag, of unlike sizes, from files; their early end."""

import numpy as np
import pytest
from running import completed

from analysis.measures.fragments import fragment_labels, fragment_sizes
from analysis.runs.folder import open_run
from yade_scripts import packings
from yade_scripts.materials import MATERIALS, equilibrium_overlap

OVERLAP = equilibrium_overlap(MATERIALS["ice"])
TINY = ("packing=bpca", "grains=40", "velocity=40", "stepFraction=0.2", "threads=1")


def fragments(run):
    return sorted(fragment_sizes(fragment_labels(len(run.last.radius), run.last.contact_pairs)))


def test_a_collision_with_drag_ends_early_with_the_fragments_of_the_whole_time(tmp_path):
    arguments = (*TINY, "viscoelasticTime=6e-12", "impact=0.6", "duration=6e-7", "states=7", "seed=3")
    for name in ("whole", "early"):
        (tmp_path / name).mkdir()
    whole, history = completed(tmp_path / "whole", *arguments)
    early, shorter = completed(tmp_path / "early", *arguments, "endWhenApart=1")
    assert whole["timeReached"] == pytest.approx(6e-7, rel=1e-2)
    assert early["outcome"] == "completed" and early["timeReached"] < 0.8 * whole["timeReached"]
    run, other = (open_run(tmp_path / name / "run") for name in ("early", "whole"))
    assert run.ended and shorter["time"][-1] == early["timeReached"] == run.last.time and len(other.states) == 7
    assert fragments(run) == fragments(other)
    # until then the two are the same run
    assert np.array_equal(shorter["rollingDissipation"], history["rollingDissipation"][: len(shorter["time"])])
    assert shorter["drag"][-1] > 0 and early["derived"]["targetCharacteristicRadius"] > 0


def test_aggregates_that_pass_each_other(tmp_path):
    """Seeds that miss at B_off = 1: with a duration a run that ends at once."""
    run, history = completed(tmp_path, *TINY, "impact=1", "seed=1", "duration=4e-7", "endWhenApart=1")
    assert run["timeReached"] < 3e-7 and "firstTouch" not in run["derived"]
    assert fragments(open_run(tmp_path / "run")) == [40, 40] and np.all(history["contacts_between"] == 0)


def test_unlike_grains_and_unlike_aggregates(tmp_path):
    arguments = ("projectileGrains=20", "sizes=two", "sizeRatio=1.5", "stepFraction=0.1", "duration=5e-8")
    run, _ = completed(tmp_path, *TINY[:3], "threads=1", *arguments)
    assert (run["derived"]["targetGrains"], run["derived"]["projectileGrains"]) == (40, 20)
    state = open_run(tmp_path / "run").start
    assert np.bincount(state.aggregate).tolist() == [40, 20] and set(np.unique(state.radius)) == {1e-7, 1.5e-7}
    momentum = (state.radius**3)[:, None] * state.velocity
    assert np.abs(momentum.sum(axis=0)).max() < 1e-9 * np.abs(momentum).sum()


def test_aggregates_from_files(tmp_path):
    for name, grains, index in (("a", 30, 0), ("b", 20, 1)):
        packings.save(tmp_path / f"{name}.npz", packings.bpca(grains, 1e-7, OVERLAP, 3, index))
    files = ("packing=file", "file=a.npz", "projectileFile=b.npz")
    run, _ = completed(tmp_path, *files, "velocity=30", "threads=1", "duration=2e-8")
    assert (run["parameters"]["grains"], run["derived"]["projectileGrains"]) == (30, 20)
