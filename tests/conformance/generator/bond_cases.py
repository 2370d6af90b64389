# SPDX-License-Identifier: MIT
"""Sintered bonds of two grains (S17)."""

from law import *

BETA, DURATION = 0.4, 1e-8
TWO, BOND, START = contact(), bond("ice", 1e-7, BETA), mpf("1e-9")  # overlap when the bond is made
NECK = "a = beta R_g, x = a^2/[2 (R_g - a)], d = 2 R_g x/(R_g + x)"
BREAKS = "breaks when k u^2/2 = pi a^2 gamma"


def prescribed(name, title, of, unit, value, formula, source, full, **motion):
    """A bond driven to 1.25 of the displacement at which it breaks.

    value(share): of the component `of` when the displacement is that share of the end's; full: share of the break.
    """
    made = pair(TWO, START, duration=DURATION, steps=[500, 1000, 2000], neck=BETA)
    made["prescribed"], questions, scale = [segment(DURATION, **motion)], [], value(exact(0.4))
    for share in (0.4, 0.796, 0.804):
        what = at(rounded(share * DURATION, 6), of)
        whole = share < full
        law = (value(exact(share)), unit, f"{formula}; {NECK}", source) if whole else (mpf(0), unit, BREAKS, "S17 (6)")
        questions.append(asked(f"{of} at {share / float(full):.3f} of the break", what, *law, scale))
    return case(name, title, "bond", {"scene": made}, questions)


def rate_to(longest):
    """[1/s], as it stands in the file, to 1.25 of a displacement in DURATION; and the displacement then."""
    rate = rounded(longest * mpf("1.25") / exact(DURATION), 6)
    return rate, exact(rate) * exact(DURATION)


def bond_tension():
    longest = sqrt(2 * BOND.work / BOND.kn)
    speed, stretch = rate_to(longest)
    law = "push", "N", lambda share: -BOND.kn * share * stretch, "F = k_ss u, k_ss = pi a^2 E/d", "S17 (2), (3)"
    title = "A bond drawn until it breaks"
    return prescribed("bond-tension", title, *law, longest / stretch, velocity2=[speed, 0.0, 0.0])


def bond_shear():
    total, distance = BOND.r1 + BOND.r2, TWO.r1 + TWO.r2 - START
    longest = asin(sqrt(2 * BOND.work / BOND.ks) / total)
    rate, angle = rate_to(longest)
    value = lambda share: -BOND.ks * total**2 * sin(share * angle) * cos(share * angle) / distance
    formula = "F = k_st z zeta/D, zeta = (r1 + r2) sin theta, z = (r1 + r2) cos theta, k_st = pi a^2 G/d"
    title, turn = "A bond sheared by grains that turn the same way", [0.0, 0.0, rate]
    law = "force1.y", "N", value, formula, "S17 (2), (4); A24 (A8)"
    return prescribed("bond-shear", title, *law, longest / angle, spin1=turn, spin2=turn)


def bond_bending():
    longest = asin(sqrt(2 * BOND.work / BOND.kr) / (2 * BOND.R))
    rate, angle = rate_to(longest)
    value = lambda share: -(BOND.R**2) * BOND.kr * 2 * sin(share * angle) * cos(share * angle)
    formula = "M = k_sr 2 sin theta cos theta, k_sr = pi a^4 E/(4d), each grain by theta"
    law = "torque1.z", "N m", value, formula, "S17 (2), (5); A24 (A2), (A6)"
    title = "A bond bent by grains that turn opposite ways"
    return prescribed("bond-bending", title, *law, longest / angle, spin1=[0.0, 0.0, rate], spin2=[0.0, 0.0, -rate])


def bond_torsion():
    longest = sqrt(2 * BOND.work / BOND.kt)
    rate, angle = rate_to(longest)
    formula = "M = k_sw phi, k_sw = pi a^4 G/(2d): polar moment of the disk"
    law = "torque1.x", "N m", lambda share: -BOND.kt * share * angle, formula, "S17 (2), in space"
    return prescribed("bond-torsion", "A bond twisted", *law, longest / angle, spin1=[rate, 0.0, 0.0])


def bond_break():
    """Grains have shrunk, so that no contact is left when their bond breaks (S17 section 3.3)."""
    b, end = BOND, 1e-10
    omega, longest = sqrt(b.kn / b.m), sqrt(2 * b.work / b.kn)
    v = exact(rounded(mpf("1.5") * omega * longest, 6))
    made = pair(TWO, START, velocity2=along_x(v), duration=end, steps=[1000, 2000, 4000], neck=BETA)
    distance, source = exact(made["grains"][1]["position"][0]), "S17 (3), (6)"
    time = asin(omega * longest / v) / omega
    before = rounded(time / 2, 2)
    half_way = -b.kn * v / omega * sin(omega * exact(before))
    apart = -sqrt(v**2 - 2 * b.work / b.m)
    questions = [
        asked("force half-way", at(before, "push"), half_way, "N",
              f"k_ss u, u = (v/w) sin w t, w^2 = k_ss/m*; {NECK}", "S17 (2), (3)"),
        asked("time of the break", flight(distance + longest), time, "s",
              "asin(w u_b/v)/w, k_ss u_b^2/2 = pi a^2 gamma", source),
        asked("speed of separation", at(end, "approach"), apart, "m/s", "(v^2 - 2 pi a^2 gamma/m*)^(1/2)", source),
        asked("energy lost as it breaks", channel("bond breaking", end), b.work, "J", "pi a^2 gamma", "S17 (6)"),
    ]  # fmt: skip
    return case("bond-break", "Bonded grains that fly apart", "bond", {"scene": made}, questions)
