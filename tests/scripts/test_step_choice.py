"""stepFraction=auto: the step that is chosen, and that real runs keep to the tolerance."""

import numpy as np
import pytest
from refused import refused
from running import SCRIPTS, TINY, collide, messages, read_json, study
from scipy.stats import binom

from analysis import table
from yade_scripts import time_step
from yade_scripts.experiments import collision, compression
from yade_scripts.experiments.collision import KIND
from yade_scripts.materials import pair_constants
from yade_scripts.parameters import ParameterError
from yade_scripts.run.checkpoint import difference
from yade_scripts.run.parameters import from_arguments
from yade_scripts.run.table import write

AUTO = {"stepFraction": "auto"}
parse = KIND.parse


def chosen(**given):
    """(parameters, constants, limit) of a scene with stepFraction=auto."""
    kind = compression if "strainRate" in given else collision
    parameters = kind.KIND.parse({**AUTO, **given})
    if kind is compression:
        constants = pair_constants(parameters, linearDamping=parameters.linearDamping)
        limit = time_step.step_limit(constants, parameters.finalFilling or compression.FINAL_FILLING)
    else:
        constants = {"bond": None, **pair_constants(parameters, neck=parameters.neck)}
        limit = collision.step_limit(parameters, constants)
    return kind.complete(parameters, constants, 1), constants, limit


def expected_error(parameters, constants):
    of_kind = time_step.compression_error if hasattr(parameters, "strainRate") else time_step.collision_error
    return of_kind(parameters, constants) * parameters.stepFraction**2


SCENES = [
    "",
    "packing=bpca grains=5000 velocity=50 viscoelasticTime=1e-12",
    "packing=bcca grains=1000 projectileGrains=100 neck=0.3 velocity=4",
    "strainRate=3e-07 finalFilling=0.2",
]


@pytest.mark.parametrize("scene", SCENES)
def test_the_step_is_the_longest_of_two_digits_that_keeps_to_the_tolerance(scene):
    steps, scene = [], from_arguments(scene.split())
    for tolerance in (1e-5, 1e-4, 1e-3, 1e-2):
        found, constants, limit = chosen(tolerance=tolerance, **scene)
        steps.append(found.stepFraction)
        assert 0.01 <= steps[-1] <= limit and expected_error(found, constants) <= tolerance
        if steps[-1] < limit:
            assert steps[-1] == float(f"{steps[-1]:.2g}")
            assert expected_error(found.changed(stepFraction=1.11 * steps[-1]), constants) > tolerance
    assert steps == sorted(steps) and steps[0] < steps[-1]


def test_the_limits_of_stability_and_of_the_tolerance():
    for scene in ({"viscoelasticTime": 6e-12}, {"filling": 0.7}):
        found, _, limit = chosen(tolerance=1e-2, **scene)
        assert found.stepFraction == limit < 0.4
    with refused(ParameterError, "tolerance = 1e-07: would take a step of 0.00", " in this scene, for 0.01 t0"):
        chosen(tolerance=1e-7, velocity=0.5)


@pytest.mark.in_yade
@pytest.mark.parametrize(
    "case",
    [
        {"viscoelasticTime": 4e-12, "poisson": 0.3, "grainRadius": 3e-7, "density": 800, "criticalRolling": 2e-9},
        {"material": "silicate", "viscoelasticTime": 1e-11, "young": 30e9, "surfaceEnergy": 0.1},
        {"neck": 0.5, "slidingStiffnessFactor": 2, "rollingStiffnessFactor": 8},
    ],
    ids=str,
)
def test_constants_for_estimates_are_the_plugins(case):
    """By which study.py knows a row's step without the plugin."""
    from yade_scripts.run import scene

    parameters = parse(case)
    plugins = scene.pair_constants(parameters, parameters.neck, linearDamping=0.02)
    ours = {"bond": {}, **pair_constants(parameters, neck=parameters.neck, linearDamping=0.02)}
    bond = ours.pop("bond")
    assert {key: plugins[key] for key in ours} == pytest.approx(ours, rel=1e-12)
    assert {key: plugins["bond"][key] for key in bond} == pytest.approx(bond, rel=1e-12)


