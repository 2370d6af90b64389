"""Two grains in YADE against closed forms and an independent integration: error and order of convergence."""

import numpy as np
import pytest

from analysis.theory import ICE, Material, collide_pair, pair_constants, sticking_velocity

HEAD_ON = """
from scenes import *
def rebound(speed, step, gap, material, radius2=1e-7, other=None):
    'Speed of separation after a head-on collision, 0 when the grains stick.'
    c = constants(material, 1e-7, other or material, radius2)
    new_scene(step * c["timeUnit"])
    grain((0, 0, 0), 1e-7, material)
    grain((1e-7 + radius2 + gap, 0, 0), radius2, other or material, (-speed, 0, 0))
    O.engines += [PyRunner(command="stop_when_apart(%r)" % (2 * gap / speed), iterPeriod=int(1 / step))]
    O.run(int(200 / step), True)
    apart = O.interactions.countReal() == 0
    return O.bodies[1].state.vel[0] - O.bodies[0].state.vel[0] if apart else 0.0
def stop_when_apart(after):
    if O.time > after and O.interactions.countReal() == 0: O.pause()
def sticking(step, material, low, high, tolerance, gap=2e-9):
    while high - low > tolerance * low:
        middle = 0.5 * (low + high)
        if rebound(middle, step, gap, material) > 0: high = middle
        else: low = middle
    return 0.5 * (low + high)
"""


def test_sticking_velocity_without_drag(yade):
    """[2 (8/15 2^(2/3) + 4/45) F_c delta_c/m*]^(1/2) (A22 eqs 9, 10), 5.95 m/s for ice of 0.1 um."""
    found = yade(HEAD_ON + "result['v'] = sticking(0.02, ice(), 5.5, 6.5, 2e-4)\nresult['c'] = constants(ice(), 1e-7)")
    c = found["c"]
    energy = (8 / 15 * 2 ** (2 / 3) + 4 / 45) * c["pullOffForce"] * c["pullOffOverlap"]
    closed = np.sqrt(2 * energy / c["reducedMass"])
    assert closed == pytest.approx(5.95, abs=0.005)
    assert found["v"] == pytest.approx(closed, rel=1e-3)


@pytest.mark.parametrize("picoseconds", [1, 3, 6])
def test_sticking_velocity_with_drag(yade, picoseconds):
    """A22 eq 30, integrated independently to 1e-10 (analysis.theory)."""
    material = Material(**{**ICE.__dict__, "viscoelastic_time": picoseconds * 1e-12})
    independent = sticking_velocity(pair_constants(material, 1e-7))
    found = yade(
        HEAD_ON
        + "m = ice(viscoelasticTime=parameters['T'])\nresult['v'] = sticking(0.005, m, *parameters['range'], 2e-4)",
        {"T": picoseconds * 1e-12, "range": [0.9 * independent, 1.1 * independent]},
    )
    assert found["v"] == pytest.approx(independent, rel=1e-3)


@pytest.mark.parametrize("kind", ["elastic", "viscous", "unlike"])
def test_rebound_converges_with_second_order(yade, kind):
    """Rebound speed against a closed form (elastic) or an independent integration. Contacts form and break anywhere within a step, so the error at
    one step scatters: root mean square over twelve gaps. Events that are not located in time would give first order (ratio 2)."""
    speed = {"elastic": 9.0, "viscous": 40.0, "unlike": 9.0}[kind]
    material = {"elastic": "ice()", "viscous": "ice(viscoelasticTime=2e-12)", "unlike": "ice()"}[kind]
    other = "soft(), radius2=1.7e-7, other=soft()" if kind == "unlike" else ""
    call = f"rebound({speed}, step, gap, " + ("ice(), other=soft(), radius2=1.7e-7" if other else material) + ")"
    found = yade(
        HEAD_ON
        + f"""
for step in (0.1, 0.05, 0.025, 0.0125):
    result[step] = [{call} for gap in 2e-9 + 1e-10 * np.arange(12) / 1.7]
"""
    )
    if kind == "unlike":
        soft = Material(3e9, 0.33, 1300.0, 0.05, 1.1e-9)
        pair = pair_constants(ICE, 1e-7, soft, 1.7e-7)
    else:
        pair = pair_constants(
            Material(**{**ICE.__dict__, "viscoelastic_time": 2e-12 if kind == "viscous" else 0.0}), 1e-7
        )
    exact = collide_pair(speed, pair).rebound_velocity
    errors = [np.sqrt(np.mean((np.array(v) / exact - 1) ** 2)) for v in found.values()]
    assert errors[0] < 1e-2 and errors[-1] < 2e-4, errors
    assert errors[0] / errors[-1] > 3.2**3, errors  # second order gives 64, first order 8


