# SPDX-License-Identifier: MIT
"""JKR contacts with the springs of Wada et al. and the sintered bonds of Sirono & Ueno, in mpmath's numbers, and scenes
and questions as they stand in cases.json.

Constants of contacts and bonds are those of analysis.theory. A22: Arakawa, Tanaka & Kokubo 2022. A24: Arakawa et al.
2024. S17: Sirono & Ueno 2017. W07: Wada et al. 2007. JKR: Johnson, Kendall & Roberts 1971. All in SI units.
"""

import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
from mpmath import asin, cos, inf, mp, mpf, pi, sin, sqrt  # noqa: F401

sys.path.insert(0, str(Path(__file__).resolve().parents[3]))
from analysis.theory import Material, bond_constants, pair_constants

mp.dps = 40
ICE = dict(young=7e9, poisson=0.25, density=1000.0, surface_energy=0.1, critical_rolling=0.8e-9)
SOFT = dict(young=3e9, poisson=0.33, density=1300.0, surface_energy=0.05, critical_rolling=1.1e-9)
MATERIALS = {"ice": {**ICE, "viscoelastic_time": 0.0}, "soft": {**SOFT, "viscoelastic_time": 0.0}}
MATERIALS["silicate"] = dict(young=54e9, poisson=0.17, density=2650.0, surface_energy=0.02)
MATERIALS["silicate"].update(critical_rolling=2e-9, viscoelastic_time=0.0)
MATERIALS["viscous ice"] = {**ICE, "viscoelastic_time": 2e-12}


def exact(number):
    """mpf of the decimal number that stands in the file, not of its nearest double."""
    return mpf(repr(number))


def rounded(number, digits=15):
    """What stands in the file for a number: a double of so many digits."""
    return float(mp.nstr(number, digits))


# ---- constants: short names here, names in the file and in analysis.theory ----

CONSTANTS = dict(E="reduced_young", R="reduced_radius", m="reduced_mass", gamma="surface_energy", t0="time_unit")
CONSTANTS.update(a0="equilibrium_contact_radius", d0="equilibrium_overlap", dc="pull_off_overlap", Fc="pull_off_force")
CONSTANTS.update(ks="sliding_stiffness", kr="rolling_stiffness", kt="twisting_stiffness")
CONSTANTS.update(slide="critical_sliding", roll="critical_rolling", twist="critical_twisting")
CONSTANTS.update(drag="linear_drag", viscous="viscous_drag_per_contact_radius")


def contact(name1="ice", r1=1e-7, name2="ice", r2=1e-7, linear_damping=0.0):
    """Constants of a contact of two grains, or (r2 = inf) of a grain on a half-space."""
    materials = [Material(**MATERIALS[name]) for name in (name1, name2)]
    found = vars(pair_constants(materials[0], r1, materials[1], float(r2), linear_damping))
    gamma = mp.sqrt(exact(materials[0].surface_energy) * exact(materials[1].surface_energy))
    found = {**found, "surface_energy": gamma, "viscous_drag_per_contact_radius": found["drag_per_contact_radius"]}
    c = SimpleNamespace(**{short: mpf(found[name]) for short, name in CONSTANTS.items()})
    c.r1, c.r2 = exact(r1), r2 if r2 == inf else exact(r2)
    c.m1 = mpf(4) / 3 * pi * exact(materials[0].density) * c.r1**3
    return c


def bond(name, r, beta):
    """Constants of a bond of two like grains with radius r, neck a = beta r; with those that springs() takes."""
    material, r = Material(**MATERIALS[name]), exact(r)
    found = bond_constants(material, float(r), beta)
    a, d = mpf(found.neck_radius), mpf(found.neck_length)
    shear = exact(material.young) / (2 * (1 + exact(material.poisson)))
    b = SimpleNamespace(r1=r, r2=r, R=r / 2, kn=mpf(found.normal_stiffness), ks=mpf(found.sliding_stiffness))
    b.kr, b.kt = pi * a**4 * exact(material.young) / (4 * d) / b.R**2, pi * a**4 * shear / (2 * d)  # S17 (5); polar
    b.work, b.m = mpf(found.breaking_energy), mpf(2) / 3 * pi * exact(material.density) * r**3
    return b


# ---- normal motion; u = (a/a0)^(1/2) ----

U_BREAK, U_BIRTH = mpf(6) ** (-mpf(1) / 3), (mpf(2) / 3) ** (mpf(1) / 3)  # overlap -delta_c, 0


def overlap(c, u):
    return c.d0 * (3 * u**4 - 2 * u)  # A22 (2)


def radius_root(c, delta):
    """u >= U_BREAK of an overlap."""
    return mp.findroot(lambda u: 3 * u**4 - 2 * u - delta / c.d0, (1 + abs(delta) / c.d0) ** mpf(0.25))


def force(c, u):
    return 4 * c.Fc * (u**6 - u**3)  # A22 (5)


def energy(c, u):
    terms = mpf(4) / 5 * u**10 - mpf(4) / 3 * u**7 + u**4 / 3
    return c.Fc * c.dc * 4 * mpf(6) ** (mpf(1) / 3) * terms  # A22 (8)


