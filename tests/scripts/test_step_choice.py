"""stepFraction=auto: the step that is chosen, what is said of it, and that real runs keep to the tolerance."""

import re

import numpy as np
import pytest
from errors import of_scripts
from refused import refused
from running import TINY, collide, messages, read_json
from scipy.stats import binom

from yade_scripts import stability
from yade_scripts import step_choice as rule
from yade_scripts.experiments import collision, collision_step, compression
from yade_scripts.experiments.collision import KIND
from yade_scripts.materials import pair_constants
from yade_scripts.parameters import ParameterError
from yade_scripts.run.resuming import difference

AUTO = {"stepFraction": "auto"}
parse = KIND.parse


def chosen(**given):
    """(parameters, constants, limit) of a scene with stepFraction=auto."""
    kind = compression if "strainRate" in given else collision
    parameters = kind.KIND.parse({**AUTO, **given})
    if kind is compression:
        constants = pair_constants(parameters, linearDamping=parameters.linearDamping)
        limit = stability.step_limit(constants, parameters.finalFilling or compression.FINAL_FILLING)
    else:
        constants = {"bond": None, **pair_constants(parameters, neck=parameters.neck)}
        limit = collision_step.step_limit(parameters, constants)
    return kind.complete(parameters, constants, 1), constants, limit


def expected_error(parameters, constants):
    of_kind = rule.compression_errors if hasattr(parameters, "strainRate") else rule.collision_errors
    return sum(of_kind(parameters, constants).values()) * parameters.stepFraction**2


def test_auto_and_its_tolerance():
    found = parse({"stepFraction": "'auto'", "velocity": "2"})
    assert (found.stepFraction, found.tolerance) == ("auto", 1e-4)
    assert found.out == "runs/collide-ice-f0.4-R20-v2-s1-stepFractionauto"
    assert parse({**AUTO, "tolerance": "10**-5"}).tolerance == 1e-5
    assert parse({}).tolerance is None


SCENES = [
    {}, {"velocity": 30}, {"velocity": 0.5}, {"radius": 8}, {"radius": 60, "filling": 0.3}, {"material": "silicate"},
    {"packing": "bpca", "grains": 5000, "velocity": 50, "viscoelasticTime": 1e-12},
    {"packing": "bcca", "grains": 500, "planar": 1, "limit": "cut"},
    {"packing": "bcca", "grains": 1000, "projectileGrains": 100, "neck": 0.3, "velocity": 4},
    {"strainRate": 3e-7, "finalFilling": 0.2}, {"strainRate": 3e-7, "linearDamping": 0},
]  # fmt: skip


@pytest.mark.parametrize("scene", SCENES, ids=str)
def test_the_step_is_the_longest_of_two_digits_that_keeps_to_the_tolerance(scene):
    steps = []
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
    with pytest.raises(ParameterError) as error:
        chosen(tolerance=1e-7, velocity=0.5)
    words = r"tolerance = 1e-07: would take a step of 0\.00\d+ t0; must be at least (\S+) in this scene, for 0\.01 t0, or .*"
    least = float(re.fullmatch(words, str(error.value)).group(1))
    assert 0.01 <= chosen(tolerance=least, velocity=0.5)[0].stepFraction < 0.011


REASONS = {
    "6400 grains at 1 m/s, no drag (set by forming and breaking contacts; limit of stability 0.4 t0)": {"velocity": 1},
    "6400 grains at 30 m/s, no drag (set by the speed of the impact; limit": {"velocity": 30},
    "T_vis = 6 ps (set by the limit of stability, where ": {"viscoelasticTime": 6e-12, "tolerance": 1e-3},
    "no drag, necks of 0.5 (set by breaking bonds; limit": {"neck": 0.5, "velocity": 30, "radius": 8},
}


@pytest.mark.parametrize("part", REASONS)
def test_it_says_why(part):
    found, constants, _ = chosen(**REASONS[part])
    text = collision_step.reason_of_step(found, constants)
    assert text.startswith(f"{found.stepFraction:.3g} t0 for a ledger error of at most ") and part in text


