"""Parameters: defaults, values, and one clear line for everything that is wrong."""

import math
import re
import time

import pytest
from refused import refused

from analysis import theory
from analysis.runs.folder import settings
from yade_scripts import stability
from yade_scripts.experiments import collision, collision_step
from yade_scripts.experiments.collision import CollisionParameters
from yade_scripts.experiments.compression import CompressionParameters
from yade_scripts.materials import MATERIALS, pair_constants
from yade_scripts.packings import grain_number
from yade_scripts.parameters import ParameterError
from yade_scripts.run import parameters as arguments

parse = CollisionParameters.parse

ICE_PAIR = pair_constants(parse({}))


def with_drag(time):
    return pair_constants(parse({"viscoelasticTime": time}))


def complete(texts, constants=ICE_PAIR, threads=1):
    return collision_step.complete(parse(texts), constants, threads)


def test_defaults_are_the_scene_of_the_demo_and_stay():
    given = parse({})
    assert (given.filling, given.radius, given.grains) == (0.4, 20, 3200)
    assert given.velocity == 10**0.5 and given.out == "runs/collide-ice-f0.4-R20-v3.162-s1"
    found = complete({})
    missing = {name for name, value in found.as_dict().items() if value is None}
    files, sizes = {"projectileGrains", "projectileFile", "file"}, {"sizeRatio", "sizeFraction", "sizeSpread"}
    assert found.threads == 1 and missing == files | sizes | {"duration", "impactStepFraction", "tolerance"}
    with pytest.raises(AttributeError):
        parse({}).velocity = 3.0
    by_grains = parse({"grains": "1000", "filling": "0.3"})
    assert by_grains.grains == 1000
    assert by_grains.radius == pytest.approx((1000 / 0.3) ** (1 / 3), rel=1e-14)
    assert grain_number(0.3, by_grains.radius) == 1000


VALUES = [
    ("velocity", "10**0.5", 10**0.5), ("velocity", " 3.2e0 ", 3.2), ("velocity", 3, 3.0),
    ("seed", "12", 12), ("seed", "1e3", 1000), ("seed", str(2**60 + 1), 2**60 + 1),
    ("material", "'silicate'", "silicate"), ("material", "silicate", "silicate"), ("out", '"a b"', "a b"),
]  # fmt: skip


@pytest.mark.parametrize("name, text, value", VALUES)
def test_values(name, text, value):
    found = getattr(parse({name: text}), name)
    assert found == value and type(found) is type(value)


def test_no_packing_is_made_while_parsing():
    """200 rows of BCCA aggregates, which take minutes to make."""
    collision.estimate(parse({}))  # what is imported at first
    start = time.process_time()
    rows = [parse({"packing": "bcca", "grains": 50_000, "seed": seed}) for seed in range(200)]
    estimates = [collision.estimate(row) for row in rows]
    assert time.process_time() - start < 1
    assert {row.radius for row in rows} == {row.filling for row in rows} == {None}
    assert estimates[0].grains == estimates[0].contacts == 100_000 and estimates[0].steps > 1e5


def test_properties_of_a_material_are_columns_of_their_own():
    found = parse({"material": "silicate", "grainRadius": "0.1e-6", "surfaceEnergy": 0.05})
    silicate = MATERIALS["silicate"]
    assert (found.grainRadius, found.surfaceEnergy) == (1e-7, 0.05)
    for name in ("young", "poisson", "density", "criticalRolling"):
        assert getattr(found, name) == getattr(silicate, name)
    assert found.out.endswith("-grainRadius1e-07-surfaceEnergy0.05")
    as_ice = {name: getattr(MATERIALS["ice"], name) for name in vars(MATERIALS["ice"])}
    assert pair_constants(parse({"material": "silicate", **as_ice})) == pair_constants(parse({}))
    small, large = (pair_constants(parse({"grainRadius": radius}))["pullOffForce"] for radius in (1e-7, 2e-7))
    assert large == pytest.approx(2 * small, rel=1e-14)


