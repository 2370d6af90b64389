"""The kernel against the theory of analysis/, closed forms and finite differences: constants, normal law, forces as
gradients, limits."""

from fractions import Fraction

import numpy as np
import pytest
from contact_states import force_and_torques, states, unit
from scipy.spatial.transform import Rotation

from analysis import theory

# --- constants -----------------------------------------------------------------------------------

KINDS = [("ice", 1e-7, "ice", 1e-7), ("ice", 1e-7, "viscous", 4e-7), ("silicate", 6e-7, "ice", 2e-7)]
PLANE = ("viscous", 1e-7, "ice", np.inf)


@pytest.mark.parametrize("kind", [*KINDS, ("silicate", 6e-7, "silicate", 6e-7), PLANE])
def test_constants_are_those_of_theory(kernel, kind):
    """Which tests/analysis/test_theory.py holds to the papers' numbers; of a plane R = r and m* = m."""
    material1, radius1, material2, radius2 = kind
    one, other = (theory.Material(*kernel.materials[name]) for name in (material1, material2))
    found = kernel.constants(*kind, damping=0.02, springs=1e-12, mixed=0.3)
    options = dict(linear_damping=0.02, spring_damping=1e-12, mixed_factor=0.3)
    expected = vars(theory.pair_constants(one, radius1, other, radius2, **options))
    for name, value in expected.items():
        first, *words = name.split("_")
        assert getattr(found, first + "".join(map(str.capitalize, words))) == pytest.approx(value, rel=1e-13), name


def test_a_cube_root_is_the_nearest_number(kernel):
    """So it is the same on every machine."""
    for x in 10 ** np.random.default_rng(1).uniform(-200, 200, 1000):
        root = kernel.cube_root(x)
        below, above = (Fraction(root) + Fraction(np.nextafter(root, end)) for end in (0, np.inf))
        assert below**3 < 8 * Fraction(x) < above**3
        assert kernel.cube_root(-x) == -root
    assert kernel.cube_root(0.0) == 0 and kernel.cube_root(np.inf) == np.inf and np.isnan(kernel.cube_root(np.nan))


def test_sliding_as_s17_prints_it(kernel):
    """F_nt = G a0^2/(2 pi) at u_nt = (2 - nu) a0/(16 pi): S17 eqs 11 and 12. Only the stiffness changes."""
    ours, printed = kernel.constants(), kernel.constants(sliding=2)
    young, poisson = kernel.materials["ice"][:2]
    shear, a0 = young / (2 * (1 + poisson)), printed.equilibriumContactRadius
    assert printed.criticalSliding == pytest.approx((2 - poisson) * a0 / (16 * np.pi), rel=1e-14)
    assert printed.slidingStiffness * printed.criticalSliding == pytest.approx(shear * a0**2 / (2 * np.pi), rel=1e-14)
    changed = [name for name in kernel.constant_names if getattr(ours, name) != getattr(printed, name)]
    assert changed == ["slidingStiffness"]


def test_stiff_rolling_has_the_same_limit(kernel):
    """xi_crit is the material's: torque and energy at the limit rise with k_r, 4 F_c/R times the factor."""
    ours, stiff = kernel.constants(), kernel.constants(rolling=8)
    assert stiff.rollingStiffness == pytest.approx(8 * 4 * ours.pullOffForce / ours.reducedRadius, rel=1e-14)
    changed = [name for name in kernel.constant_names if getattr(ours, name) != getattr(stiff, name)]
    assert changed == ["rollingStiffness"]


# --- normal law ----------------------------------------------------------------------------------


def test_normal_law_is_that_of_theory(kernel):
    """Whose root is exact to the last digits and whose energy is the integral of its force
    (tests/analysis/test_theory.py)."""
    near = -theory.jkr.PULL_OFF_OVERLAP + np.r_[0, 10.0 ** np.arange(-14.0, -1)]
    overlap = np.concatenate([near, np.linspace(-0.8, 6, 341), [4.0000001, 10, 100, 1e4]])
    u, force, energy = kernel.normal_law(overlap)
    exact = theory.contact_radius_root(overlap)
    # near pull-off the root itself is known only to the square root of the overlap's rounding
    known = np.maximum(4e-15 * exact, 1e-15 / np.maximum(np.abs(12 * exact**3 - 2), 1e-8))
    assert (np.abs(u - exact) < known).all()
    for found, expected in ((force, theory.normalised_force(overlap)), (energy, theory.normalised_energy(overlap))):
        assert found == pytest.approx(expected, rel=1e-6, abs=1e-7)
        away = overlap > -0.8
        assert found[away] == pytest.approx(expected[away], rel=1e-13, abs=1e-13)


