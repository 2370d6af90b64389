"""Packings are saved and loaded to the bit, and made from the command line."""

import os

import numpy as np
import pytest
from of_ice import OVERLAP
from refused import refused
from running import make_packing

from yade_scripts import packings

TWO = np.array([[0.0, 0, 0], [1.99e-7, 0, 0]])


@pytest.mark.parametrize("content", [None, b"", b"not an archive", "other arrays", "nested parameters", "a pipe"])
def test_what_is_no_packing_gives_one_line(tmp_path, content):
    path = tmp_path / "a.npz"
    if content == "other arrays":
        np.savez(path, x=1)
    elif content == "nested parameters":
        np.savez(path, position=TWO, radius=[1e-7] * 2, seed=1, parameters="[" * 100_000)
    elif content == "a pipe":
        os.mkfifo(path)
    elif content is not None:
        path.write_bytes(content)
    with refused(packings.PackingError, "is no regular file" if content == "a pipe" else "not a packing", str(path)):
        packings.load(path)


@pytest.mark.parametrize(
    "position, radius, message",
    [
        (TWO * (np.nan, 1, 1), [1e-7] * 2, "'position' holds a value that is not finite"),
        (TWO, [1e-7, np.nan], "'radius' holds a value that is not finite, first at index 1"),
        (TWO, [1e-7, 0], "'radius' is 0 at index 1; must be > 0"),
        (TWO, [1e-7], "'position' has the shape (2, 3), expected (1, 3)"),
        (TWO[:, :2], [1e-7] * 2, "'position' has the shape (2, 2), expected (2, 3)"),
        (np.zeros((0, 3)), [], "holds no grain"),
        (TWO * 1e300, [1e-7] * 2, "'position' holds a value that is beyond 1e+100"),
        (TWO * 0.4, [1e-7] * 2, "grains 0 and 1 overlap by 1.2e-07 m; must be less than the smaller radius"),
        (TWO / 3, [1e-7, 1e-9], "grains 0 and 1 overlap by 3.47e-08 m; must be less than the smaller radius"),
    ],
)
def test_arrays_that_are_no_packing_give_one_line(tmp_path, position, radius, message):
    np.savez(tmp_path / "a.npz", position=position, radius=np.array(radius), seed=1, parameters="{}")
    with refused(packings.PackingError, f"{tmp_path}/a.npz: ", message):
        packings.load(tmp_path / "a.npz")


def test_the_command_makes_packings_and_says_of_what(tmp_path):
    done = make_packing(tmp_path, "a.npz", "b.npz", "radius=10", "seed=3")
    assert done.returncode == 0, done.stderr
    for index, name in enumerate(["a.npz", "b.npz"]):
        loaded, expected = packings.load(tmp_path / name), packings.cpe(0.4, 10 * 1e-7, 1e-7, OVERLAP, 3, index)
        assert np.array_equal(loaded.position, expected.position) and np.array_equal(loaded.radius, expected.radius)
        assert loaded.seed == 3 and expected.parameters.items() <= loaded.parameters.items()
    shown = make_packing(tmp_path, "--help").stdout
    assert "cpe or bcca or bpca" in " ".join(shown.split())
    for name in ("density", "criticalRolling", "viscoelasticTime", "file"):
        assert f"\n  {name}" not in shown
    assert "\n  surfaceEnergy" in shown