# Scenes that are in no fit: other velocities, sizes, fillings, drags, seeds.
NOT_FITTED = """
seed=1000 radius=7 velocity=0.8 filling=0.45 tolerance=0.001
seed=1002 radius=8 velocity=2.3 filling=0.5 viscoelasticTime=2e-12 tolerance=0.0001
seed=1006 radius=6 velocity=6.5 filling=0.38 tolerance=0.0003
seed=1014 radius=7 velocity=45 filling=0.45 viscoelasticTime=3e-12 tolerance=0.001
seed=1016 radius=8 velocity=0.7 filling=0.5 material=silicate tolerance=0.001
seed=2000 packing=bpca grains=250 velocity=47 viscoelasticTime=2e-12 tolerance=0.0003
seed=2000 packing=bcca grains=120 projectileGrains=50 velocity=11 tolerance=0.001
seed=2000 radius=6 limit=cut criticalRolling=3e-10 velocity=9 tolerance=0.001
seed=2000 radius=6 neck=0.6 velocity=2.2 tolerance=0.0003
seed=2000 grains=90 strainRate=0.00021 linearDamping=0 tolerance=0.0002
target=wall seed=3000 velocity=3.3 radius=5 filling=0.4 tolerance=0.0003
target=wall seed=3012 velocity=9.4 packing=bpca grains=60 tolerance=0.001
boundary=walls seed=4000 grains=70 finalFilling=0.3 strainRate=0.00028 tolerance=0.001
"""


def test_runs_that_are_in_no_fit_keep_to_the_tolerance(tmp_path):
    """With 1 in 20 beyond it at most, more than so many would be a chance of 0.3 %. None is far beyond it, nor are
    steps much shorter than they need be."""
    scenes = [from_arguments(line.split()) for line in NOT_FITTED.split("\n")[1:-1]]
    script = lambda scene: f"{SCRIPTS}/{'compress' if 'strainRate' in scene else 'collide'}.py"
    rows = [
        {**AUTO, "threads": 1, **scene, "out": f"runs/{k:02}", "!SCRIPT": script(scene)}
        for k, scene in enumerate(scenes)
    ]
    write(tmp_path / "scenes.table", rows)
    done = study(tmp_path, "scenes.table", "-j", "1")
    assert done.returncode == 0, done.stderr
    found = table(tmp_path / "runs")
    assert list(found.run) == [f"{k:02}" for k in range(len(scenes))]
    over = found.energy_closure.to_numpy() / [float(scene["tolerance"]) for scene in scenes]
    assert np.all(over > 1e-6), over  # all met
    assert np.count_nonzero(over > 1) <= binom.ppf(0.997, len(over), 0.05), over
    assert over.max() < 3 and np.median(over) > 0.03, over


@pytest.mark.parametrize(
    "given, what",
    [
        ({"packing": "file", "file": "any.npz"}, "packing = file"),
        ({"strainRate": 1e-5, "finalFilling": 0.6}, "finalFilling = 0.6, only 0.1 to 0.5"),
    ],
)
def test_what_was_not_measured_is_refused(given, what):
    kind = compression if "strainRate" in given else collision
    parameters = (compression if "strainRate" in given else collision).KIND.parse({**AUTO, **given})
    with refused(ParameterError, f"stepFraction = auto: not measured with {what}"):
        kind.complete(parameters, pair_constants(parameters), 1)


def test_a_run_keeps_what_it_chose_and_its_row_agrees_with_it(tmp_path):
    """A row that gives auto, or the step that was chosen, and the estimate counts the steps that will be chosen."""
    process = collide(tmp_path, *TINY, "stepFraction=auto", "tolerance=3e-4", "out=run")
    assert process.returncode == 0 and messages(process) == [], process.stderr
    about = read_json(tmp_path, "run", "run.json")
    step, derived = about["parameters"]["stepFraction"], about["derived"]
    assert derived["timeStep"] == step * derived["timeUnit"]
    assert f"step: {derived['stepChoice']}" in process.stdout.splitlines()
    assert step == chosen(tolerance=3e-4, radius=4, velocity=30)[0].stepFraction
    tiny = dict(argument.split("=") for argument in TINY)
    row, same = parse({**tiny, **AUTO, "tolerance": 3e-4}), parse({**tiny, "stepFraction": step})
    assert difference(KIND, row, about) is None is difference(KIND, same, about)
    assert difference(KIND, parse({**tiny, **AUTO}), about) == "tolerance = 0.0003, not 0.0001"
    assert difference(KIND, parse(tiny), about) == f"stepFraction = {step:g}, not 0.1"
    assert KIND.estimate(row) == KIND.estimate(same) != KIND.estimate(parse(tiny))