# ---- springs; vectors are arrays (3,) of mpmath's numbers; n: unit vector from grain 2 to grain 1 ----


def vector(*numbers):
    """Of mpf, and of the decimal numbers that stand in the file."""
    return np.array([exact(x) if isinstance(x, float) else mpf(x) for x in numbers], dtype=object)


def size(a):
    return sqrt(a @ a)


def turned(a, angle):
    """A vector turned by a vector of an angle (Rodrigues)."""
    if size(angle) == 0:
        return a
    axis = angle / size(angle)
    across = np.cross(axis, a)
    return a + sin(size(angle)) * across + (1 - cos(size(angle))) * np.cross(axis, across)


def displacements(c, n, n1, n2):
    """zeta and xi of contact pointers n1, n2 (..., 3), and the lever z (..., 1): A24 (A1), (A2)."""
    zeta0 = c.r1 * n1 - c.r2 * n2
    z = (zeta0 * n).sum(axis=-1, keepdims=True)
    return zeta0 - z * n, c.R * (n1 + n2), z


def springs(c, n, distance, n1, n2, phi):
    """Force on grain 1 and torques on both grains: A24 (A5) to (A8)."""
    zeta, xi, z = displacements(c, n, n1, n2)
    torque1 = -c.r1 * c.ks * np.cross(n1, zeta) - c.R * c.kr * np.cross(n1, xi) - c.kt * phi * n
    torque2 = c.r2 * c.ks * np.cross(n2, zeta) - c.R * c.kr * np.cross(n2, xi) + c.kt * phi * n
    return c.ks * z / distance * zeta, torque1, torque2


# ---- ordinary differential equations (mpmath's own odefun takes forty times as long) ----


def integrate(rate, start, end, y, steps, columns=14):
    """y (array) at `end` of y' = rate(t, y), from `start`, by equal steps: midpoint rules of 2, 4, 6 ... parts in each,
    extrapolated (Gragg, Bulirsch & Stoer)."""
    h, y = (end - start) / steps, np.array(y, dtype=object)
    for step in range(steps):
        rows = []
        for k in range(columns):
            rows.append([midpoint(rate, start + step * h, y, h, 2 * (k + 1))])
            for j in range(k):
                factor = (mpf(k + 1) / (k - j)) ** 2 - 1
                rows[k].append(rows[k][j] + (rows[k][j] - rows[k - 1][j]) / factor)
        y = rows[-1][-1]
    return y


def midpoint(rate, t, y, step, parts):
    h = step / parts
    before, now = y, y + h * rate(t, y)
    for k in range(1, parts):
        before, now = now, before + 2 * h * rate(t + k * h, now)
    return (before + now + h * rate(t + step, now)) / 2


# ---- scenes and questions as they stand in the file ----

REST = [0.0, 0.0, 0.0]
DIGITS = 12  # of a reference value


def grain(material, radius, x=0.0, velocity=REST, spin=REST):
    """A grain on the x axis."""
    return dict(material=material, radius=radius, position=along_x(x), velocity=list(velocity), spin=list(spin))


def pair(c, delta, materials=("ice", "ice"), velocity2=REST, **more):
    """Two grains of contact constants c with an overlap, the first at the origin, the second on the positive x axis."""
    first, second = grain(materials[0], float(c.r1)), grain(materials[1], float(c.r2), c.r1 + c.r2 - delta, velocity2)
    return dict(grains=[first, second], contact=constants(c), **more)


def constants(c):
    """Those of a contact as they stand in the file; for codes that take stiffnesses, and to be compared first."""
    return {name: float(mp.nstr(getattr(c, short), DIGITS)) for short, name in CONSTANTS.items()}


def along_x(v):
    return [rounded(v), 0.0, 0.0]


def segment(until, velocity1=REST, velocity2=REST, spin1=REST, spin2=REST):
    """Constant velocities and spins of prescribed motion, until a time."""
    return dict(until=until, velocity=[list(velocity1), list(velocity2)], spin=[list(spin1), list(spin2)])


def asked(name, what, value, unit, formula, source, scale=None):
    """A question with its reference value; scale: what an error is divided by, of values that are zero or nearly so."""
    found = dict(name=name, unit=unit, measure=what, value=mp.nstr(value, DIGITS, strip_zeros=False))
    if scale is not None:
        found["scale"] = float(mp.nstr(abs(scale), 3))
    return {**found, "formula": formula, "source": source}


def at(time, of, scene="scene"):
    return dict(scene=scene, kind="value", of=of, at=time)


def when(of, passes, value=0.0, after=0.0, before=None, scene="scene"):
    return dict(scene=scene, kind="value", of=of, when=passes, equals=rounded(value), after=after, before=before)


def channel(of, time):
    return dict(scene="scene", kind="channel", of=of, at=time)


def flight(distance):
    return dict(scene="scene", kind="break", distance=rounded(distance))


def case(name, title, mechanisms, scenes, questions):
    return dict(id=name, title=title, mechanisms=mechanisms.split(", "), scenes=scenes, asked=questions)
