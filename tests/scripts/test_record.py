"""contact_law.record(): the run of a script of one's own is a run, which the analysis reads and which goes on."""

import os
import signal

import numpy as np
import pytest
from running import TOP, call, forked, messages, same_bits, start, wait_for

from analysis import open_run, table
from analysis.__main__ import main
from analysis.runs.status import verify_run

SCENE = """
import sys
sys.path.insert(0, {top!r})
import contact_law
from yade_scripts import packings

words, folder, steps, R = sys.argv[1], sys.argv[2], int(sys.argv[3]), 1e-7
ice = JKRMat(young=7e9, poisson=0.25, density=1000, surfaceEnergy=0.1, criticalRolling=0.8e-9, label="ice")
sand = JKRMat(young=54e9, poisson=0.17, density=2600, surfaceEnergy=0.025, criticalRolling=0.8e-9, label="sand")
constants = Ip2_JKRMat_JKRMat_JKRWadaPhys().pairConstants(ice, R, ice, R)
position = packings.bcca(60, R, constants["equilibriumOverlap"], seed=3).position
position += 2 * R - position.min(axis=0)
for number, place in enumerate(position):
    grain = utils.sphere(place, R, material=sand if "two" in words and number % 3 == 0 else ice)
    grain.state.vel = (0, 0, -20) if number % 2 else (0, 0, 0)
    O.bodies.append(grain)
if "cell" in words:
    O.periodic = True
    O.cell.setBox(*3 * [position.max() + 2 * R])
    O.cell.velGrad = Matrix3.Identity * -1e-4 / constants["timeUnit"]
if "wall" in words:
    O.bodies.append(utils.wall(0, axis=2, material=ice))
functors = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb()], verletDist=0.1 * R),
    InteractionLoop(
        [Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom()],
        [Ip2_JKRMat_JKRMat_JKRWadaPhys()],
        [Law2_ScGeom_JKRWadaPhys_JKRWada()],
    ),
    NewtonIntegrator(damping=0),
]
fused = "fused" in words
O.engines = [JKRWadaEngine(subSteps=10)] if fused else functors
O.dt = (10 if fused else 1) * 0.05 * constants["timeUnit"]
if "bonds" in words:
    O.engines[0].prepare() if fused else O.step()
    contact_law.sinter(0.5)
"""
RECORD = """
contact_law.record(
    folder,
    every=10,
    states=5,
    series=lambda: {"y": O.bodies[7].state.pos[1], "x": O.bodies[7].state.pos[0]},
    parameters={"words": words},
    aggregate=lambda body: body.id % 2,
    interval=0.1,
    resume=True,
)
O.run(steps - O.iter, True)
"""


@pytest.fixture(scope="module")
def script(tmp_path_factory):
    """The path of a script: scene.py WORDS FOLDER STEPS."""
    file = tmp_path_factory.mktemp("script") / "scene.py"
    file.write_text(SCENE.format(top=TOP) + RECORD)
    return str(file)


def recorded(folder, script, words, steps=101):
    """The RunFolder of a run of the scene in a folder."""
    done = forked(folder, script, words, "run", str(steps))
    assert done.returncode == 0 and messages(done) == [], done.stderr
    return open_run(folder / "run")


@pytest.mark.parametrize(
    "words", ["fused wall", "fused cell two", "fused bonds", "functors two wall", "functors cell", "functors bonds"]
)
def test_any_script_leaves_a_run_that_the_analysis_reads(script, tmp_path, words):
    run = recorded(tmp_path, script, words)
    assert run.ended and verify_run(tmp_path / "run")[0] == [] and run.parameters["words"] == words
    step = run.derived["timeStep"] * (10 if "fused" in words else 1)
    assert np.allclose(run.history["time"] - run.history["time"][0], 10 * step * np.arange(len(run.history["time"])))
    saved = set(range(0, len(run.history["time"]), 5)) | {len(run.history["time"]) - 1}
    assert run.states.times.tolist() == run.history["time"][sorted(saved)].tolist()
    assert run.history["x"][-1] != run.history["x"][0] and np.all(run.last.aggregate == np.arange(60) % 2)
    assert (run.last.cell_size is None) == ("cell" not in words)
    assert (run.last.plane_axis is None) == ("wall" not in words)
    if "two" in words:
        assert [material["name"] for material in run.derived["materials"]] == ["sand", "ice"]
        assert np.all(run.last.material == (np.arange(60) % 3 > 0))
        assert np.isclose(run.last.mass[0], 2.6 * run.last.mass[1])
    if "bonds" in words:
        assert run.start.contact_bonded.all() and "brokenByRolling" in run.history
    found = table(tmp_path / "run")
    assert found.energy_closure[0] < (2e-3 if "cell" not in words or "fused" in words else 1) and found.ended[0]
    for command in ("summary", "view", "film", "figures", "export"):
        assert main([command, str(tmp_path / "run")]) == 0


