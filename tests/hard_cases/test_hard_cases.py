"""Scenes that break careless codes, each with what must happen. Both ways of moving grains where that is quick."""

import pytest

BOTH = pytest.mark.parametrize("mover", ["fused", "functors"])

SCENE = """
from scenes import *
unit = constants(ice(), 1e-7)["timeUnit"]
def start(step, sub_steps=1):
    new_scene(step * unit)
    if parameters["mover"] == "fused":
        fused_engine(subSteps=sub_steps)
        O.dt *= sub_steps
def watch(steps, every):
    'Largest change of the energy sum, over the first kinetic energy.'
    global sums
    sums = []
    O.engines += [PyRunner(command="sums.append((total_energy(), energies()['kinetic']))", iterPeriod=every)]
    O.run(steps, True)
    e, k = np.array(sums).T
    return float(np.abs(e - e[0]).max() / k[0])
"""


@BOTH
def test_impact_at_100_metres_a_second(yade, mover):
    """Two clusters of 32 grains: overlaps of many delta0, slips of many limits in one step. The ledger closes, and better at a smaller step."""
    found = yade(
        SCENE
        + """
def impact(step):
    start(step)
    random = np.random.default_rng(2)
    for side in (-1, 1):
        for k in range(32):
            site = np.array([k % 4, k // 4 % 4, k // 16]) * 2.01e-7 + 1e-9 * random.normal(size=3)
            grain(site + np.array([side * 4.6e-7 - 3e-7, 0, 0]), 1e-7, ice(), (-side * 50, 0, 0))
    return watch(int(40 / step), 1)
result["closure"] = [impact(step) for step in (0.05, 0.0125)]
""",
        {"mover": mover},
    )
    assert found["closure"][0] < 2e-2 and found["closure"][1] < found["closure"][0] / 3, found


@BOTH
def test_grains_overlapping_far_beyond_contact_fly_apart_and_energy_stays(yade, mover):
    found = yade(
        SCENE
        + """
start(0.005)
grain((0, 0, 0), 1e-7, ice())
grain((1.5e-7, 0, 0), 1e-7, ice())
grain((0, 1.6e-7, 0), 1e-7, ice())
O.run(1, True)
first = total_energy()
O.run(2000, True)
result.update(first=first, last=total_energy(), kinetic=energies()["kinetic"], contacts=[O.energy["disconnection"]])
""",
        {"mover": mover},
    )
    assert found["kinetic"] > 0.5 * found["first"] > 0
    assert found["last"] == pytest.approx(found["first"], rel=1e-3)


def test_coincident_centres_stop_the_engine_and_name_the_body(yade):
    found = yade(
        SCENE
        + """
start(0.1)
grain((0, 0, 0), 1e-7, ice())
grain((5e-7, 0, 0), 1e-7, ice())
grain((5e-7, 0, 0), 1e-7, ice())
result["message"] = refusal(steps=10)
result["positions"] = positions()
""",
        {"mover": "fused"},
    )
    assert "body 1" in found["message"] and "\\n" not in found["message"]
    assert found["positions"] == [[0, 0, 0], [5e-7, 0, 0], [5e-7, 0, 0]]  # the last good state


@BOTH
def test_size_ratio_ten(yade, mover):
    """Dust of 0.1 um settling on a grain of 1 um with some speed: sticks, and the ledger closes."""
    found = yade(
        SCENE
        + """
start(0.05)
big = grain((0, 0, 0), 1e-6, ice())
random = np.random.default_rng(4)
for k in range(12):
    n = random.normal(size=3); n /= np.linalg.norm(n)
    grain(1.103e-6 * n, 1e-7, ice(), -2 * n + 0.5 * random.normal(size=3), 1e7 * random.normal(size=3))
result["closure"] = watch(4000, 40)
result["lost"] = energies()
""",
        {"mover": mover},
    )
    assert found["lost"]["connection"] > 0 and found["closure"] < 2e-3, found