# --- forces and torques --------------------------------------------------------------------------


@pytest.mark.parametrize("kind", KINDS)
def test_forces_and_torques_are_minus_the_gradient_of_the_energy(kernel, kind):
    c = kernel.constants(*kind)
    random = np.random.default_rng(1)
    for axis, n1, n2, twist in states(random, 20):
        x = (c.radius1 + c.radius2 - random.uniform(-0.7, 3) * c.equilibriumOverlap) * axis
        at = kernel.contact(c, x, n1, n2, twist=twist)
        energy = lambda x, n1, n2, twist: kernel.contact(c, x, n1, n2, twist=twist).energies.sum()
        move, turn = 1e-4 * c.equilibriumOverlap, 1e-5
        force, torque1, torque2 = force_and_torques(kernel, energy, x, n1, n2, twist, move, turn)
        size = np.linalg.norm(at.torque1) + c.pullOffForce * c.equilibriumOverlap
        assert force == pytest.approx(at.force, abs=2e-6 * c.pullOffForce)
        assert torque1 == pytest.approx(at.torque1, abs=2e-6 * size)
        assert torque2 == pytest.approx(at.torque2, abs=2e-6 * size)


@pytest.mark.parametrize("kind", KINDS)
def test_no_net_torque_and_rotation_and_exchange_symmetry(kernel, kind):
    c, exchanged = kernel.constants(*kind), kernel.constants(*kind[2:], *kind[:2])
    assert np.allclose(c.array[2:], exchanged.array[2:], rtol=1e-14, atol=0)
    random = np.random.default_rng(2)
    for axis, n1, n2, twist in states(random, 50):
        x = (c.radius1 + c.radius2 - random.uniform(-0.7, 3) * c.equilibriumOverlap) * axis
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
    c = kernel.constants("viscous", 1e-7, "viscous", 1e-7, 0.01)
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
    c = kernel.constants(*kind)
    r1, r2, R = c.radius1, c.radius2, c.reducedRadius

    def errors(size, seed):
        random = np.random.default_rng(seed)
        axis = unit(random.normal(size=3))
        n1, n2 = unit(-axis + size * random.normal(size=3)), unit(axis + size * random.normal(size=3))

        def slide(a, b):
            z = r1 * a - r2 * b
            return z - np.dot(z, axis) * axis

        def roll(a, b):
            return R * (a + b)

        def roll_across(a, b):
            d = roll(a, b)
            return d - np.dot(d, axis) * axis

        returned, other = ((slide, roll_across), (roll, slide))[which]
        limit = 0.6 * np.linalg.norm(returned(n1, n2))
        m1, m2 = kernel.return_to_limit(c, axis, n1, n2, which, limit)
        assert np.linalg.norm(m1) == pytest.approx(1, abs=1e-15) and np.linalg.norm(m2) == pytest.approx(1, abs=1e-15)
        return (
            abs(np.linalg.norm(returned(m1, m2)) - limit) / limit,
            np.linalg.norm(other(m1, m2) - other(n1, n2)) / limit,
        )

    coarse, fine = (np.mean([errors(size, seed) for seed in range(40)], axis=0) for size in (0.02, 0.01))
    # relative errors are first order or better in the angles; absolute ones therefore second
    assert np.all(coarse < 0.05) and np.all(fine < 0.55 * coarse)


def test_turning_is_a_rotation(kernel):
    random = np.random.default_rng(3)
    for size in (1e-12, 1e-3, 1.0, 3.0):
        v, angle = random.normal(size=3), size * unit(random.normal(size=3))
        assert np.allclose(kernel.turn(v, angle), Rotation.from_rotvec(angle).apply(v), rtol=1e-14, atol=1e-14)
