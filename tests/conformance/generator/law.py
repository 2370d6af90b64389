# SPDX-License-Identifier: MIT
"""JKR contacts with the springs of Wada et al. and the sintered bonds of Sirono & Ueno, in mpmath's numbers, from the papers.

A22: Arakawa, Tanaka & Kokubo 2022, ApJ 933, 144. A24: Arakawa et al. 2024, Granular Matter 26 (doi:10.1007/s10035-024-01463-x).
K13: Kataoka et al. 2013, A&A 554, A4. S17: Sirono & Ueno 2017, ApJ 841, 36. W07: Wada et al. 2007, ApJ 661, 320.
JKR: Johnson, Kendall & Roberts 1971, Proc. R. Soc. A 324, 301. All quantities are in SI units.
"""

from types import SimpleNamespace

from mpmath import asin, cos, inf, mp, mpf, pi, sin, sqrt  # noqa: F401

mp.dps = 40
MATERIALS = {
    "ice": dict(young=7e9, poisson=0.25, density=1000.0, surface_energy=0.1, critical_rolling=0.8e-9),
    "soft": dict(young=3e9, poisson=0.33, density=1300.0, surface_energy=0.05, critical_rolling=1.1e-9),
    "viscous ice": dict(young=7e9, poisson=0.25, density=1000.0, surface_energy=0.1, critical_rolling=0.8e-9),
}
for name, material in MATERIALS.items():
    material["viscoelastic_time"] = 2e-12 if name == "viscous ice" else 0.0


def exact(number):
    """mpf of the decimal number that stands in the file, not of its nearest double."""
    return mpf(repr(number))


def rounded(number, digits=15):
    """What stands in the file for a number: a double of so many digits."""
    return float(mp.nstr(number, digits))


def contact(name1, r1, name2, r2, linear_damping=0):
    """Constants of a contact of two grains, or (r2 = inf) of a grain on a half-space."""
    m1, m2 = (SimpleNamespace(**{k: exact(v) for k, v in MATERIALS[name].items()}) for name in (name1, name2))
    r1, r2, plane = exact(r1), r2 if r2 == inf else exact(r2), r2 == inf
    c = SimpleNamespace(r1=r1, r2=r2, R=r1 if plane else r1 * r2 / (r1 + r2))
    c.m1 = mpf(4) / 3 * pi * m1.density * r1**3
    c.m2 = inf if plane else mpf(4) / 3 * pi * m2.density * r2**3
    c.m = c.m1 if plane else c.m1 * c.m2 / (c.m1 + c.m2)
    shear1, shear2 = (m.young / (2 * (1 + m.poisson)) for m in (m1, m2))
    c.E = 1 / sum((1 - m.poisson**2) / m.young for m in (m1, m2))
    c.G = 1 / ((2 - m1.poisson) / shear1 + (2 - m2.poisson) / shear2)  # A22 after (18)
    c.G_twist = 1 / (1 / shear1 + 1 / shear2)  # A22 after (23)
    c.gamma = sqrt(m1.surface_energy * m2.surface_energy)
    c.a0 = (9 * pi * c.gamma * c.R**2 / c.E) ** (mpf(1) / 3)  # A22 (1)
    c.d0 = c.a0**2 / (3 * c.R)  # A22 (2)
    c.dc = (mpf(9) / 16) ** (mpf(1) / 3) * c.d0  # A22 (3)
    c.Fc = 3 * pi * c.gamma * c.R  # A22 (6)
    c.kr, c.ks, c.kt = 4 * c.Fc / c.R, 8 * c.a0 * c.G, mpf(16) / 3 * c.G_twist * c.a0**3  # A22 (14), (18), (23)
    c.slide = c.G_twist / c.G * c.a0 / (16 * pi)  # A22 (19): (2 - nu) a0/(16 pi) for like materials
    c.roll, c.twist = (m1.critical_rolling + m2.critical_rolling) / 2, 1 / (16 * pi)  # A22 (24)
    c.viscous = sum(m.viscoelastic_time / m.poisson**2 for m in (m1, m2)) * c.E  # A22 (7), per contact radius
    r, m0 = 2 * c.R, 2 * c.m
    t0 = mpf("0.95") * sqrt(m0 / (mpf(4) / 3 * pi * r**3)) * r ** (mpf(7) / 6)
    c.t0 = t0 / (c.E ** (mpf(1) / 3) * c.gamma ** (mpf(1) / 6))  # K13 (2), with E*
    c.drag = exact(linear_damping) * m0 / c.t0  # K13 (4)
    return c