def test_a_million_steps_at_rest(yade):
    """A cluster at equilibrium, given a slow rigid rotation and drift: energy and angular momentum after a million steps are those of the start."""
    found = yade(
        SCENE
        + """
start(0.1, 1000)
from yade_scripts import packings
c = constants(ice(), 1e-7)
packing = packings.cpe(0.4, 4e-7, 1e-7, c["equilibriumOverlap"], 1, 0)
w = np.array([1e4, 2e4, -1e4])
for x in packing.position:
    grain(x, 1e-7, ice(), np.cross(w, x) + np.array([0.01, 0, 0]), w)
O.run(1, True)
p0, l0 = momenta()
e0, first = total_energy(), energies()
O.run(1000, True)
p1, l1 = momenta()
result.update(dp=np.linalg.norm(p1 - p0) / np.linalg.norm(p0), dl=np.linalg.norm(l1 - l0) / np.linalg.norm(l0), de=abs(total_energy() - e0) / first["kinetic"], steps=O.iter,
              lost=sum(energies()[name] for name in LOST), unit=c["pullOffForce"] * c["pullOffOverlap"])
""",
        {"mover": "fused"},
    )
    assert found["dp"] < 1e-10 and found["dl"] < 1e-8 and found["de"] < 1e-4, found
    assert found["lost"] < 1e-6 * found["unit"], found


@BOTH
def test_fast_spin(yade, mover):
    """Grains that turn by a tenth of a radian in a step, meeting: pointers stay unit vectors in their grains, and the ledger closes to a percent."""
    found = yade(
        SCENE
        + """
start(0.02)
grain((0, 0, 0), 1e-7, ice(), (1, 0, 0), (0, 0, 5e9))
grain((2.005e-7, 0, 0), 1e-7, ice(), (-1, 0, 0), (0, 3e9, 0))
result["closure"] = watch(4000, 10)
result["turn"] = 5e9 * 0.02 * unit
""",
        {"mover": mover},
    )
    assert found["closure"] < 1e-2, found


@BOTH
def test_contacts_flickering_at_pull_off(yade, mover):
    """A chain pulled apart again and again by its grains' vibration: many contacts form and break, all of them in the ledger."""
    found = yade(
        SCENE
        + """
start(0.05)
random = np.random.default_rng(7)
c = constants(ice(), 1e-7)
for k in range(20):
    grain((k * (2e-7 + 0.5 * c["pullOffOverlap"]), 0, 0), 1e-7, ice(), (random.uniform(-8, 8), 0, 0))
result["closure"] = watch(8000, 20)
result["lost"] = energies()
result["unit"] = c["pullOffForce"] * c["pullOffOverlap"]
""",
        {"mover": mover},
    )
    assert found["lost"]["disconnection"] > 10 * 4 / 45 * found["unit"], found
    assert found["closure"] < 2e-3, found


@pytest.mark.parametrize("step,viscoelastic", [(0.6, 0.0), (0.1, 100e-12), (0.0, 0.0)])
def test_a_step_above_the_limit_is_refused_with_the_limit(yade, step, viscoelastic):
    found = yade(
        SCENE
        + """
start(parameters["step"])
for x in (0, 2.1e-7):
    grain((x, 0, 0), 1e-7, ice(viscoelasticTime=parameters["T"]))
result["message"] = refusal()
""",
        {"mover": "fused", "step": step, "T": viscoelastic},
    )
    assert "small step" in found["message"] and "below" in found["message"] and "\n" not in found["message"]


def test_strong_drag_below_the_named_limit_is_stable(yade):
    """T_vis = 100 ps at 0.9 of the step that the refusal names: a pair meets, sticks and comes to rest."""
    found = yade(
        SCENE
        + """
start(1.0)
for x, v in ((0, 0), (2.005e-7, -5)):
    grain((x, 0, 0), 1e-7, ice(viscoelasticTime=100e-12), (v, 0, 0))
limit = float(refusal().split("below ")[1].split(" s")[0])
O.engines = [JKRWadaEngine()]
O.dt = 0.9 * limit
result["closure"] = watch(3000, 1)
a, b = O.bodies[0].state, O.bodies[1].state
result.update(speed=abs(b.vel[0] - a.vel[0]), overlap=2e-7 - b.pos[0] + a.pos[0], drag=O.energy["drag"], delta0=constants(ice(), 1e-7)["equilibriumOverlap"])
""",
        {"mover": "fused"},
    )
    assert found["speed"] < 0.1 and found["drag"] > 0 and 0 < found["overlap"] < 2 * found["delta0"], found
