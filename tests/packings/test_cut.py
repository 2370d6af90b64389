"""Spheres cut out of a compression: what is kept, contacts at rest, and what moves when they are set free."""

import os
import subprocess
import sys

import numpy as np
import pytest

from analysis.runs.format import CHANNELS
from yade_scripts import packings
from yade_scripts.materials import MATERIALS, equilibrium_overlap
from yade_scripts.packings.cut import CutParameters, PeriodicState, cut

TOP = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
OVERLAP = equilibrium_overlap(MATERIALS["ice"])
APART = 2e-7 - OVERLAP


def pressed_lattice(side=8, strain=0.004, noise=0.0, seed=1):
    """A simple cubic lattice in its cell, neighbours closer than at rest by a strain, sites moved by `noise` [m]."""
    edge = APART * (1 - strain)
    site = np.stack(np.meshgrid(*3 * [np.arange(side)], indexing="ij"), axis=-1).reshape(-1, 3)
    row = {tuple(s): k for k, s in enumerate(site)}
    pairs = [(row[tuple(s)], row[tuple((s + n) % side)]) for s in site for n in np.eye(3, dtype=int)]
    position = edge * site + noise * np.random.default_rng(seed).normal(size=site.shape)
    return PeriodicState(position, np.full(len(site), 1e-7), np.array(pairs), np.full(3, side * edge), OVERLAP)


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


def test_a_function_of_state_seed_and_index():
    state = pressed_lattice()
    one, same, other = (cut(state, CutParameters.parse({"radius": 5, "seed": 3}), index) for index in (0, 0, 1))
    assert np.array_equal(one.position, same.position)
    assert one.grains != other.grains or not np.allclose(one.position, other.position)


def test_grains_that_lost_their_neighbours_are_dropped():
    state = pressed_lattice()
    loose = PeriodicState(state.position * 1.3, state.radius, state.contact_pairs[:40], state.cell_size * 1.3, OVERLAP)
    packing = cut(loose, CutParameters.parse({"radius": 7, "seed": 1}))
    assert packing.parameters["dropped"] > packing.grains
    first, second = packings.contacts(packing).T
    assert len(set(first) | set(second)) == packing.grains


def make_packing(folder, *arguments):
    command = [sys.executable, os.path.join(TOP, "yade_scripts", "make_packing.py"), *arguments]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True)


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """A fast compression to a filling of 0.4."""
    folder = tmp_path_factory.mktemp("cut")
    script = os.path.join(TOP, "yade_scripts", "compress.py")
    given = ("grains=512", "strainRate=1e-4", "stepFraction=0.2", "finalFilling=0.4", "threads=1", "out=run")
    done = subprocess.run(["yade", "-n", "-x", script, *given], cwd=folder, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    return folder


def test_command_line(run):
    last = sorted(os.listdir(run / "run" / "states"))[-1]
    done = make_packing(run, "a.npz", "b.npz", f"from=run/states/{last}", "radius=7", "seed=1")
    assert done.returncode == 0, done.stderr
    for name in ("a.npz", "b.npz"):
        packing = packings.load(run / name)
        assert 0.25 < packing.parameters["filling"] < 0.55
        assert overlaps(packing) == pytest.approx(OVERLAP, rel=2e-3)
        of_ice = {name: getattr(MATERIALS["ice"], name) for name in ("young", "poisson", "surfaceEnergy")}
        assert {name: packing.parameters[name] for name in of_ice} == of_ice
        assert f"{name}: {packing.grains} grains" in done.stdout


@pytest.mark.parametrize(
    "arguments, message",
    [
        (["from=run/states/000020.npz"], "radius: not given; must be that of the sphere to cut [grain radii]"),
        (
            ["from=run/states/000020.npz", "radius=90"],
            "radius = 90: a larger sphere than the cell holds; must be at most",
        ),
        (["from=run/states/none.npz", "radius=5"], "must be a state of a compression, RUN/states/NNNNNN.npz"),
        (["from=run/run.json", "radius=5"], "must be a state of a compression, RUN/states/NNNNNN.npz"),
        (
            ["from=run/states/000020.npz", "radius=5", "filling=0.4"],
            "filling: unknown parameter; must be one of radius, seed",
        ),
        (
            ["run/states/000020.npz", "from=run/states/000020.npz", "radius=5"],
            "make_packing.py: run/states/000020.npz: is what is read; must be another file",
        ),
    ],
)
def test_wrong_input_gives_one_line(run, arguments, message):
    done = make_packing(run, "x.npz", *arguments)
    assert done.returncode != 0 and done.stderr.count("\n") == 1 and message in done.stderr
    assert not (run / "x.npz").exists()


def test_what_moves_when_a_cut_sphere_is_set_free(yade, run):
    """Without any damping, over 2000 t0: no contact breaks or forms, and grains move by thousandths of a radius."""
    last = sorted(os.listdir(run / "run" / "states"))[-1]
    assert make_packing(run, "c.npz", f"from=run/states/{last}", "radius=7", "seed=2").returncode == 0
    found = yade(
        """
from scenes import *
from analysis.runs.format import CHANNELS
from yade_scripts import packings
packing = packings.load(parameters["file"])
c = constants(ice(), 1e-7)
new_scene(0.1 * c["timeUnit"])
for x, r in zip(packing.position, packing.radius):
    grain(x, r, ice())
fused_engine(subSteps=100)
O.dt *= 100
O.engines[0].prepare()
start = contact_law.snapshot()
O.run(200, True)
end = contact_law.snapshot()
have = dict(O.energy.items())
result["moved"] = float(np.linalg.norm(end["position"] - start["position"], axis=1).max() / 1e-7)
result["contacts"] = [len(start["contact_pairs"]), len(end["contact_pairs"])]
result["kinetic"] = have["kinetic"] / (c["pullOffForce"] * c["pullOffOverlap"] * len(packing.radius))
result["force"] = float(np.abs(start["contact_normal_force"]).max() / c["pullOffForce"])
""",
        {"file": str(run / "c.npz")},
    )
    print(found)
    assert found["contacts"][0] == found["contacts"][1] > 100
    assert found["force"] < 5e-3 and found["moved"] < 5e-3 and found["kinetic"] < 1e-5


def test_cut_spheres_collide(run):
    """collide.py packing=file takes two of them; until they meet nothing moves in them."""
    last = sorted(os.listdir(run / "run" / "states"))[-1]
    assert make_packing(run, "d.npz", "e.npz", f"from=run/states/{last}", "radius=6", "seed=4").returncode == 0
    script = os.path.join(TOP, "yade_scripts", "collide.py")
    given = (
        "packing=file",
        "file=d.npz",
        "projectileFile=e.npz",
        "velocity=3",
        "duration=5e-9",
        "threads=1",
        "out=met",
    )
    done = subprocess.run(["yade", "-n", "-x", script, *given], cwd=run, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    with np.load(run / "met" / "history.npz") as history:
        assert np.ptp(history["contacts"]) == 0 and history["contacts"][0] > 100
        total = sum(history[name] for name in CHANNELS)
        assert np.abs(total - total[0]).max() < 1e-9 * history["kinetic"][0]
        assert np.ptp(history["kinetic"]) < 1e-4 * history["kinetic"][0]
