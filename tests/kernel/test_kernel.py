"""The kernel against closed forms and finite differences: constants, normal law, forces as gradients, limits."""

from fractions import Fraction

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.spatial.transform import Rotation

PULL_OFF = (9 / 16) ** (1 / 3)


def unit(v):
    return np.asarray(v) / np.linalg.norm(v)


# --- constants -----------------------------------------------------------------------------------


def test_constants_of_ice_are_those_of_model(kernel):
    c = kernel.constants()
    expected = dict(
        equilibriumContactRadius=12.3712e-9,
        equilibriumOverlap=1.02031e-9,
        pullOffForce=47.1239e-9,
        slidingStiffness=79.176,
        rollingStiffness=3.7699,
        twistingStiffness=1.41372e-14,
        criticalSliding=0.43071e-9,
        timeUnit=1.936e-10,
    )
    for name, value in expected.items():
        digits = len(f"{value:e}".split("e")[0].rstrip("0").replace(".", ""))
        assert getattr(c, name) == pytest.approx(value, rel=0.51 * 10.0 ** (1 - digits)), name


def test_a_cube_root_is_the_nearest_number(kernel):
    """So it is the same on every machine."""
    for x in 10 ** np.random.default_rng(1).uniform(-200, 200, 1000):
        root = kernel.cube_root(x)
        below, above = (Fraction(root) + Fraction(np.nextafter(root, end)) for end in (0, np.inf))
        assert below**3 < 8 * Fraction(x) < above**3
        assert kernel.cube_root(-x) == -root
    assert kernel.cube_root(0.0) == 0 and kernel.cube_root(np.inf) == np.inf and np.isnan(kernel.cube_root(np.nan))


def test_energies_of_table_2_of_a22(kernel):
    c = kernel.constants()
    u0, force0, energy0 = kernel.normal_law([1.0])
    unit_energy = c.pullOffForce * c.pullOffOverlap
    table = {
        "F_c delta_c": (unit_energy, 4.0e-17),
        "E_break": (unit_energy * (4 / 45 - energy0[0]), 6.1e-17),
        "E_r,crit": (c.rollingStiffness * c.criticalRolling**2 / 2, 1.2e-18),
        "E_roll": (c.rollingStiffness * c.criticalRolling * np.pi * c.reducedRadius, 4.7e-16),
        "E_s,crit": (c.slidingStiffness * c.criticalSliding**2 / 2, 7.3e-18),
        "E_slide": (
            c.slidingStiffness * c.criticalSliding * np.pi * c.reducedRadius,
            5.4e-15,
        ),  # misprinted in A22: model.md
        "E_t,crit": (c.twistingStiffness * c.criticalTwisting**2 / 2, 2.8e-18),
        "E_twist": (c.twistingStiffness * c.criticalTwisting * np.pi / 2, 4.4e-16),
    }
    for name, (ours, printed) in table.items():
        assert float(f"{ours:.1e}") == printed, name


def test_sliding_as_s17_prints_it(kernel):
    """F_nt = G a0^2/(2 pi) at u_nt = (2 - nu) a0/(16 pi): S17 eqs 11 and 12. Only the stiffness changes."""
    ours, printed = kernel.constants(), kernel.constants(sliding=2)
    young, poisson = kernel.ice[:2]
    shear, a0 = young / (2 * (1 + poisson)), printed.equilibriumContactRadius
    assert printed.criticalSliding == pytest.approx((2 - poisson) * a0 / (16 * np.pi), rel=1e-14)
    assert printed.slidingStiffness * printed.criticalSliding == pytest.approx(shear * a0**2 / (2 * np.pi), rel=1e-14)
    changed = [name for name in kernel.constant_names if getattr(ours, name) != getattr(printed, name)]
    assert changed == ["slidingStiffness"]


def test_time_unit_and_rolling_energy_of_silicate(kernel):
    c = kernel.constants(kernel.silicate, 6e-7, kernel.silicate, 6e-7)
    assert c.timeUnit == pytest.approx(1.71e-9, rel=3e-3)
    assert c.rollingStiffness * c.criticalRolling * np.pi * c.reducedRadius == pytest.approx(1.42e-15, rel=4e-3)


def test_unlike_pair_is_symmetric_and_between_its_kinds(kernel):
    ab = kernel.constants(kernel.ice, 1e-7, kernel.viscous, 3e-7, 0.02)
    ba = kernel.constants(kernel.viscous, 3e-7, kernel.ice, 1e-7, 0.02)
    assert np.allclose(ab.array[2:], ba.array[2:], rtol=1e-14)
    like = kernel.constants(kernel.viscous, 2e-7, kernel.viscous, 2e-7)
    assert like.criticalSliding == pytest.approx((2 - 0.33) * like.equilibriumContactRadius / (16 * np.pi), rel=1e-14)
    assert like.dragPerContactRadius == pytest.approx(2 * 4e-12 * like.reducedYoung / 0.33**2, rel=1e-14)


