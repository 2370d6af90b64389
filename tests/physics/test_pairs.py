"""Two grains, or a grain and a plane, in YADE against closed forms and an independent integration: error and order of
convergence."""

import pytest
from scenes import *

from analysis.theory import ICE, Material, collide_pair, pair_constants

pytestmark = pytest.mark.in_yade
R = 1e-7  # of a grain of ice [m]
SOFT = Material(3e9, 0.33, 1300.0, 0.05, 1.1e-9)  # soft() of scenes.py
PLANE = np.inf
# Radius of what the grain meets, and what moves them.
AGAINST = pytest.mark.parametrize("radius2, mover", [(R, "functors"), (PLANE, "functors"), (PLANE, "fused")])


def touching():
    counts = O.engines[0].statistics() if isinstance(O.engines[0], JKRWadaEngine) else {}
    return counts["contacts"] + counts["planeContacts"] if counts else O.interactions.countReal()


def rebound(speed, step, gap, material, other=None, radius2=R, mover="functors"):
    """Speed of separation after a head-on collision with a grain or a plane, 0 when they stick."""
    other = other or material
    time_unit = constants(material, R, other, radius2)["timeUnit"]
    new_scene(step * time_unit, mover)
    if radius2 == PLANE:
        O.bodies.append(utils.wall(0, axis=0, material=other))
    else:
        grain((-radius2, 0, 0), radius2, other)
    grain((R + gap, 0, 0), R, material, (-speed, 0, 0))
    while O.time < 200 * time_unit and (O.time < 2 * gap / speed or touching()):
        steps(int(1 / step))
    return 0.0 if touching() else O.bodies[1].state.vel[0] - O.bodies[0].state.vel[0]


def sticking(step, expected, *scene):
    """The velocity up to which grains stick, to 2e-4 of it; 10 % at most from what is expected."""
    low, high = 0.9 * expected, 1.1 * expected
    while high - low > 2e-4 * low:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if rebound(middle, step, 2e-9, *scene) > 0 else (middle, high)
    return 0.5 * (low + high)


def viscous(time):
    return Material(**{**vars(ICE), "viscoelastic_time": time})


@AGAINST
def test_sticking_velocity_without_drag(radius2, mover):
    """[2 (8/15 2^(2/3) + 4/45) F_c delta_c/m*]^(1/2) (A22 eqs 9, 10), 5.95 m/s for ice of 0.1 um; of a plane R = r and
    m* = m."""
    c = pair_constants(ICE, R, ICE, radius2)
    closed = np.sqrt(2 * (8 / 15 * 2 ** (2 / 3) + 4 / 45) * c.pull_off_force * c.pull_off_overlap / c.reduced_mass)
    assert radius2 == PLANE or closed == pytest.approx(5.95, abs=0.005)
    assert sticking(0.02, closed, ice(), ice(), radius2, mover) == pytest.approx(closed, rel=1e-3)


@AGAINST
@pytest.mark.parametrize("kind", ["elastic", "viscous", "unlike"])
def test_rebound_converges_with_second_order(kind, radius2, mover):
    """Rebound speed against a closed form (elastic) or an independent integration. Contacts form and break anywhere
    within a step, so the error at one step scatters: root mean square over twelve gaps. Events that are not located in
    time would give first order (ratio 2)."""
    speed, time = (40.0, 2e-12) if kind == "viscous" else (9.0, 0.0)
    material, like = ice(viscoelasticTime=time), viscous(time)
    other, its = (soft(), SOFT) if kind == "unlike" else (material, like)
    if kind == "unlike" and radius2 != PLANE:
        radius2 = 1.7e-7
    exact = collide_pair(speed, pair_constants(like, R, its, radius2)).rebound_velocity
    gaps = 2e-9 + 1e-10 * np.arange(12) / 1.7

    def error(step):
        return rms(rebound(speed, step, gap, material, other, radius2, mover) / exact - 1 for gap in gaps)

    coarse, fine = error(0.1), error(0.0125)
    assert coarse < 1e-2 and fine < 2e-4 and coarse / fine > 3.2**3  # second order gives 64, first order 8


STIFF = {"sliding_factor": 2.5, "rolling_factor": 8}