# ---- normal motion; u = (a/a0)^(1/2) ----

U_BREAK, U_BIRTH = mpf(6) ** (-mpf(1) / 3), (mpf(2) / 3) ** (mpf(1) / 3)  # overlap -delta_c, 0


def overlap(c, u):
    return c.d0 * (3 * u**4 - 2 * u)  # A22 (2)


def radius_root(c, delta):
    """u >= U_BREAK of an overlap."""
    return mp.findroot(lambda u: 3 * u**4 - 2 * u - delta / c.d0, (1 + abs(delta) / c.d0) ** mpf(0.25))


def force(c, u):
    return 4 * c.Fc * (u**6 - u**3)  # A22 (5)


def force_at(c, delta):
    return force(c, radius_root(c, delta))


def energy(c, u):
    terms = mpf(4) / 5 * u**10 - mpf(4) / 3 * u**7 + u**4 / 3
    return c.Fc * c.dc * 4 * mpf(6) ** (mpf(1) / 3) * terms  # A22 (8)


# ---- springs; a pair on the x axis, grain 1 at the origin, grain 2 at (distance, 0, 0) or a plane's normal ----


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def combined(*terms):
    """Sum of factor times vector."""
    return [sum(factor * vector[k] for factor, vector in terms) for k in range(3)]


def turned(vector, angle):
    """A vector turned by a vector of an angle (Rodrigues)."""
    size = sqrt(dot(angle, angle))
    if size == 0:
        return vector
    axis = [x / size for x in angle]
    across = cross(axis, vector)
    return combined((1, vector), (sin(size), across), (1 - cos(size), cross(axis, across)))


def displacements(c, n, n1, n2):
    """zeta and xi of contact pointers n1, n2; n: unit vector from grain 2 to grain 1. A24 (A1), (A2)."""
    zeta0 = combined((c.r1, n1), (-c.r2, n2))
    z = dot(zeta0, n)
    return combined((1, zeta0), (-z, n)), combined((c.R, n1), (c.R, n2)), z


def springs(c, n, distance, n1, n2, phi):
    """Force on grain 1 and torques on both grains. A24 (A5) to (A8)."""
    zeta, xi, z = displacements(c, n, n1, n2)
    torque1 = combined((-c.r1 * c.ks, cross(n1, zeta)), (-c.R * c.kr, cross(n1, xi)), (-c.kt * phi, n))
    torque2 = combined((c.r2 * c.ks, cross(n2, zeta)), (-c.R * c.kr, cross(n2, xi)), (c.kt * phi, n))
    return [c.ks * z / distance * x for x in zeta], torque1, torque2


# ---- sintered bonds ----


def bond(name, r, beta):
    """Constants of a bond of two like grains with radius r, neck a = beta r; with those of a contact that springs() takes."""
    m, r, beta = SimpleNamespace(**{k: exact(v) for k, v in MATERIALS[name].items()}), exact(r), exact(beta)
    a, x = beta * r, beta**2 / (2 * (1 - beta))  # S17 (1), x in r
    d, G = 2 * r * x / (1 + x), m.young / (2 * (1 + m.poisson))  # S17 (2)
    b = SimpleNamespace(r1=r, r2=r, R=r / 2, kn=pi * a**2 * m.young / d, ks=pi * a**2 * G / d)  # S17 (3), (4)
    b.kr, b.kt = pi * a**4 * m.young / (4 * d) / b.R**2, pi * a**4 * G / (2 * d)  # S17 (5) on xi; polar moment
    b.work = pi * a**2 * m.surface_energy  # S17 (6)
    b.m = mpf(2) / 3 * pi * m.density * r**3
    return b