# --- normal law ----------------------------------------------------------------------------------


def test_contact_radius_root_against_bisection(kernel):
    overlaps = np.concatenate(
        [-PULL_OFF + 10.0 ** np.arange(-14.0, -1), np.linspace(-0.8, 4, 200), [4.0000001, 10, 100, 1e4]]
    )
    u, _, _ = kernel.normal_law(overlaps)
    for overlap, found in zip(overlaps, u):
        exact = brentq(lambda x: 3 * x**4 - 2 * x - overlap, 6 ** (-1 / 3), 100, xtol=1e-15, rtol=1e-15)
        # near pull-off the root itself is known only to the square root of the overlap's rounding
        known = max(4e-15 * exact, 1e-15 / max(abs(12 * exact**3 - 2), 1e-8))
        assert abs(found - exact) < known, overlap


def test_normal_force_is_the_slope_of_its_energy(kernel):
    overlap = np.linspace(-0.8, 6, 341)
    h = 1e-4
    _, force, _ = kernel.normal_law(overlap)
    difference = kernel.normal_law(overlap + h)[2] - kernel.normal_law(overlap - h)[2]
    # F_c per delta0 against F_c delta_c per delta0: the slope times delta_c/delta0
    slope = difference / (2 * h) * PULL_OFF
    assert np.allclose(slope[overlap > -0.7], force[overlap > -0.7], rtol=0, atol=2e-6)


def test_energies_at_connection_and_pull_off(kernel):
    _, force, energy = kernel.normal_law([0.0, -PULL_OFF, 1.0])
    assert energy[0] == pytest.approx(-8 / 15 * 2 ** (2 / 3), rel=1e-14)
    assert energy[1] == pytest.approx(4 / 45, rel=1e-7)
    assert force == pytest.approx([-8 / 9, -5 / 9, 0], abs=1e-7)


# --- forces and torques --------------------------------------------------------------------------


def states(seed, count):
    """Random contacts: separation direction, pointers a little off the axis, twist, orientation of everything."""
    random = np.random.default_rng(seed)
    for _ in range(count):
        axis = unit(random.normal(size=3))
        n1, n2 = unit(-axis + 0.02 * random.normal(size=3)), unit(axis + 0.02 * random.normal(size=3))
        yield axis, n1, n2, random.normal() * 0.02, random.uniform(-0.7, 3), random


KINDS = [("ice", 1e-7, "ice", 1e-7), ("ice", 1e-7, "viscous", 4e-7), ("silicate", 6e-7, "ice", 2e-7)]


@pytest.mark.parametrize("kind", KINDS)
def test_forces_and_torques_are_minus_the_gradient_of_the_energy(kernel, kind):
    c = kernel.constants(getattr(kernel, kind[0]), kind[1], getattr(kernel, kind[2]), kind[3])
    for axis, n1, n2, twist, overlap, _ in states(1, 20):
        x = (c.radius1 + c.radius2 - overlap * c.equilibriumOverlap) * axis
        at = kernel.contact(c, x, n1, n2, twist=twist)

        def energy(move=np.zeros(3), turn1=np.zeros(3), turn2=np.zeros(3)):
            n = unit(x + move)
            grown = twist + np.dot(turn1 - turn2, n)  # dphi = (w1 - w2).n dt
            return kernel.contact(
                c, x + move, kernel.turn(n1, turn1), kernel.turn(n2, turn2), twist=grown
            ).energies.sum()

        for i in range(3):
            e = np.eye(3)[i]
            h, angle = 1e-4 * c.equilibriumOverlap, 1e-5
            assert -(energy(move=h * e) - energy(move=-h * e)) / (2 * h) == pytest.approx(
                at.force[i], abs=2e-6 * c.pullOffForce
            )
            size = np.linalg.norm(at.torque1) + c.pullOffForce * c.equilibriumOverlap
            assert -(energy(turn1=angle * e) - energy(turn1=-angle * e)) / (2 * angle) == pytest.approx(
                at.torque1[i], abs=2e-6 * size
            )
            assert -(energy(turn2=angle * e) - energy(turn2=-angle * e)) / (2 * angle) == pytest.approx(
                at.torque2[i], abs=2e-6 * size
            )