# Arguments of the command line, as one gives them: what the refusal says.
WRONG = {
    "velocty=3": "velocty: unknown parameter (did you mean velocity?); must be one",
    "velocity=fast": "velocity = fast: not a finite number; must be > 0 [m/s]",
    "velocity=9**9**9**9": "velocity = 9**9**9**9: an exponent above 1000; must be > 0 [m/s]",
    "velocity=" + "1" * 300: "velocity = " + 60 * "1" + "...: longer than 200 characters",
    "velocity=-1": "velocity = -1: must be > 0 [m/s]",
    "velocity=3000": "velocity = 3000 m/s: must be 1e-06 to 1000 m/s (thermal motion of aggregates to ",
    "velocity=auto": "velocity = auto: not a finite number",
    "radius=-20": "radius = -20: must be > 0 [grain radii]",
    "radius=1": "radius = 1: 0 grains at filling 0.4; must be about 1.71",
    "radius=1e6": "for 2 to 5000000 grains",
    "radius=1e200": "radius = 1e+200: inf grains",
    "grains=1": "grains = 1: must be 2 to 5000000",
    "grains=10.5": "grains = 10.5: not a whole number; must be 2 to",
    "grains=100 radius=20": "radius and grains: both given; must be one",
    "filling=0": "filling = 0: must be > 0",
    "impact=1.1": "impact = 1.1: must be 0 to 1",
    "viscoelasticTime=-1e-12": "viscoelasticTime = -1e-12: must be >= 0 [s]",
    "poisson=0.6": "poisson = 0.6: must be 0 to 0.5",
    "poisson=0 viscoelasticTime=1e-12": "poisson = 0: with viscous drag must be > 0",
    "grainRadius=0": "grainRadius = 0: must be > 0 [m]",
    "young=-7e9": "young = -7e9: must be > 0 [Pa]",
    "density=0": "density = 0: must be > 0 [kg/m^3]",
    "surfaceEnergy=0": "surfaceEnergy = 0: must be > 0 [J/m^2]",
    "criticalRolling=0": "criticalRolling = 0: must be > 0 [m]",
    "neck=-0.3": "neck = -0.3: must be 0, or above that of a contact",
    "neck=0.8": "neck = 0.8: must be 0, or above that of a contact that is not sintered",
    "neck=0.5 initialOverlap=0.5": "initialOverlap = 0.5: given with neck = 0.5; must be 1",
    "initialOverlap=0": "initialOverlap = 0: must be > 0 and at most 1 [of that at rest]",
    "planar=2": "planar = 2: must be 0 or 1",
    "limit=slack": "limit = slack: must be held or cut",
    "material=iron": "material = iron: must be ice or silicate",
    "engine=magic": "engine = magic: must be fused or functors",
    "seed=-1": "seed = -1: must be >= 0",
    "seed=1.5": "seed = 1.5: not a whole number",
    "duration=0": "duration = 0: must be > 0 [s]",
    "stepFraction=0.5": "stepFraction = 0.5: must be > 0 and <= 0.4",
    "stepFraction=automatic": "stepFraction = automatic: not a finite number; must be > 0 and <= 0.4, less",
    "stepFraction=auto tolerance=0.1": "tolerance = 0.1: must be 1e-07 to 0.01",
    "tolerance=1e-5": "tolerance = 1e-05: given with stepFraction = 0.1; must be left out",
    "impactStepFraction=0": "impactStepFraction = 0: must be > 0 [t0]",
    "impactStepFraction=0.1": "given with stepFraction = 0.1; must be below it",
    "impactStepFraction=1e-9": "must be below it and at least a hundredth of it",
    "impactStepFraction=0.1 stepFraction=auto": "given with stepFraction = auto; must be left out",
    "impactStepFraction=0.01 engine=functors": "given with engine = functors; must be left out",
    "threads=0": "threads = 0: must be >= 1",
    "overwrite=yes": "overwrite = yes: not a finite number; must be 0 or 1",
    "out=": "out = : must be a folder",
    "packing=fcc": "packing = fcc: must be cpe or bcca",
    "packing=bcca radius=10": "radius = 10: given with packing = bcca; must be grains only",
    "packing=bcca filling=0.3": "filling = 0.3: given with packing = bcca; must be grains only",
    "packing=bcca grains=1e6": "grains = 1000000: too many for packing = bcca; must be 2 to 100000",
    "packing=bcca projectileGrains=200_000": "projectileGrains = 200000: too many for packing = bcca",
    "packing=bcca initialOverlap=0.5": "initialOverlap = 0.5: given with packing = bcca, on which it has no",
    "packing=bpca removeLooseGrains=1": "removeLooseGrains = 1: given with packing = bpca, on which it has no",
    "packing=bpca grains=3_000_000": "grains = 3000000: too many for packing = bpca; must be 2 to 2000000",
    "packing=bpca planar=1": "planar = 1: given with packing = bpca, which is made in space; must be 0",
    "target=wall neck=0.5": "neck = 0.5: given with target = wall; must be left out: there are no sintered bonds to plates",
    "target=wall impact=0.5": "impact = 0.5: given with target = wall; must be left out: it meets the plate at right angles",
    "target=wall projectileGrains=9 packing=bcca": "projectileGrains = 9: given with target = wall; must be left out",
    "packing=bpca projectileFile=a": "projectileFile = a: given with packing = bpca",
    "projectileGrains=9": "projectileGrains = 9: given with packing = cpe",
    "file=a": "file = a: given with packing = cpe; must be left out",
    "packing=file": "file: not given with packing = file",
    "packing=file file=a grains=5": "grains = 5: given with packing = file, on which it has no effect",
    "packing=file file=a seed=2": "seed = 2: given with packing = file",
    "packing=file file=a projectileGrains=9": "projectileGrains = 9: given with packing = file",
    "sizes=two sizeRatio=2": "sizes = two: given with packing = cpe; must be equal",
    "packing=bpca sizes=two": "sizeRatio: not given with sizes = two; must be 0.1 to 10",
    "packing=bpca sizes=lognormal": "sizeSpread: not given with sizes = lognormal; must be > 0",
    "packing=bpca sizeSpread=0.1": "sizeSpread = 0.1: given with sizes = equal; must be left out",
    "packing=bcca sizes=two sizeRatio=2 neck=0.5": "sizes = two: given with neck = 0.5; must be equal",
    # not understood as arguments
    "velocity": "argument 'velocity': not understood; must be name=value",
    "=3": "not understood; must be name=value",
    "velocity=3 velocity=4": "velocity: given twice; must be given once",
}  # fmt: skip


