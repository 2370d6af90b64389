"""Parameters: defaults, values, and one clear line for everything that is wrong."""

import math

import pytest

from yade_scripts import arguments, parameters
from yade_scripts.materials import MATERIALS

# Constants of a pair of ice grains, as the plugin's pairConstants names them (values from A22's formulas).
ICE_PAIR = dict(
    timeUnit=1.936e-10,
    dragPerContactRadius=0.0,
    linearDrag=0.0,
    reducedMass=2.0944e-18,
    reducedRadius=5e-8,
    equilibriumContactRadius=12.3712e-9,
    equilibriumOverlap=1.02031e-9,
    pullOffForce=47.1239e-9,
    slidingStiffness=79.176,
)


def with_drag(viscoelastic_time):
    reduced_young = 7e9 / (2 * (1 - 0.25**2))
    return dict(ICE_PAIR, dragPerContactRadius=2 * viscoelastic_time * reduced_young / 0.25**2)


def test_defaults_are_the_scene_of_the_demo():
    values = parameters.parse({})
    assert list(values) == [field.name for field in parameters.FIELDS]
    assert (values["filling"], values["radius"], values["grains"]) == (0.4, 20, 3200)
    assert values["velocity"] == 10**0.5 and values["out"] == "runs/collide-ice-f0.4-R20-v3.162-s1"
    complete = parameters.complete(values, ICE_PAIR, 1)
    assert complete["duration"] == pytest.approx(250e-9, rel=1e-3) and complete["threads"] == 1
    assert [name for name, value in complete.items() if value is None] == ["tolerance"]


@pytest.mark.parametrize(
    "name, text, value",
    [
        ("velocity", "10**0.5", 10**0.5),
        ("velocity", " 3.2e0 ", 3.2),
        ("velocity", 3, 3.0),
        ("velocity", "sqrt(2)", 2**0.5),
        ("seed", "12", 12),
        ("seed", "1e3", 1000),
        ("seed", str(2**60 + 1), 2**60 + 1),
        ("material", "'silicate'", "silicate"),
        ("material", "silicate", "silicate"),
        ("out", '"a b"', "a b"),
    ],
)
def test_values(name, text, value):
    assert parameters.parse({name: text})[name] == value


def test_grains_and_radius_give_each_other():
    by_grains = parameters.parse({"grains": "1000", "filling": "0.3"})
    assert by_grains["grains"] == 1000
    assert by_grains["radius"] == pytest.approx((1000 / 0.3) ** (1 / 3), rel=1e-14)
    assert parameters.grain_number(0.3, by_grains["radius"]) == 1000


WRONG = [
    ({"velocty": "3"}, "velocty: unknown parameter; allowed: packing, filling"),
    ({"velocity": "fast"}, "velocity = fast: not a finite number; allowed: > 0 [m/s]"),
    ({"velocity": ""}, "velocity = : not a finite number"),
    ({"velocity": "nan"}, "velocity = nan: not a finite number"),
    ({"velocity": "1e999"}, "velocity = 1e999: not a finite number"),
    ({"velocity": "1/0"}, "velocity = 1/0: not a finite number"),
    ({"velocity": "(1, 2)"}, "not a finite number"),
    ({"velocity": '__import__("os")'}, "not a finite number"),
    ({"velocity": "-1"}, "velocity = -1: not allowed; allowed: > 0 [m/s]"),
    ({"velocity": "0"}, "velocity = 0: not allowed"),
    ({"radius": "-20"}, "radius = -20: not allowed; allowed: > 0 [grain radii]"),
    ({"radius": "1"}, "radius = 1: 0 grains at filling 0.4; allowed: about 1.71"),
    ({"radius": "1e6"}, "for 2 to 5000000 grains"),
    ({"radius": "1e200"}, "radius = 1e+200: inf grains"),
    ({"grains": "1"}, "grains = 1: not allowed; allowed: 2 to"),
    ({"grains": "10.5"}, "grains = 10.5: not a whole number"),
    ({"grains": "100", "radius": "20"}, "radius and grains: both given"),
    ({"filling": "0"}, "filling = 0: not allowed"),
    ({"impact": "1.1"}, "impact = 1.1: not allowed; allowed: 0 to 1"),
    ({"viscoelasticTime": "-1e-12"}, "viscoelasticTime = -1e-12: not allowed; allowed: >= 0 [s]"),
    ({"neck": "-0.3"}, "neck = -0.3: not allowed; allowed: 0, or above that of a contact"),
    ({"planar": "2"}, "planar = 2: not allowed; allowed: 0 or 1"),
    ({"material": "iron"}, "material = iron: not allowed; allowed: ice, silicate"),
    ({"packing": "fcc"}, "packing = fcc: not allowed; allowed: cpe, bcca"),
    ({"packing": "bcca", "radius": "10"}, "radius = 10: given with packing = bcca; allowed: grains only"),
    ({"engine": "magic"}, "engine = magic: not allowed; allowed: fused, functors"),
    ({"seed": "-1"}, "seed = -1: not allowed"),
    ({"seed": "1.5"}, "seed = 1.5: not a whole number"),
    ({"duration": "0"}, "duration = 0: not allowed; allowed: > 0 [s]"),
    ({"stepFraction": "0.5"}, "stepFraction = 0.5: not allowed; allowed: > 0 and <= 0.4"),
    ({"stepFraction": "automatic"}, "stepFraction = automatic: not a finite number; allowed: > 0 and <= 0.4, less"),
    ({"velocity": "auto"}, "velocity = auto: not a finite number"),
    ({"stepFraction": "auto", "tolerance": "0.1"}, "tolerance = 0.1: not allowed; allowed: 1e-07 to 0.01"),
    ({"tolerance": "1e-5"}, "tolerance = 1e-05: given with stepFraction = 0.1; allowed: with stepFraction=auto only"),
    ({"threads": "0"}, "threads = 0: not allowed"),
    ({"overwrite": "yes"}, "overwrite = yes: not a whole number; allowed: 0 or 1"),
    ({"out": ""}, "out = : not allowed; allowed: a folder"),
]


