# SPDX-License-Identifier: MIT
"""Sintered bonds of two grains (S17)."""

from law import *
from questions import along_x, asked, at, case, pair, segment

BETA, DURATION, STEPS = 0.4, 1e-8, [500, 1000, 2000]
ICE = contact("ice", 1e-7, "ice", 1e-7)
BOND, START = bond("ice", 1e-7, BETA), mpf("1e-9")  # overlap of the grains before sintering, when the bond is made
NECK = "a = beta R_g, x = a^2/[2 (R_g - a)], d = 2 R_g x/(R_g + x)"
BREAKS = "breaks when k u^2/2 = pi a^2 gamma"


def prescribed(name, title, of, unit, at_share, formula, source, full, **motion):
    """A bond driven to 1.25 of the displacement at which it breaks. at_share(share): value of a component when the displacement
    is that share of the end's; full: share at which the bond breaks."""
    made = pair(ICE, START, duration=DURATION, steps=STEPS, neck=BETA, prescribed=[segment(DURATION, **motion)])
    questions = []
    for share in (0.4, 0.796, 0.804):
        value = at_share(exact(share)) if share < full else mpf(0)
        law = f"{formula}; {NECK}" if value else BREAKS
        name_ = f"{of} at {share / float(full):.3f} of the break"
        questions.append(asked(name_, at(rounded(share * DURATION, 6), of), value, unit, law, source if value else "S17 (6)", at_share(exact(0.4))))  # fmt: skip
    return case(name, title, ["bond"], {"scene": made}, questions)


def bond_tension():
    b = BOND
    longest = sqrt(2 * b.work / b.kn)
    speed = exact(rounded(longest * mpf("1.25") / exact(DURATION), 6))
    stretch = speed * exact(DURATION)
    value = lambda share: -b.kn * share * stretch
    return prescribed("bond-tension", "A bond drawn until it breaks", "push", "N", value, "F = k_ss u, k_ss = pi a^2 E/d", "S17 (2), (3)", longest / stretch, velocity2=along_x(speed))  # fmt: skip


def bond_shear():
    b, distance = BOND, ICE.r1 + ICE.r2 - START
    longest = asin(sqrt(2 * b.work / b.ks) / (b.r1 + b.r2))
    rate = rounded(longest * mpf("1.25") / exact(DURATION), 6)
    angle, total = exact(rate) * exact(DURATION), b.r1 + b.r2
    value = lambda share: -b.ks * total**2 * sin(share * angle) * cos(share * angle) / distance
    turn = [0.0, 0.0, rate]
    return prescribed("bond-shear", "A bond sheared by grains that turn the same way", "force1.y", "N", value, "F = k_st z zeta/D, zeta = (r1 + r2) sin theta, z = (r1 + r2) cos theta, k_st = pi a^2 G/d", "S17 (2), (4); A24 (A8)", longest / angle, spin1=turn, spin2=turn)  # fmt: skip


def bond_bending():
    b = BOND
    longest = asin(sqrt(2 * b.work / b.kr) / (2 * b.R))
    rate = rounded(longest * mpf("1.25") / exact(DURATION), 6)
    angle = exact(rate) * exact(DURATION)
    value = lambda share: -(b.R**2) * b.kr * 2 * sin(share * angle) * cos(share * angle)
    return prescribed("bond-bending", "A bond bent by grains that turn opposite ways", "torque1.z", "N m", value, "M = k_sr 2 sin theta cos theta, k_sr = pi a^4 E/(4d), each grain by theta", "S17 (2), (5); A24 (A2), (A6)", longest / angle, spin1=[0.0, 0.0, rate], spin2=[0.0, 0.0, -rate])  # fmt: skip


def bond_torsion():
    b = BOND
    longest = sqrt(2 * b.work / b.kt)
    rate = rounded(longest * mpf("1.25") / exact(DURATION), 6)
    angle = exact(rate) * exact(DURATION)
    value = lambda share: -b.kt * share * angle
    return prescribed("bond-torsion", "A bond twisted", "torque1.x", "N m", value, "M = k_sw phi, k_sw = pi a^4 G/(2d): polar moment of the disk", "S17 (2), in space", longest / angle, spin1=[rate, 0.0, 0.0])  # fmt: skip


def bond_break():
    assert gone_after_the_break()
    b, end, steps = BOND, 1e-10, [1000, 2000, 4000]
    omega, longest = sqrt(b.kn / b.m), sqrt(2 * b.work / b.kn)
    v = exact(rounded(mpf("1.5") * omega * longest, 6))
    made = pair(ICE, START, velocity2=along_x(v), duration=end, steps=steps, neck=BETA)
    distance, source = exact(made["grains"][1]["position"][0]), "S17 (3), (6)"
    time = asin(omega * longest / v) / omega
    before = rounded(time / 2, 2)
    flight = dict(scene="scene", kind="break", distance=rounded(distance + longest))
    stretch = v / omega * sin(omega * exact(before))
    return case(
        "bond-break",
        "Bonded grains that fly apart",
        ["bond"],
        {"scene": made},
        [
            asked("force half-way", at(before, "push"), -b.kn * stretch, "N", f"k_ss u, u = (v/w) sin w t, w^2 = k_ss/m*; {NECK}", "S17 (2), (3)"),
            asked("time of the break", flight, time, "s", "asin(w u_b/v)/w, k_ss u_b^2/2 = pi a^2 gamma", source),
            asked("speed of separation", at(end, "approach"), -sqrt(v**2 - 2 * b.work / b.m), "m/s", "(v^2 - 2 pi a^2 gamma/m*)^(1/2)", source),
            asked("energy lost as it breaks", dict(scene="scene", kind="channel", of="bond breaking", at=end), b.work, "J", "pi a^2 gamma", "S17 (6)"),
        ],
    )  # fmt: skip


def gone_after_the_break():
    """Whether broken bonds leave no contact: the grains have shrunk (S17 section 3.3: two necks a grain, constant volume)."""
    beta = exact(BETA)
    x = beta**2 / (2 * (1 - beta))
    h = x / (1 + x)
    # fillet less sphere, y from the mid-plane
    profile = lambda y: (beta + x - sqrt(x**2 - y**2)) ** 2 - (1 - (1 - y) ** 2)
    volume = 2 * pi * mp.quad(profile, [0, h])
    shrunk = (1 - 2 * volume / (mpf(4) / 3 * pi)) ** (mpf(1) / 3)
    return ICE.r1 + ICE.r2 - START - 2 * shrunk * ICE.r1 > 0