@pytest.mark.parametrize("mode, factors", [("sliding", {}), ("rolling", {}), ("twisting", {}), ("rolling", STIFF)])
@pytest.mark.parametrize("radius2", [1e-7, 2.5e-7])
def test_driven_past_the_limit(mode, factors, radius2):
    """Two blocked grains at equilibrium are turned until a displacement is 8 times its limit: force at the limit,
    stored k/2 crit^2, dissipated k crit (total - crit) (A22 eqs 13-26), and the other two modes untouched. The
    pointers' finite angles (up to 8 crit/r, 6 %) enter in second order, less for smaller grains' limits."""
    c, factor = constants(ice(), 1e-7, ice(), radius2), factors.get(f"{mode}_factor", 1)
    new_scene(0.1 * c["timeUnit"], **factors)
    r1, r2 = 1e-7, radius2
    limit, stiffness = c[f"critical{mode.capitalize()}"], factor * c[f"{mode}Stiffness"]
    steps = 3200
    rate = 8 * limit / (steps * O.dt)
    spins = dict(
        sliding=((0, 0, rate / (r1 + r2)), (0, 0, rate / (r1 + r2))),
        rolling=((0, 0, rate / r1), (0, 0, -rate / r2)),
        twisting=((rate, 0, 0), (0, 0, 0)),
    )[mode]
    grain((0, 0, 0), r1, ice(), spin=spins[0], blocked="xyzXYZ")
    grain((r1 + r2 - c["equilibriumOverlap"], 0, 0), r2, ice(), spin=spins[1], blocked="xyzXYZ")
    O.run(steps + 1, True)
    e = energies()
    assert e[mode] == pytest.approx(stiffness / 2 * limit**2, rel=1e-3)
    assert e[mode + "Dissipation"] == pytest.approx(stiffness * limit * 7 * limit, rel=2e-3)
    for other in {"sliding", "rolling", "twisting"} - {mode}:
        assert abs(e[other]) + abs(e[other + "Dissipation"]) < 2e-3 * e[mode + "Dissipation"], other
    force, torque = np.array(O.forces.f(0)), np.array(O.forces.t(0))
    if mode == "sliding":
        assert np.linalg.norm(force[1:]) == pytest.approx(stiffness * limit, rel=1e-2)
    if mode == "rolling":
        assert np.linalg.norm(torque) == pytest.approx(stiffness * limit * c["reducedRadius"], rel=2e-2)
    if mode == "twisting":
        assert abs(torque[0]) == pytest.approx(stiffness * limit, rel=1e-12)
    assert np.allclose(force, -np.array(O.forces.f(1)), rtol=0, atol=1e-12 * np.linalg.norm(force) + 1e-22)


def test_linear_damping_of_k13():
    """A pair at equilibrium with k_n = 0.02 rings at the slope 6 F_c/(5 delta0) (A24 eq 38) and decays as exp(-k_n m0
    t/(2 m* t0))."""
    c = constants(ice(), 1e-7)
    new_scene(0.02 * c["timeUnit"], damping=0.02)
    d = 2e-7 - c["equilibriumOverlap"]
    grain((0, 0, 0), 1e-7, ice())
    grain((d + 1e-3 * c["equilibriumOverlap"], 0, 0), 1e-7, ice())
    series = []
    for _ in range(3000):
        O.step()
        series.append([O.time, O.bodies[1].state.pos[0] - O.bodies[0].state.pos[0] - d])
    time, x = np.array(series).T
    rate = 0.02 / c["timeUnit"]  # m0/(2 m*) = 1 for equal grains
    frequency = np.sqrt(6 * c["pullOffForce"] / (5 * c["equilibriumOverlap"]) / c["reducedMass"] - rate**2)
    # least squares for amplitude and phase with the predicted decay and frequency
    basis = np.exp(-rate * time)[:, None] * np.stack([np.cos(frequency * time), np.sin(frequency * time)], axis=1)
    fit, *_ = np.linalg.lstsq(basis, x, rcond=None)
    assert np.sqrt(np.mean((basis @ fit - x) ** 2)) < 0.02 * np.sqrt(np.mean(x**2))