@pytest.mark.in_yade
@pytest.mark.parametrize(
    "case",
    [
        {"material": "ice"},
        {"viscoelasticTime": 4e-12, "poisson": 0.3, "grainRadius": 3e-7},
        {"material": "silicate", "viscoelasticTime": 1e-11, "young": 30e9, "surfaceEnergy": 0.1},
        {"density": 800, "criticalRolling": 2e-9},
        {"neck": 0.3},
        {"neck": 0.5, "slidingStiffnessFactor": 2},
        {"neck": 0.65, "material": "silicate"},
    ],
    ids=str,
)
def test_constants_for_estimates_are_the_plugins(case):
    """What study.py works a row's step out with, without the plugin."""
    from yade_scripts.run import scene

    parameters = parse(case)
    plugins = scene.pair_constants(parameters, parameters.neck, linearDamping=0.02)
    ours = {"bond": {}, **pair_constants(parameters, neck=parameters.neck, linearDamping=0.02)}
    bond = ours.pop("bond")
    assert {key: plugins[key] for key in ours} == pytest.approx(ours, rel=1e-12)
    assert {key: plugins["bond"][key] for key in bond} == pytest.approx(bond, rel=1e-12)


# Scenes that are in no fit: other velocities, sizes, fillings, drags, seeds.
COLUMNS = ("radius", "velocity", "filling", "viscoelasticTime", "material", "tolerance")
OTHER_SCENES = [
    (7, 0.8, 0.45, 0, "ice", 1e-3), (9, 1.5, 0.35, 0, "ice", 1e-4), (8, 2.3, 0.5, 2e-12, "ice", 1e-4),
    (12, 2.3, 0.3, 0, "ice", 1e-4), (8, 4.2, 0.4, 0, "ice", 3e-5), (11, 4.2, 0.55, 4e-12, "ice", 1e-4),
    (6, 6.5, 0.38, 0, "ice", 3e-4), (9, 6.5, 0.28, 1e-12, "ice", 1e-4), (13, 8.5, 0.42, 0, "ice", 1e-4),
    (7, 13, 0.6, 0, "ice", 1e-4), (9, 13, 0.33, 5e-12, "ice", 3e-5), (6, 21, 0.5, 0, "ice", 1e-3),
    (10, 21, 0.4, 0, "ice", 1e-4), (8, 45, 0.35, 0, "ice", 1e-4), (7, 45, 0.45, 3e-12, "ice", 1e-3),
    (6, 2, 0.4, 0, "silicate", 1e-4), (8, 0.7, 0.5, 0, "silicate", 1e-3), (6, 17, 0.35, 0, "silicate", 1e-3),
]  # fmt: skip


# Of every other kind, likewise.
OTHER_KINDS = {
    "bpca": {"packing": "bpca", "grains": 170, "velocity": 17, "impact": 0.2, "tolerance": 3e-4},
    "bpca, drag": {"packing": "bpca", "grains": 250, "velocity": 47, "viscoelasticTime": 2e-12, "tolerance": 3e-4},
    "bcca": {"packing": "bcca", "grains": 90, "velocity": 6, "tolerance": 1e-3},
    "bcca, unequal": {"packing": "bcca", "grains": 120, "projectileGrains": 50, "velocity": 11, "tolerance": 1e-3},
    "plane": {"planar": 1, "radius": 9, "filling": 0.65, "velocity": 4.4, "tolerance": 3e-4},
    "plane, drag": {"planar": 1, "radius": 11, "filling": 0.8, "velocity": 21, "viscoelasticTime": 4e-12, "tolerance": 1e-3},
    "bcca in a plane": {"packing": "bcca", "planar": 1, "grains": 70, "velocity": 25, "tolerance": 1e-3},
    "cut": {"radius": 6, "limit": "cut", "criticalRolling": 3e-10, "velocity": 9, "tolerance": 1e-3},
    "necks": {"radius": 6, "neck": 0.35, "velocity": 17, "tolerance": 1e-3},
    "necks, slow": {"radius": 6, "neck": 0.6, "velocity": 2.2, "tolerance": 3e-4},
    "necks in a plane": {"planar": 1, "radius": 9, "filling": 0.7, "neck": 0.55, "velocity": 38, "tolerance": 3e-3},
    "necks, bcca, cut": {"packing": "bcca", "planar": 1, "grains": 60, "neck": 0.3, "limit": "cut", "velocity": 12, "tolerance": 1e-3},
    "compression": {"grains": 70, "strainRate": 1.6e-4, "finalFilling": 0.35, "tolerance": 2e-4},
    "compression, undamped": {"grains": 90, "strainRate": 2.1e-4, "linearDamping": 0, "tolerance": 2e-4},
}  # fmt: skip


