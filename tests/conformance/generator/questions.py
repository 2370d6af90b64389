# SPDX-License-Identifier: MIT
"""Scenes and questions as they stand in cases.json."""

from law import exact, mp, rounded

REST = [0.0, 0.0, 0.0]
DIGITS = 12  # of a reference value
CONSTANTS = dict(reduced_young="E", reduced_radius="R", reduced_mass="m", surface_energy="gamma", time_unit="t0")
CONSTANTS.update(equilibrium_contact_radius="a0", equilibrium_overlap="d0", pull_off_overlap="dc", pull_off_force="Fc")
CONSTANTS.update(sliding_stiffness="ks", rolling_stiffness="kr", twisting_stiffness="kt")
CONSTANTS.update(critical_sliding="slide", critical_rolling="roll", critical_twisting="twist")
CONSTANTS.update(linear_drag="drag", viscous_drag_per_contact_radius="viscous")


def grain(material, radius, x=0.0, velocity=REST, spin=REST):
    """A grain on the x axis."""
    return dict(
        material=material, radius=radius, position=[rounded(x), 0.0, 0.0], velocity=list(velocity), spin=list(spin)
    )


def pair(c, delta, materials=("ice", "ice"), velocity2=REST, **more):
    """Two grains of contact constants c with an overlap, the first at the origin, the second on the positive x axis."""
    first, second = grain(materials[0], float(c.r1)), grain(materials[1], float(c.r2), c.r1 + c.r2 - delta, velocity2)
    return dict(grains=[first, second], contact=constants(c), **more)


def constants(c):
    """Those of a contact as they stand in the file, SI; for codes that take stiffnesses, and to be compared first."""
    return {name: float(mp.nstr(getattr(c, of), DIGITS)) for name, of in CONSTANTS.items()}


def along_x(v):
    return [rounded(v), 0.0, 0.0]


def segment(until, velocity1=REST, velocity2=REST, spin1=REST, spin2=REST):
    """Constant velocities and spins of prescribed motion, until a time."""
    return dict(until=until, velocity=[list(velocity1), list(velocity2)], spin=[list(spin1), list(spin2)])


def to_and_fro(quarter, **spins):
    """Spins for a quarter of a cycle, backwards for two, forwards for two: the last four quarters are a closed cycle."""
    sign = lambda s: {k: [s * x for x in v] for k, v in spins.items()}
    return [segment(rounded(k * exact(quarter), 6), **sign(s)) for k, s in ((1, 1.0), (3, -1.0), (5, 1.0))]


def asked(name, what, value, unit, formula, source, scale=None):
    """A question with its reference value; scale: what an error is divided by, for values that are zero or nearly so."""
    found = dict(name=name, unit=unit, measure=what, value=mp.nstr(value, DIGITS, strip_zeros=False))
    if scale is not None:
        found["scale"] = float(mp.nstr(abs(scale), 3))
    return {**found, "formula": formula, "source": source}


def at(time, of, scene="scene"):
    return dict(scene=scene, kind="value", of=of, at=time)


def when(of, passes, value=0.0, after=0.0, before=None, scene="scene"):
    return dict(scene=scene, kind="value", of=of, when=passes, equals=rounded(value), after=after, before=before)


def case(name, title, mechanisms, scenes, questions):
    return dict(id=name, title=title, mechanisms=mechanisms, scenes=scenes, asked=questions)
