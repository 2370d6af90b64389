"""Parameters: defaults, values, arithmetic, and one clear line for what is wrong."""

import math
import re
import time

import pytest
from refused import refused

from yade_scripts import time_step
from yade_scripts.experiments import collision
from yade_scripts.experiments.collision import CollisionParameters
from yade_scripts.materials import MATERIALS, pair_constants
from yade_scripts.packings import grain_number
from yade_scripts.parameters import NotANumber, ParameterError, evaluate
from yade_scripts.run import parameters as arguments

parse = CollisionParameters.parse

ICE_PAIR = pair_constants(parse({}))


def with_drag(time):
    return pair_constants(parse({"viscoelasticTime": time}))


def complete(texts, constants=ICE_PAIR, threads=1):
    return collision.complete(parse(texts), constants, threads)


def test_defaults_are_the_scene_of_the_demo_and_stay():
    given = parse({})
    assert (given.filling, given.radius, given.grains) == (0.4, 20, 3200)
    assert given.velocity == 10**0.5 and given.out == "runs/collide-ice-f0.4-R20-v3.16227766-s1"
    by_grains = parse({"grains": "1000", "filling": "0.3"})
    assert by_grains.grains == 1000
    assert by_grains.radius == pytest.approx((1000 / 0.3) ** (1 / 3), rel=1e-14)
    assert grain_number(0.3, by_grains.radius) == 1000


@pytest.mark.parametrize(
    "name, text, value",
    [
        ("velocity", 3, 3.0),
        ("seed", "1e3", 1000),
        ("seed", str(2**60 + 1), 2**60 + 1),
        ("material", "'silicate'", "silicate"),
    ],
)
def test_values_have_their_type(name, text, value):
    found = getattr(parse({name: text}), name)
    assert found == value and type(found) is type(value)


def test_numbers_may_be_written_as_arithmetic():
    for text, value in {
        "1_000": 1000,
        "-2**2": -4,
        "10**(0.1*5)": 10**0.5,
        "2*pi*sqrt(2)/exp(1) - 5": 2 * math.pi * math.sqrt(2) / math.e - 5,
    }.items():
        assert evaluate(text) == value and type(evaluate(text)) is type(value)


def test_nothing_but_arithmetic_is_evaluated_and_nothing_that_takes_long():
    start = time.process_time()
    texts = "pi.__class__; lambda: 1; 'a' * 9; x; sqrt(4, 2); True; 1j; 1 +; 1/0; nan; exp(1000); 9**9**9**9"
    for text in [*texts.split("; "), "", '__import__("os")']:
        with pytest.raises(NotANumber):
            evaluate(text)
    assert time.process_time() - start < 1


def test_properties_of_a_material_are_columns_of_their_own():
    found = parse({"material": "silicate", "grainRadius": "0.1e-6", "surfaceEnergy": 0.05})
    silicate = MATERIALS["silicate"]
    assert (found.grainRadius, found.surfaceEnergy) == (1e-7, 0.05)
    for name in ("young", "poisson", "density", "criticalRolling"):
        assert getattr(found, name) == getattr(silicate, name)
    assert found.out.endswith("-grainRadius1e-07-surfaceEnergy0.05")


# Arguments of the command line: the beginning of the refusal.
WRONG = {
    "velocty=3": "velocty: unknown parameter (did you mean velocity?)",
    "velocity=fast": "velocity = fast: not a finite number; must be > 0 [m/s]",
    "velocity=3000": "velocity = 3000 m/s: must be 1e-06 to 1000 m/s",
    "grains=10.5": "grains = 10.5: not a whole number",
    "grains=100 radius=20": "radius and grains: both given",
    "material=ice,ice materialFraction=0.3": "material = ice,ice: must be a material, or two unlike ones",
    "surfaceEnergy=0": "surfaceEnergy = 0: must be > 0 (all limits of this law follow from adhesion",
    "material=iron": "material = iron: no such material; must be one of ice, silicate",
    "material=quartz materials=none.toml": "materials = none.toml",
    "material=ice,silicate packing=bcca": "materialFraction: not given with two materials",
    "material=ice,silicate packing=bcca materialFraction=0.3 young=1e9": "young = 1e+09: given with two materials",
    "material=ice,silicate materialFraction=0.3": "packing = cpe: a lattice of two materials cannot be at rest",
    "layout=halves": "layout = halves: given with one material",
    "packing=bcca grains=1e6": "grains = 1000000: too many for packing = bcca",
    "target=wall neck=0.5": "neck = 0.5: given with target = wall",
    "material=ice,silicate packing=bcca neck=0.5": "material = ice,silicate: given with neck = 0.5",
    "packing=file": "file: not given with packing = file",
    "velocity=3 velocity=4": "velocity: given twice",
}


@pytest.mark.parametrize("given", WRONG)
def test_wrong_parameters(given):
    with refused(ParameterError, WRONG[given], "must be"):
        parse(arguments.from_arguments(given.split()))


def test_drag_and_dense_packings_lower_the_stable_step():
    """Below the steps at which runs blew up: see step_limit."""
    assert time_step.step_limit(ICE_PAIR, 0.3) == time_step.step_limit(ICE_PAIR, 0.4) == 0.4
    assert 0.3 < time_step.step_limit(ICE_PAIR, 0.6) < 0.4
    assert 0.25 < time_step.step_limit(ICE_PAIR, 0.74) < 0.35
    limits = [time_step.step_limit(with_drag(t), 0.4) for t in (0, 1e-12, 3e-12, 6e-12, 1e-10)]
    assert limits == sorted(limits, reverse=True) and 0.1 < limits[3] < 0.25
    with pytest.raises(ParameterError, match="stepFraction = 0.3: unstable at this filling"):
        complete({"stepFraction": "0.3"}, with_drag(6e-12))


def test_names_of_run_folders():
    assert parse({"impact": "0.5"}).out.endswith("-s1-impact0.5")
    assert parse({"threads": 2, "resume": 1}).out == parse({}).out
    assert parse({"packing": "bcca", "neck": 0.3}).out == "runs/collide-ice-bcca-N1024-v3.16227766-s1-neck0.3"
    assert parse({}, "a/b c,seed=1").out == "runs/a_b_c,seed=1"
    assert parse({}, "../..").out == "runs/_.."
    assert parse({"out": "/tmp/x"}, "ignored").out == "/tmp/x"


def test_help_names_every_parameter_once_with_its_unit():
    text = CollisionParameters.help_text()
    assert sorted(re.findall(r"^  (\w+)", text, re.M)) == sorted(CollisionParameters.columns())
    assert "\n  velocity = 3.16228 [m/s]\n" in text