DRIVEN = """
from scenes import *
def driven(mode, times_limit, step, radius2, material, other):
    'Turn two blocked grains at equilibrium; returns the channels, constants and displacement reached.'
    c = constants(material, 1e-7, other, radius2)
    new_scene(step * c["timeUnit"])
    r1, r2, R = 1e-7, radius2, c["reducedRadius"]
    limit = dict(sliding=c["criticalSliding"], rolling=c["criticalRolling"], twisting=c["criticalTwisting"])[mode]
    steps = int(round(400 * times_limit * 0.1 / step))
    rate = times_limit * limit / (steps * O.dt)
    spin = dict(sliding=((0, 0, rate / (r1 + r2)), (0, 0, rate / (r1 + r2))),
                rolling=((0, 0, rate / r1), (0, 0, -rate / r2)),
                twisting=((rate, 0, 0), (0, 0, 0)))[mode]
    grain((0, 0, 0), r1, material, spin=spin[0], blocked="xyzXYZ")
    grain((r1 + r2 - c["equilibriumOverlap"], 0, 0), r2, other, spin=spin[1], blocked="xyzXYZ")
    O.run(steps + 1, True)
    i = O.interactions[0, 1]
    f1, f2, t1, t2 = O.forces.f(0), O.forces.f(1), O.forces.t(0), O.forces.t(1)
    return dict(energies=energies(), constants=c, limit=limit, zeta=list(i.phys.slidingDisplacement), xi=list(i.phys.rollingDisplacement), twist=i.phys.twist,
                f1=list(f1), f2=list(f2), t1=list(t1), t2=list(t2))
"""


@pytest.mark.parametrize("mode", ["sliding", "rolling", "twisting"])
@pytest.mark.parametrize("radius2", [1e-7, 2.5e-7])
def test_driven_past_the_limit(yade, mode, radius2):
    """A displacement driven to 8 times its limit: force at the limit, stored k/2 crit^2, dissipated k crit (total - crit) (A22 eqs 13-26), and the
    other two modes untouched. The pointers' finite angles (up to 8 crit/r, 6 %) enter in second order, less for smaller grains' limits."""
    found = yade(
        DRIVEN + "m = ice()\nresult.update(driven(parameters['mode'], 8, 0.1, parameters['radius2'], m, m))",
        {"mode": mode, "radius2": radius2},
    )
    c, limit, e = found["constants"], found["limit"], found["energies"]
    stiffness = {
        "sliding": c["slidingStiffness"],
        "rolling": c["rollingStiffness"],
        "twisting": c["twistingStiffness"],
    }[mode]
    assert e[mode] == pytest.approx(stiffness / 2 * limit**2, rel=1e-3)
    assert e[mode + "Dissipation"] == pytest.approx(stiffness * limit * 7 * limit, rel=2e-3)
    for other in {"sliding", "rolling", "twisting"} - {mode}:
        assert abs(e[other]) + abs(e[other + "Dissipation"]) < 2e-3 * e[mode + "Dissipation"], other
    if mode == "sliding":
        assert np.linalg.norm(found["f1"][1:]) == pytest.approx(stiffness * limit, rel=1e-2)
    if mode == "rolling":
        assert np.linalg.norm(found["t1"]) == pytest.approx(stiffness * limit * c["reducedRadius"], rel=2e-2)
    if mode == "twisting":
        assert abs(found["t1"][0]) == pytest.approx(stiffness * limit, rel=1e-12)
    assert np.allclose(found["f1"], -np.array(found["f2"]), rtol=0, atol=1e-12 * np.linalg.norm(found["f1"]) + 1e-22)


def test_linear_damping_of_k13(yade):
    """A pair at equilibrium with k_n = 0.02 rings at the slope 6 F_c/(5 delta0) (A24 eq 38) and decays as exp(-k_n m0 t/(2 m* t0))."""
    found = yade("""
from scenes import *
m = ice()
c = constants(m, 1e-7)
new_scene(0.02 * c["timeUnit"], damping=0.02)
d = 2e-7 - c["equilibriumOverlap"]
small = 1e-3 * c["equilibriumOverlap"]
grain((0, 0, 0), 1e-7, m)
grain((d + small, 0, 0), 1e-7, m)
result["c"], series = c, []
for _ in range(3000):
    O.step()
    series.append([O.time, O.bodies[1].state.pos[0] - O.bodies[0].state.pos[0] - d])
result["series"] = series
""")
    c = found["c"]
    time, x = np.array(found["series"]).T
    rate = 0.02 / c["timeUnit"]  # m0/(2 m*) = 1 for equal grains
    frequency = np.sqrt(6 * c["pullOffForce"] / (5 * c["equilibriumOverlap"]) / c["reducedMass"] - rate**2)
    # least squares for amplitude and phase with the predicted decay and frequency
    basis = np.exp(-rate * time)[:, None] * np.stack([np.cos(frequency * time), np.sin(frequency * time)], axis=1)
    fit, *_ = np.linalg.lstsq(basis, x, rcond=None)
    assert np.sqrt(np.mean((basis @ fit - x) ** 2)) < 0.02 * np.sqrt(np.mean(x**2))