# Planes: an aggregate that meets a plate (impacts that stick, bounce and break), a layer under a piston.
PLATES = [
    {"velocity": 3.3, "radius": 5, "filling": 0.4, "tolerance": 3e-4}, {"velocity": 7.1, "radius": 4, "filling": 0.55, "tolerance": 3e-4},
    {"velocity": 0.9, "radius": 4, "filling": 0.5, "tolerance": 1e-3}, {"velocity": 19, "radius": 5, "filling": 0.35, "tolerance": 1e-3},
    {"velocity": 5.2, "radius": 5, "filling": 0.45, "viscoelasticTime": 3e-12, "tolerance": 3e-4},
    {"velocity": 2.1, "radius": 4, "filling": 0.6, "material": "silicate", "tolerance": 1e-3},
    {"velocity": 11, "radius": 5, "filling": 0.5, "material": "silicate", "tolerance": 1e-3},
    {"velocity": 34, "radius": 4, "filling": 0.4, "tolerance": 1e-3},
    {"velocity": 4.6, "packing": "bcca", "grains": 45, "tolerance": 1e-3}, {"velocity": 12, "packing": "bcca", "grains": 70, "tolerance": 1e-3},
    {"velocity": 27, "packing": "bcca", "grains": 35, "tolerance": 1e-3},
    {"velocity": 8.3, "packing": "bcca", "grains": 55, "material": "silicate", "tolerance": 3e-3},
    {"velocity": 9.4, "packing": "bpca", "grains": 60, "tolerance": 1e-3}, {"velocity": 3.7, "packing": "bpca", "grains": 40, "tolerance": 1e-3},
    {"velocity": 22, "packing": "bpca", "grains": 75, "viscoelasticTime": 2e-12, "tolerance": 1e-3},
    {"velocity": 15, "packing": "bpca", "grains": 50, "material": "silicate", "tolerance": 3e-3},
]  # fmt: skip
PISTONS = [
    {"grains": 70, "finalFilling": 0.3, "strainRate": 2.8e-4, "tolerance": 1e-3},
    {"grains": 190, "finalFilling": 0.45, "strainRate": 2.9e-4, "tolerance": 3e-4},
    {"grains": 75, "finalFilling": 0.25, "strainRate": 2.5e-4, "linearDamping": 0, "tolerance": 1e-3},
    {"grains": 110, "finalFilling": 0.35, "strainRate": 2.9e-4, "tolerance": 5e-4},
]


BATCHES = {
    "collisions": ([{"seed": 1000 + k, **dict(zip(COLUMNS, one))} for k, one in enumerate(OTHER_SCENES)], 0.999, 5, 0.05),
    "every other kind": ([{"seed": 2000, **one} for one in OTHER_KINDS.values()], 0.996, 3, 0.03),
    "planes": (
        [{"target": "wall", "seed": 3000 + k, **one} for k, one in enumerate(PLATES)]
        + [{"boundary": "walls", "seed": 4000 + k, **one} for k, one in enumerate(PISTONS)],
        *(0.997, 3, 0.03),
    ),
}  # fmt: skip


