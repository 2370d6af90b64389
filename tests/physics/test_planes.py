"""Grains on planes (YADE's Wall), with the functors and the fused engine, against closed forms and a huge second sphere
(rebounds: test_pairs.py)."""

import pytest
from scenes import *

from analysis.theory import ICE, pair_constants

pytestmark = pytest.mark.in_yade
R = 1e-7  # of the grains [m]
STILL, MOVING = (0, 0, 0), dict(plane_velocity=(3.0, 1.0, 8.0))
ICY = pair_constants(ICE, R, ICE, np.inf)


def plane(material, axis=2, position=0.0, velocity=(0, 0, 0)):
    body = utils.wall(position, axis=axis, material=material)
    body.state.vel = [float(v) for v in velocity]
    return O.bodies.append(body)


def lone_grain(position, velocity=STILL, spin=STILL, step=0.05, blocked="", plane_velocity=STILL, **options):
    """A grain of ice above the plane z = 0; O.dt is `step` t0."""
    new_scene(step * ICY.time_unit, **options)
    plane(ice(), velocity=plane_velocity)
    grain(position, R, ice(), velocity, spin, blocked)


@pytest.mark.parametrize("limit", ["held", "cut"])
@pytest.mark.parametrize("mode", ["sliding", "dragged", "rolling", "twisting"])
def test_driven_past_the_limit(mode, limit):
    """A grain slides, rolls or twists on a plane (or the plane is dragged under it) by 8.5 limits: force or torque at
    the limit, what is stored and lost (A22 eqs 13-26; cut: 8 springs of k crit^2/2), and the other modes untouched."""
    spring = "sliding" if mode == "dragged" else mode
    crit, k = getattr(ICY, "critical_" + spring), getattr(ICY, spring + "_stiffness")
    steps, total = 3400, 8.5 * crit
    lone_grain((0, 0, R - ICY.equilibrium_overlap), blocked="xyzXYZ", limit=limit)
    rate, grain_state = total / (steps * O.dt), O.bodies[1].state
    if mode == "rolling":
        grain_state.vel, grain_state.angVel = (rate, 0, 0), (0, rate / R, 0)
    elif mode == "twisting":
        grain_state.angVel = (0, 0, rate)
    else:
        O.bodies[1 if mode == "sliding" else 0].state.vel = (rate, 0, 0)
    O.run(steps + 1, True)
    e, of_k = energies("constraintWork"), k * crit**2
    stored, lost = (0.5, 8) if limit == "held" else (0.125, 4)
    held = 1 if limit == "held" else 0.5
    assert e[spring] == pytest.approx(stored * of_k, rel=5e-3)
    assert e[spring + "Dissipation"] == pytest.approx((lost - 0.5 * (limit == "held")) * of_k, rel=5e-3)
    for other in {"sliding", "rolling", "twisting"} - {spring}:
        assert abs(e[other]) + abs(e[other + "Dissipation"]) < 2e-3 * e[spring + "Dissipation"], other
    force, torque = np.array(O.forces.f(1)), np.array(O.forces.t(1))
    if spring == "sliding":
        way = 1 if mode == "dragged" else -1
        assert force[0] == pytest.approx(way * held * k * crit, rel=5e-3)
        assert torque[1] == pytest.approx(-R * force[0], rel=2e-2)
    if mode == "dragged":
        assert e["constraintWork"] == pytest.approx(-(stored + lost - 0.5 * (limit == "held")) * of_k, rel=5e-3)
    if mode == "rolling":
        assert torque[1] == pytest.approx(-held * k * crit * R, rel=1e-2)
        assert abs(force[0]) < 1e-3 * ICY.sliding_stiffness * ICY.critical_sliding
    if mode == "twisting":
        assert torque[2] == pytest.approx(-held * k * crit, rel=5e-3)


VELOCITY, SPIN = np.array([1.7, 0.6, -12.0]), np.array([1e8, -0.7e8, 2e8])


