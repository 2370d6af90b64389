"""The kernel's sintered bonds against Sirono & Ueno (2017), numerical quadrature and finite differences."""

import numpy as np
import pytest
from contact_states import force_and_torques, states
from scipy.integrate import quad

RADIUS = 1e-7


@pytest.mark.parametrize(
    "beta,shrunk", [(0.2, 0.9996), (0.3, 0.9977), (0.4, 0.9924), (0.5, 0.9806), (0.6, 0.9575), (0.7, 0.9158)]
)
def test_neck_geometry_and_shrunk_radius(kernel, beta, shrunk):
    """S17 eqs 1, 2; the neck's volume by quadrature of the fillet less the spheres; 0.91 of the radius at 0.7 is in
    S17's Fig. 4."""
    neck = kernel.neck(beta)
    x = beta**2 / (2 * (1 - beta))
    half = x / (1 + x)
    assert neck.fillet == pytest.approx(x, rel=1e-14) and neck.length == pytest.approx(2 * half, rel=1e-14)
    fillet = quad(lambda z: np.pi * (beta + x - np.sqrt(x * x - z * z)) ** 2, -half, half, epsabs=1e-14)[0]
    spheres = 2 * quad(lambda z: np.pi * (1 - (1 - z) ** 2), 0, half, epsabs=1e-14)[0]
    assert neck.volume == pytest.approx((fillet - spheres) / (4 / 3 * np.pi), rel=1e-9)
    assert neck.shrunk_radius == pytest.approx(shrunk, abs=6e-5)
    assert neck.shrunk_radius**3 + 2 * neck.volume == pytest.approx(1, rel=1e-14)


def test_stiffnesses_and_breaking_energy_of_ice(kernel):
    """S17 eqs 3-6 for ice of 0.1 um (E = 7 GPa, G = 2.8 GPa, gamma = 0.1 J/m^2) at beta = 0.5, worked out by hand."""
    b = kernel.bond_constants(0.5)
    a, d = 5e-8, 4e-8  # x = R/4, d = 2 R x/(R + x) = 0.4 R
    assert b.neckRadius == pytest.approx(a) and b.neckLength == pytest.approx(d)
    assert b.normalStiffness == pytest.approx(np.pi * a**2 * 7e9 / d)
    assert b.slidingStiffness == pytest.approx(np.pi * a**2 * 2.8e9 / d)
    assert b.rollingStiffness * b.reducedRadius**2 == pytest.approx(np.pi * a**4 * 7e9 / (4 * d))
    assert b.twistingStiffness == pytest.approx(np.pi * a**4 * 2.8e9 / (2 * d))
    assert b.breakingEnergy == pytest.approx(np.pi * a**2 * 0.1)


def test_unlike_grains_are_symmetric_and_between_the_like_ones(kernel):
    one = kernel.bond_constants(0.4, "ice", 1e-7, "silicate", 3e-7)
    other = kernel.bond_constants(0.4, "silicate", 3e-7, "ice", 1e-7)
    assert np.allclose(one.array[2:], other.array[2:], rtol=1e-14) and one.radius1 == other.radius2
    ice, silicate = (kernel.bond_constants(0.4, m, 1.5e-7, m, 1.5e-7) for m in ("ice", "silicate"))
    assert ice.normalStiffness < one.normalStiffness < silicate.normalStiffness
    assert one.neckRadius == pytest.approx(ice.neckRadius)  # R_g = 2 r1 r2/(r1 + r2)


@pytest.mark.parametrize("radius2", [1e-7, 2.5e-7])
def test_force_is_minus_the_gradient_of_the_energy_and_angular_momentum_is_conserved(kernel, radius2):
    b = kernel.bond_constants(0.4, "ice", RADIUS, "ice", radius2)
    rest = RADIUS + radius2 - 1e-9
    random = np.random.default_rng(1)
    for axis, n1, n2, twist in states(random, 20):
        x = (rest + 1e-9 * random.normal()) * axis
        at = kernel.bond(b, rest, x, n1, n2, twist)
        energy = lambda *state: kernel.bond(b, rest, *state).energies.sum()
        force, torque1, torque2 = force_and_torques(kernel, energy, x, n1, n2, twist, move=1e-13, turn=1e-6)
        torque = b.slidingStiffness * RADIUS * 1e-9
        assert force == pytest.approx(at.force, abs=1e-6 * b.normalStiffness * 1e-9)
        assert torque1 == pytest.approx(at.torque1, abs=1e-5 * torque)
        assert torque2 == pytest.approx(at.torque2, abs=1e-5 * torque)
        rounding = 2.2e-16 * (b.slidingStiffness * np.dot(x, x) + np.linalg.norm(at.force) * np.linalg.norm(x))
        assert np.linalg.norm(at.torque1 + at.torque2 + np.cross(x, at.force)) < 8 * rounding