@pytest.mark.parametrize("given", WRONG, ids=lambda given: given[:40])
def test_wrong_parameters(given):
    with refused(ParameterError, WRONG[given], "must be"):
        parse(arguments.from_arguments(given.split()))


def test_values_of_another_type_are_no_numbers():
    for value in (float("nan"), None, True):
        with pytest.raises(ParameterError, match=f"velocity = {value}: not a finite number"):
            parse({"velocity": value})


def test_drag_and_dense_packings_lower_the_stable_step():
    """Below the steps at which runs blew up: see step_limit."""
    assert stability.step_limit(ICE_PAIR, 0.3) == stability.step_limit(ICE_PAIR, 0.4) == 0.4
    assert 0.3 < stability.step_limit(ICE_PAIR, 0.6) < 0.4
    assert 0.25 < stability.step_limit(ICE_PAIR, 0.74) < 0.35
    limits = [stability.step_limit(with_drag(t), 0.4) for t in (0, 1e-12, 3e-12, 6e-12, 1e-10)]
    assert limits == sorted(limits, reverse=True) and 0.1 < limits[3] < 0.25
    with pytest.raises(ParameterError, match="stepFraction = 0.3: unstable at this filling"):
        complete({"stepFraction": "0.3"}, with_drag(6e-12))