def impact(step=0.05, axis=2, side=1, radius2=None, plane_velocity=STILL, gap=0.003, first=True, **options):
    """(velocity, spin r) of a grain that has met a plane (appended before it or after) obliquely, and the closure after
    it over K(0). Vectors are given for a plane across z, below the grain, and turned with it."""
    turn = np.roll(np.eye(3), axis - 2, axis=0) if side > 0 else np.roll(np.diag([1.0, -1, -1]), axis - 2, axis=0)
    new_scene(step * ICY.time_unit, **options)
    drift = turn @ plane_velocity
    place = turn @ np.array([0.3, 0.2, 1 + gap]) * R
    for add_plane in (first, not first):
        if not add_plane:
            number = grain(place, R, ice(), turn @ VELOCITY + drift, turn @ SPIN)
        elif radius2 is None:
            plane(ice(), axis, 0.0, drift)
        else:
            grain(turn @ (0, 0, -radius2), radius2, ice(), blocked="xyzXYZ")
    O.step()
    sums = []
    for _ in range(int(20 / step)):
        O.step()
        e = energies("constraintWork")
        sums.append(sum(e.values()))
        kinetic = e["kinetic"] if len(sums) == 1 else kinetic
    s = O.bodies[number].state
    assert e["slidingDissipation"] > 0 and e["disconnection"] > 0
    return turn.T @ (s.vel - drift), turn.T @ s.angVel * R, (sums[-1] - sums[0]) / kinetic


SIDES = [dict(axis=axis, side=side) for axis in (0, 1, 2) for side in (-1, 1)]


@pytest.mark.parametrize("where", [*SIDES, MOVING, dict(first=False)])
def test_a_plane_is_the_same_on_all_axes_and_sides_and_when_it_moves(where):
    (velocity, spin, _), (expected, expected_spin, _) = impact(**where), impact()
    assert np.abs(velocity - expected).max() < 1e-8 and np.abs(spin - expected_spin).max() < 1e-8


@pytest.mark.parametrize("limit", ["held", "cut"])
def test_a_plane_is_the_limit_of_a_huge_sphere(limit):
    plane_end = np.concatenate(impact(limit=limit)[:2])
    ends = {n: np.concatenate(impact(radius2=n * R, limit=limit)[:2]) for n in (1e3, 1e4, 1e5)}
    off = [np.abs(end - plane_end).max() * n for n, end in ends.items()]
    assert max(off) < 100 and np.ptp(off) < 0.1 * off[2]  # the difference is of first order in r/r2


OF_FUNCTORS = [dict(), dict(limit="cut"), dict(damping=0.02), MOVING, dict(rolling=False)]
OF_ENGINE = [dict(mover="fused", damping=0.02), dict(mover="fused", limit="cut", **MOVING)]


@pytest.mark.parametrize("options", OF_FUNCTORS + OF_ENGINE)
def test_ledger_of_an_oblique_impact_closes_with_second_order(options):
    gaps = 0.003 + 0.001 * np.arange(8) / 1.7  # root mean square, as of rebounds
    coarse, fine = (rms(impact(s, gap=gap, **options)[2] for gap in gaps) for s in (0.05, 0.00625))
    assert fine < 1e-4 and coarse / fine > 3.2**3


def piston(step):
    """A plane pushes three grains in a row against another: (closure in time, difference of constraintWork and the work
    integrated) over the work."""
    new_scene(step * ICY.time_unit)
    gap = 2 * R - constants(ice(), R)["equilibriumOverlap"]
    plane(ice())
    for k in range(3):
        grain((0.1 * R * k, 0, R - ICY.equilibrium_overlap + k * gap), R, ice())
    top = plane(ice(), position=2.03 * R + 2 * gap, velocity=(0, 0, -2.0))
    sums, pushes = [], []
    for _ in range(int(150 / step)):
        O.step()
        sums.append(energies("constraintWork"))
        pushes.append(O.forces.f(top)[2])
    total = np.array([sum(e.values()) for e in sums])
    work = sums[-1]["constraintWork"]
    assert work < -1e-16
    # in each step the wall moves by -2 O.dt against this push
    by_force = 2.0 * O.dt * (np.sum(pushes) - pushes[-1] / 2)
    return np.std(total) / -work, abs(by_force + work) / -work


def test_piston_against_a_chain():
    coarse, fine = piston(0.1), piston(0.0125)
    assert fine[0] < 1e-5 and coarse[0] / fine[0] > 3.2**3
    assert fine[1] < 1e-12