@pytest.mark.parametrize("batch", BATCHES)
def test_runs_that_are_in_no_fit_keep_to_the_tolerance(batch):
    """With 1 in 20 beyond it at most, more than 4 of 18 collisions would be a chance of 0.1 %, more than 3 of 14 others of 0.4 %, more than 4 of
    20 at planes of 0.3 %. None is far beyond it, nor are steps much shorter than they need be."""
    scenes, chance, most, median = BATCHES[batch]
    found = of_scripts([{**AUTO, **scene} for scene in scenes])
    assert not [answer["failed"] for answer in found if "failed" in answer]
    over = np.array([answer["ledger"] / scene["tolerance"] for answer, scene in zip(found, scenes, strict=True)])
    assert np.all(over > 1e-6), over  # all met
    assert np.count_nonzero(over > 1) <= binom.ppf(chance, len(over), 0.05), over
    assert over.max() < most and np.median(over) > median, over


NOT_MEASURED = [
    ({"packing": "file", "file": "any.npz"}, "packing = file"),
    ({"packing": "bpca", "sizes": "two", "sizeRatio": 2}, "sizes = two"),
    ({"strainRate": 1e-5, "finalPressure": 1e4}, "finalPressure, which may end a run at any filling"),
    ({"strainRate": 1e-5, "finalFilling": 0.6}, "finalFilling = 0.6, only 0.1 to 0.5"),
    ({"strainRate": 1e-5, "grains": 40}, "fewer than 64 grains"),
    ({"strainRate": 1e-5, "limit": "cut"}, "limit = cut in a compression"),
    ({"strainRate": 1e-5, "slidingStiffnessFactor": 2}, "slidingStiffnessFactor = 2"),
    ({"strainRate": 1e-5, "material": "silicate"}, "a rolling energy of 183 F_c delta_c, only 2.5 to 60 "),
]


@pytest.mark.parametrize("given, what", NOT_MEASURED, ids=str)
def test_what_was_not_measured_is_refused(given, what):
    kind = compression if "strainRate" in given else collision
    with refused(ParameterError, f"stepFraction = auto: not measured with {what}"):
        parameters = kind.KIND.parse({**AUTO, **given})
        kind.complete(parameters, pair_constants(parameters), 1)


def test_a_run_says_and_keeps_what_it_chose(tmp_path):
    """A row of a table that gives auto, or the step that was chosen, agrees with it, and the estimate counts the steps that will be chosen."""
    process = collide(tmp_path, *TINY, "stepFraction=auto", "tolerance=3e-4", "out=run")
    assert process.returncode == 0 and messages(process) == [], process.stderr
    about = read_json(tmp_path, "run", "run.json")
    values, derived = about["parameters"], about["derived"]
    assert 0.01 <= values["stepFraction"] <= 0.4 and values["tolerance"] == 3e-4
    assert derived["timeStep"] == values["stepFraction"] * derived["timeUnit"]
    line = next(line for line in process.stdout.splitlines() if line.startswith("step: "))
    assert line == f'step: {derived["stepChoice"]}'
    reason = f'{values["stepFraction"]:g} t0 for a ledger error of at most 0.0003 of K(0)'
    assert derived["stepChoice"].startswith(reason)
    assert values["stepFraction"] == chosen(tolerance=3e-4, radius=4, velocity=30)[0].stepFraction
    step = values["stepFraction"]
    tiny = dict(argument.split("=") for argument in TINY)
    row = parse({**tiny, **AUTO, "tolerance": 3e-4})
    assert difference(KIND, row, about) is None
    assert difference(KIND, parse({**tiny, "stepFraction": step}), about) is None
    assert difference(KIND, parse({**tiny, **AUTO}), about) == "tolerance = 0.0003, not 0.0001"
    assert difference(KIND, parse(tiny), about) == f"stepFraction = {step:g}, not 0.1"
    fixed = {**about, "parameters": {**about["parameters"], "stepFraction": 0.1, "tolerance": None}}
    assert difference(KIND, row, fixed) == "stepFraction = 0.1, not auto"
    del fixed["parameters"]["tolerance"]  # written before there was a choice
    assert difference(KIND, row, fixed) == "stepFraction = 0.1, not auto"
    assert difference(KIND, parse(tiny), fixed) is None
    same = parse({**tiny, "stepFraction": step})
    assert KIND.estimate(row) == KIND.estimate(same) != KIND.estimate(parse(tiny))
