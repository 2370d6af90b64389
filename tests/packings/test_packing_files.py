"""Packings are saved and loaded to the bit, and made from the command line."""

import os
import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.append(str(Path(__file__).resolve().parent.parent / "scripts"))
from running import PYTHON, SCRIPTS, call

from yade_scripts import packings
from yade_scripts.materials import MATERIALS, equilibrium_overlap

OVERLAP = equilibrium_overlap(MATERIALS["ice"])


def test_save_and_load(tmp_path):
    saved = packings.cpe(0.4, 8e-7, 1e-7, OVERLAP, 3, 1)
    packings.save(tmp_path / "a.npz", saved)
    loaded = packings.load(tmp_path / "a.npz")
    assert np.array_equal(saved.position, loaded.position) and np.array_equal(saved.radius, loaded.radius)
    assert (saved.seed, saved.parameters) == (loaded.seed, loaded.parameters)
    assert os.listdir(tmp_path) == ["a.npz"]


@pytest.mark.parametrize("content", [None, b"", b"not an archive", "other arrays"])
def test_what_is_no_packing_gives_one_line(tmp_path, content):
    path = tmp_path / "a.npz"
    if content == "other arrays":
        np.savez(path, x=1)
    elif content is not None:
        path.write_bytes(content)
    with pytest.raises(packings.PackingError, match="not a packing") as error:
        packings.load(path)
    assert "\n" not in str(error.value) and str(path) in str(error.value)


TWO = np.array([[0.0, 0, 0], [1.99e-7, 0, 0]])


@pytest.mark.parametrize(
    "position, radius, message",
    [
        (TWO * (np.nan, 1, 1), [1e-7] * 2, "position holds what is no finite number"),
        (TWO, [1e-7, np.nan], "radius holds what is no finite number"),
        (TWO, [1e-7, 0], "radius of grain 1 is 0; must be > 0"),
        (TWO, [1e-7], r"position has the shape \(2, 3\), radius \(1,\)"),
        (TWO[:, :2], [1e-7] * 2, r"position has the shape \(2, 2\), radius \(2,\)"),
        (np.zeros((0, 3)), [], "N >= 1"),
        (TWO * 0.4, [1e-7] * 2, "grains 0 and 1 overlap by 1.2e-07 m; must be less than the smaller radius"),
        (TWO / 3, [1e-7, 1e-9], "grains 0 and 1 overlap by 3.47e-08 m; must be less than the smaller radius"),
    ],
)
def test_arrays_that_are_no_packing_give_one_line(tmp_path, position, radius, message):
    np.savez(tmp_path / "a.npz", position=position, radius=np.array(radius), seed=1, parameters="{}")
    with pytest.raises(packings.PackingError, match=message) as error:
        packings.load(tmp_path / "a.npz")
    assert "\n" not in str(error.value) and str(error.value).startswith(str(tmp_path))


def test_a_pipe_and_nested_parameters_are_no_packing(tmp_path):
    os.mkfifo(tmp_path / "pipe.npz")
    with pytest.raises(packings.PackingError, match="pipe.npz: is no regular file"):
        packings.load(tmp_path / "pipe.npz")
    np.savez(tmp_path / "a.npz", position=TWO, radius=[1e-7] * 2, seed=1, parameters="[" * 100_000)
    with pytest.raises(packings.PackingError, match="not a packing"):
        packings.load(tmp_path / "a.npz")


def make_packing(folder, *arguments):
    return call(folder, PYTHON, os.path.join(SCRIPTS, "make_packing.py"), *arguments)


def test_command_line(tmp_path):
    done = make_packing(tmp_path, "a.npz", "b.npz", "radius=10", "seed=3")
    assert done.returncode == 0, done.stderr
    for index, name in enumerate(["a.npz", "b.npz"]):
        expected = packings.cpe(0.4, 10 * 1e-7, 1e-7, OVERLAP, 3, index)
        assert np.array_equal(packings.load(tmp_path / name).position, expected.position)


@pytest.mark.parametrize(
    "arguments, message",
    [
        ("a.npz filling=0.8", "must be at most 0.7519"),
        ("a.npz radius=-3", "radius = -3: must be > 0 [grain radii]"),
        ("a.npz velocity=3", "velocity: unknown parameter; must be one of packing, filling"),
        ("a.npz density=900", "density: a packing doesn't depend on it; must be left out"),
        ("a.npz surfaceEnergy=1e4 unusual=1", "grainRadius = 1e-07: contacts at rest have a radius of "),
        ("nowhere/a.npz", "nowhere"),
        ("a.txt", "a.txt: a packing is saved as .npz; must end in .npz"),
        ("a.npz b.npz from={here}", "b.npz: from = {here} is one aggregate; must be one file"),
        ("a.npz from={here} unit=km", "unit = km: must be m or cm or mm or um or nm or radius"),
        ("a.npz ./a.npz radius=3", "./a.npz: given twice; must be two files, one for each aggregate"),
        ("a.npz packing=file file=b.npz", "packing = file: must be cpe or bcca or bpca"),
    ],
)
def test_command_line_errors(tmp_path, arguments, message):
    failed = make_packing(tmp_path, *arguments.format(here=__file__).split())
    assert failed.returncode != 0
    assert message.format(here=__file__) in failed.stderr and failed.stderr.count("\n") == 1
    assert os.listdir(tmp_path) == []


def test_help_offers_what_a_packing_may_be_made_of(tmp_path):
    shown = make_packing(tmp_path, "--help").stdout
    assert "cpe or bcca or bpca" in " ".join(shown.split())
    for refused in ("density", "criticalRolling", "viscoelasticTime", "file"):
        assert f"\n  {refused}" not in shown
    assert "\n  surfaceEnergy" in shown