@pytest.mark.parametrize("kind", KINDS)
def test_no_net_torque_and_rotation_and_exchange_symmetry(kernel, kind):
    c = kernel.constants(getattr(kernel, kind[0]), kind[1], getattr(kernel, kind[2]), kind[3])
    exchanged = kernel.constants(getattr(kernel, kind[2]), kind[3], getattr(kernel, kind[0]), kind[1])
    for axis, n1, n2, twist, overlap, random in states(2, 50):
        x = (c.radius1 + c.radius2 - overlap * c.equilibriumOverlap) * axis
        v = random.normal(size=3)
        at = kernel.contact(c, x, n1, n2, v, twist)
        rounding = 2.2e-16 * (
            c.slidingStiffness * np.dot(x, x) + np.linalg.norm(at.force) * np.linalg.norm(x)
        )  # of what is added up
        assert np.linalg.norm(at.torque1 + at.torque2 + np.cross(x, at.force)) < 4 * rounding

        turn = Rotation.random(random_state=random.integers(1 << 30)).as_matrix()
        turned = kernel.contact(c, turn @ x, turn @ n1, turn @ n2, turn @ v, twist)
        assert np.allclose(turned.force, turn @ at.force, rtol=0, atol=1e-11 * np.linalg.norm(at.force))
        assert np.allclose(turned.torque1, turn @ at.torque1, rtol=0, atol=1e-11 * np.linalg.norm(at.torque1))

        # seen from the other grain: w1 - w2 and n_c both change sign, so the twist stays
        other = kernel.contact(exchanged, -x, n2, n1, -v, twist)
        assert np.allclose(other.force, -at.force, rtol=0, atol=1e-12 * np.linalg.norm(at.force))
        assert np.allclose(other.torque1, at.torque2, rtol=0, atol=1e-11 * np.linalg.norm(at.torque1))
        assert other.energies == pytest.approx(at.energies, rel=1e-9)
        assert other.drag == pytest.approx(at.drag, rel=1e-12)


def test_drag_opposes_motion_and_has_the_coefficient_of_a22_eq_7(kernel):
    c = kernel.constants(kernel.viscous, 1e-7, kernel.viscous, 1e-7, 0.01)
    axis = unit([1.0, 2, -1])
    for overlap in (-0.5, 0.0, 1.0, 3.0):
        u, _, _ = kernel.normal_law([overlap])
        x = (2e-7 - overlap * c.equilibriumOverlap) * axis
        at = kernel.contact(c, x, -axis, axis, velocity=-2.5 * axis)  # approaching
        a = c.equilibriumContactRadius * u[0] ** 2
        mass = 4 / 3 * np.pi * 1300 * 1e-21
        assert at.drag == pytest.approx(
            2.5 * (2 * 4e-12 * c.reducedYoung / 0.33**2 * a + 0.01 * mass / c.timeUnit), rel=1e-7
        )


# --- limits --------------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("which", [0, 1])
def test_returning_reaches_the_limit_and_leaves_the_other_displacement(kernel, kind, which):
    """Errors must fall as the square of the pointers' angles: halving them quarters the errors."""
    c = kernel.constants(getattr(kernel, kind[0]), kind[1], getattr(kernel, kind[2]), kind[3])
    r1, r2, R = c.radius1, c.radius2, c.reducedRadius

    def errors(size, seed):
        random = np.random.default_rng(seed)
        axis = unit(random.normal(size=3))
        n1, n2 = unit(-axis + size * random.normal(size=3)), unit(axis + size * random.normal(size=3))

        def slide(a, b):
            z = r1 * a - r2 * b
            return z - np.dot(z, axis) * axis

        def roll(a, b):
            d = R * (a + b)
            return d - np.dot(d, axis) * axis

        mine, other = (slide, roll) if which == 0 else (roll, slide)
        target = slide if which == 0 else lambda a, b: R * (a + b)
        limit = 0.6 * np.linalg.norm(target(n1, n2))
        m1, m2 = kernel.return_to_limit(c, axis, n1, n2, which, limit)
        assert np.linalg.norm(m1) == pytest.approx(1, abs=1e-15) and np.linalg.norm(m2) == pytest.approx(1, abs=1e-15)
        return (
            abs(np.linalg.norm(target(m1, m2)) - limit) / limit,
            np.linalg.norm(other(m1, m2) - other(n1, n2)) / limit,
            np.linalg.norm(mine(m1, m2)) / limit,
        )

    coarse = np.mean([errors(0.02, seed)[:2] for seed in range(40)], axis=0)
    fine = np.mean([errors(0.01, seed)[:2] for seed in range(40)], axis=0)
    # relative errors are first order or better in the angles; absolute ones therefore second
    assert np.all(coarse < 0.05) and np.all(fine < 0.55 * coarse)


def test_turning_is_a_rotation(kernel):
    random = np.random.default_rng(3)
    for size in (1e-12, 1e-3, 1.0, 3.0):
        v, angle = random.normal(size=3), size * unit(random.normal(size=3))
        assert np.allclose(kernel.turn(v, angle), Rotation.from_rotvec(angle).apply(v), rtol=1e-14, atol=1e-14)