@pytest.mark.parametrize("texts, message", WRONG, ids=[message[:40] for _, message in WRONG])
def test_wrong_parameters(texts, message):
    with pytest.raises(parameters.ParameterError) as error:
        parameters.parse(texts)
    assert message in str(error.value) and "\n" not in str(error.value) and "allowed" in str(error.value)


def test_drag_and_dense_packings_lower_the_stable_step():
    """Below the steps at which runs blew up: see step_limit."""
    assert parameters.step_limit(ICE_PAIR, 0.3) == parameters.step_limit(ICE_PAIR, 0.4) == 0.4
    assert 0.3 < parameters.step_limit(ICE_PAIR, 0.6) < 0.4
    assert 0.25 < parameters.step_limit(ICE_PAIR, 0.74) < 0.35
    limits = [parameters.step_limit(with_drag(t), 0.4) for t in (0, 1e-12, 3e-12, 6e-12, 1e-10)]
    assert limits == sorted(limits, reverse=True) and 0.1 < limits[3] < 0.25
    with pytest.raises(parameters.ParameterError, match="stepFraction = 0.3: unstable at this filling"):
        parameters.complete(parameters.parse({"stepFraction": "0.3"}), with_drag(6e-12), 1)


def test_threads_of_the_functors_are_those_of_yade():
    functors = {"engine": "functors"}
    assert parameters.complete(parameters.parse(functors), ICE_PAIR, 2)["threads"] == 2
    with pytest.raises(parameters.ParameterError, match="threads = 3: YADE was started with 1; allowed: "):
        parameters.complete(parameters.parse({"threads": "3", **functors}), ICE_PAIR, 1)


def test_threads_of_the_fused_engine_are_its_own():
    assert parameters.complete(parameters.parse({}), ICE_PAIR, 1)["threads"] == 1
    assert parameters.complete(parameters.parse({"threads": "2"}), ICE_PAIR, 1)["threads"] == 2
    with pytest.raises(
        parameters.ParameterError, match="threads = 3: more than the fused engine has domains; allowed: 1 to 2"
    ):
        parameters.complete(parameters.parse({"threads": "3"}), ICE_PAIR, 1)


def test_names_of_run_folders():
    assert parameters.parse({"impact": "0.5"})["out"].endswith("-s1-impact0.5")
    assert parameters.parse({}, "a/b c,seed=1")["out"] == "runs/a_b_c,seed=1"
    assert parameters.parse({}, "../..")["out"] == "runs/_.."
    assert parameters.parse({"out": "/tmp/x"}, "ignored")["out"] == "/tmp/x"


def test_help_names_every_parameter_once():
    lines = parameters.help_text().splitlines()[1:]
    assert [line.split()[0].rstrip(":") for line in lines] == [field.name for field in parameters.FIELDS]


@pytest.mark.parametrize("given", ["velocity", "=3", "velocity=3 velocity=4"])
def test_arguments_that_are_not_understood(given):
    with pytest.raises(parameters.ParameterError, match="allowed: "):
        arguments.from_arguments(given.split())


@pytest.mark.parametrize("name", MATERIALS)
def test_materials_are_in_si(name):
    """The time unit of K13 eq 2 with E* is the 1.93e-10 s (ice) and 1.71e-9 s (silicate) that K13 states."""
    m = MATERIALS[name]
    reduced_young = m.young / (2 * (1 - m.poisson**2))
    unit = 0.95 * (m.density**0.5 * m.grainRadius ** (7 / 6) / (reduced_young ** (1 / 3) * m.surfaceEnergy ** (1 / 6)))
    assert unit == pytest.approx({"ice": 1.93e-10, "silicate": 1.71e-9}[name], rel=0.005)
    rolling = 6 * math.pi**2 * m.surfaceEnergy * m.grainRadius * m.criticalRolling
    assert rolling == pytest.approx({"ice": 4.74e-16, "silicate": 1.42e-15}[name], rel=0.005)