def test_runs_without_an_end_are_refused():
    for texts in ({"duration": "1e10"}, {"duration": 1e-9, "stepFraction": 1e-300}, {"duration": 1e300}):
        with refused(ParameterError, "duration = ", " t0; must be at most 1e+09 steps, ", " s with"):
            complete(texts)
    with pytest.raises(ParameterError, match=r"duration = .* must be at most 1e\+09 steps"):
        collision.with_duration(complete({"stepFraction": 1e-12}), ICE_PAIR["timeUnit"], 0.0)
    longest = 1e9 * 0.1 * ICE_PAIR["timeUnit"]
    assert complete({"duration": 0.999 * longest}).duration == 0.999 * longest


def test_the_default_duration_is_that_of_the_paper_and_a_given_one_stays():
    """Counted from the first touch: test_collide.py."""
    given = complete({"radius": 30})
    found = collision.with_duration(given, ICE_PAIR["timeUnit"], 5e-8).duration
    assert found - 5e-8 == pytest.approx(12.5e-9 * 30, rel=1e-3)
    assert collision.with_duration(given.changed(duration=1e-9), ICE_PAIR["timeUnit"], None).duration == 1e-9


def test_threads_of_the_functors_are_those_of_yade_and_of_the_engine_its_own():
    functors = {"engine": "functors"}
    assert complete(functors, threads=2).threads == 2
    with pytest.raises(ParameterError, match="threads = 3: YADE was started with 1; must be "):
        complete({"threads": "3", **functors})
    assert complete({"threads": "2"}).threads == 2
    with pytest.raises(ParameterError, match="threads = 99999: more than this machine has cores; must be 1 to "):
        complete({"threads": "99999"})


def test_names_of_run_folders():
    assert parse({"impact": "0.5"}).out.endswith("-s1-impact0.5")
    assert parse({"threads": 2, "resume": 1}).out == parse({}).out
    assert parse({"packing": "bcca", "neck": 0.3}).out == "runs/collide-ice-bcca-N1024-v3.162-s1-neck0.3"
    assert parse({}, "a/b c,seed=1").out == "runs/a_b_c,seed=1"
    assert parse({}, "../..").out == "runs/_.."
    assert parse({"out": "/tmp/x"}, "ignored").out == "/tmp/x"


@pytest.mark.parametrize("parameters", [CollisionParameters, CompressionParameters])
def test_help_names_every_parameter_once_with_its_unit(parameters):
    text = parameters.help_text()
    assert sorted(re.findall(r"^  (\w+)", text, re.M)) == sorted(parameters.columns())
    assert max(map(len, text.splitlines())) <= 100
    words = "\n  velocity = 3.16228 [m/s]\n      relative velocity of the aggregates; must be > 0\n"
    assert parameters is not CollisionParameters or words in text


@pytest.mark.parametrize("name", MATERIALS)
def test_help_and_summary_tell_what_grains_a_material_has(name):
    """Those of silicate are six times as large."""
    radius = {"ice": "1e-07", "silicate": "6e-07"}[name]
    assert f"{name}: grainRadius {radius}, young" in " ".join(CollisionParameters.help_text().split())
    assert f"material {name}, grainRadius {radius} m" in settings(parse({"material": name}).as_dict())


@pytest.mark.parametrize("name", MATERIALS)
def test_materials_are_in_si(name):
    """The time unit of K13 eq 2 with E* is the 1.93e-10 s (ice) and 1.71e-9 s (silicate) that K13 states."""
    m = MATERIALS[name]
    reduced_young = m.young / (2 * (1 - m.poisson**2))
    unit = 0.95 * (m.density**0.5 * m.grainRadius ** (7 / 6) / (reduced_young ** (1 / 3) * m.surfaceEnergy ** (1 / 6)))
    assert unit == pytest.approx({"ice": 1.93e-10, "silicate": 1.71e-9}[name], rel=0.005)
    rolling = 6 * math.pi**2 * m.surfaceEnergy * m.grainRadius * m.criticalRolling
    assert rolling == pytest.approx({"ice": 4.74e-16, "silicate": 1.42e-15}[name], rel=0.005)
    assert theory.GRAIN_RADIUS[name] == m.grainRadius  # analysis.outcome() asks of the grains that collide() runs