@pytest.fixture(scope="module")
def straight(script, tmp_path_factory):
    """The folder of a run that nothing stops, of a YADE of its own."""
    folder = tmp_path_factory.mktemp("straight")
    done = call(folder, "yade", "-n", "-x", script, "fused wall", "run", "4000")
    assert done.returncode == 0 and messages(done) == [] and open_run(folder / "run").ended
    return folder / "run"


@pytest.mark.parametrize("number, status", [(signal.SIGINT, 1), (signal.SIGTERM, 143), (signal.SIGKILL, -9)])
def test_a_script_that_was_stopped_goes_on_to_the_same_bits(script, straight, tmp_path, number, status):
    arguments = ("yade", "-n", "-x", script, "fused wall", "run", "4000")
    process, checkpoint = start(tmp_path, *arguments), tmp_path / "run/checkpoint/recorder.npz"
    wait_for(lambda: checkpoint.exists() or process.poll() is not None)
    process.send_signal(number)
    output, errors = process.communicate(timeout=60)
    assert process.returncode == status and checkpoint.exists(), errors
    stopped = open_run(tmp_path / "run")
    assert not stopped.ended and stopped.last.time > 0
    assert stopped.record["status"] == ("running" if number == signal.SIGKILL else "interrupted")
    assert recorded(tmp_path, script, "fused wall", 4000).ended
    assert same_bits(tmp_path / "run", straight)


def test_engines_materials_and_grains_that_change_are_recorded(script, tmp_path):
    file = tmp_path / "scene.py"
    more = """
O.engines = functors
O.dt /= 10
O.run(101, True)
O.bodies.append(utils.sphere(position[0] - 5 * R, R, material=ice))
O.dt *= 10
O.engines = [JKRWadaEngine(subSteps=10)]
O.run(50, True)
contact_law.set_material(ice, surfaceEnergy=0.05)
O.run(50, True)
"""
    file.write_text(open(script).read() + more)
    run = recorded(tmp_path, str(file), "fused two")
    known = [(own["name"], own["surfaceEnergy"]) for own in run.derived["materials"]]
    assert known == [("sand", 0.025), ("ice", 0.1), ("ice", 0.05)]
    assert np.all(run.last.material[:60] == np.where(run.start.material, 2, 0)) and run.derived["pullOffEnergies"][2]
    assert len(run.start.radius) == 60 and len(run.last.radius) == 61 and run.last.aggregate[-1] == 0
    assert len(run.history["time"]) == 11 + 10 + 5 + 5


def test_misuse_and_failures_have_one_line_and_no_end(script, tmp_path):
    """What goes wrong in a row is raised by O.run(); a script that raises has not ended."""
    text, errors = open(script).read(), {}
    changes = {
        "every": ("every=10", "every=0.5"),
        "name": ('"y"', '"kinetic"'),
        "number": ("O.bodies[7].state.pos[1]", '"wide"'),
        "later": ('{"y": O.bodies[7].state.pos[1],', '{("y" if O.iter < 50 else "z"): 1,'),
        "after": ("O.run(steps", "O.ruin(steps"),
        "exit": ("O.run(steps - O.iter, True)", "exit(1)"),
        "again": ("O.run(steps", "O.resetTime(), O.run(steps"),
        "early": ("O.engines = [JKRWadaEngine(subSteps=10)] if fused else functors", ""),
    }
    for name, (old, new) in changes.items():
        (tmp_path / "scene.py").write_text(text.replace(old, new))
        done = forked(tmp_path, "scene.py", "fused wall", name, "101")
        errors[name] = done.stderr.strip().rpartition("\n")[2]
        assert done.returncode == 1 and not os.path.exists(tmp_path / name / "ended")
    assert "every = 0.5" in errors["every"] and "series: kinetic" in errors["name"]
    assert "could not convert" in errors["number"] and "series: y is missing" in errors["later"]
    assert "O.resetTime(): a run is being recorded" in errors["again"]
    assert "'ruin'" in errors["after"] and "must come after" in errors["early"]
    assert open_run(tmp_path / "later").record["status"].startswith("failed: series")
    (tmp_path / "scene.py").write_text(text)
    recorded(tmp_path, "scene.py", "fused")
    done = forked(tmp_path, "scene.py", "fused", "run", "101")
    assert "run: holds a run that has ended" in done.stderr.splitlines()[-1]
