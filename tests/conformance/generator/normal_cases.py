# SPDX-License-Identifier: MIT
"""Normal motion of two grains, and of a grain and a plane."""

from integration import integrate
from law import *
from questions import REST, along_x, asked, at, case, constants, grain, pair, segment, when

ICE, GAP = contact("ice", 1e-7, "ice", 1e-7), 2.13e-9
LEAST = (mpf(1) / 2) ** (mpf(1) / 3)  # u of the largest pull
PULL = "u^3 = 1/2: F = 4 F_c (u^6 - u^3) = -F_c, delta/delta0 = 3 u^4 - 2 u"
QUADRATURE = "t = int d delta/[2 (K - U_n)/m*]^(1/2) over the overlap, from its formation at delta = 0"


# ---- prescribed ----


def pulled(c, materials=("ice", "ice"), scene="scene"):
    """Scene of a slow pull from 1.5 equilibrium overlaps to just before the break, and its three questions."""
    duration = 1e-8
    speed = (mpf(3) / 2 * c.d0 + mpf("0.99") * c.dc) / exact(duration)
    setting = dict(duration=duration, steps=[500, 1000, 2000])
    made = pair(c, mpf(3) / 2 * c.d0, materials, **setting)
    made["prescribed"] = [segment(duration, velocity2=along_x(speed))]
    least = dict(scene=scene, kind="least", least="push", after=0.0, before=9.9e-9)
    return made, [
        asked("equilibrium overlap", when("overlap", "push", before=9.9e-9, scene=scene), c.d0, "m", "delta0 = a0^2/(3R), a0 = (9 pi gamma R^2/E*)^(1/3)", "A22 (1), (2)"),
        asked("largest pull", {**least, "of": "push"}, -c.Fc, "N", f"F_c = 3 pi gamma R; {PULL}", "JKR; A22 (5), (6)"),
        asked("overlap of the largest pull", {**least, "of": "overlap"}, overlap(c, LEAST), "m", PULL, "A22 (2), (5)"),
    ]  # fmt: skip


def equilibrium():
    made, questions = pulled(ICE)
    return case(
        "equilibrium", "Equilibrium and pull-off, grain 2 drawn away slowly", ["normal"], {"scene": made}, questions
    )


def hysteresis():
    c, speed = ICE, ICE.d0 / mpf("2e-9")
    made = pair(c, mpf("-0.6") * c.d0, duration=1.12e-8, steps=[560, 1120, 2240])
    back = segment(1.12e-8, velocity2=along_x(speed))
    made["prescribed"] = [segment(5.2e-9, velocity2=along_x(-speed)), back]
    start, v = exact(made["grains"][1]["position"][0]), exact(back["velocity"][1][0])
    questions = []
    for way, time in [("approach", t) for t in (6e-10, 1.6e-9, 5.2e-9)] + [("retreat", t) for t in (8.8e-9, 9.8e-9, 1.08e-8, 1.09e-8)]:  # fmt: skip
        turn, t = exact(5.2e-9), exact(time)
        delta = c.r1 + c.r2 - start + v * (min(t, turn) - max(t - turn, 0))
        touching = -c.dc < delta if way == "retreat" else delta > 0
        value = force_at(c, delta) if touching else mpf(0)
        name = f"force on {way} at {float(delta / c.d0):.2f} delta0"
        law = "F = 4 F_c (u^6 - u^3), delta/delta0 = 3 u^4 - 2 u" if touching else "no contact: forms at 0, breaks at -delta_c = -(9/16)^(1/3) delta0"  # fmt: skip
        questions.append(asked(name, at(time, "push"), value, "N", law, "A22 (2), (3), (5)", c.Fc))
    title = "Force along approach and retreat: no contact before delta = 0, contact kept until -delta_c"
    return case("hysteresis", title, ["normal"], {"scene": made}, questions)


# ---- collisions ----


def falling(c, speed, duration, steps, materials=("ice", "ice"), **more):
    return pair(c, -exact(GAP), materials, velocity2=along_x(-exact(speed)), duration=duration, steps=steps, **more)


def separation(c, speed):
    """Speed of separation after an elastic collision above the sticking velocity."""
    return sqrt(exact(speed) ** 2 - 2 * (energy(c, U_BREAK) - energy(c, U_BIRTH)) / c.m)


def greatest(c, kinetic):
    """u of the greatest overlap, with a kinetic energy at the overlap 0."""
    return turning(c, kinetic, (mpf("1.4"), mpf("1.5")))


def turning(c, kinetic, near):
    """u near two others, beyond equilibrium or before it, where the pair has no speed."""
    excess = lambda u: (energy(c, u) - energy(c, U_BIRTH) - kinetic) / (c.Fc * c.dc)
    return mp.findroot(excess, near)


def passing(c, kinetic, low, high):
    """Time from one u to another; kinetic: energy at the overlap 0."""
    total = kinetic + energy(c, U_BIRTH)
    rate = lambda u: c.d0 * (12 * u**3 - 2) / sqrt(2 * (total - energy(c, u)) / c.m)
    with mp.workdps(70):  # the square root vanishes at turning points
        return mp.quad(rate, [low, (low + high) / 2, high])


def collision_questions(c, speed, end, scene="scene"):
    kinetic = c.m * exact(speed) ** 2 / 2
    with mp.workdps(70):
        top = greatest(c, kinetic)
        turn = exact(GAP) / exact(speed) + passing(c, kinetic, U_BIRTH, top)
        broken = turn + passing(c, kinetic, U_BREAK, top)
    late = dict(after=rounded(turn * mpf("1.05"), 3), before=end)
    closed = "[v^2 - 2 (8/15 2^(2/3) + 4/45) F_c delta_c/m*]^(1/2)"
    flight = dict(scene=scene, kind="break", distance=rounded(c.r1 + (0 if c.r2 == inf else c.r2) + c.dc))
    return [
        asked("greatest overlap", when("overlap", "approach", before=end, scene=scene), overlap(c, top), "m", "U_n(delta) - U_n(0) = m* v^2/2", "A22 (2), (8)"),
        asked("time of the greatest overlap", when("time", "approach", before=end, scene=scene), turn, "s", QUADRATURE, "A22 (5), (8)"),
        asked("speed when the overlap is zero again", when("approach", "overlap", **late, scene=scene), -exact(speed), "m/s", "-v: formation gives the grains no kinetic energy", "A22 (9)"),
        asked("time of the break", flight, broken, "s", QUADRATURE + ", to -delta_c", "A22 (3), (8)"),
        asked("speed of separation", at(end, "approach", scene), -separation(c, speed), "m/s", closed, "A22 (9), (10)"),
        asked("energy lost as the contact forms", dict(scene=scene, kind="channel", of="connection", at=end), -energy(c, U_BIRTH), "J", "(8/15) 2^(2/3) F_c delta_c", "A22 (9)"),
        asked("energy lost as it breaks", dict(scene=scene, kind="channel", of="disconnection", at=end), energy(c, U_BREAK), "J", "(4/45) F_c delta_c", "A22 (10)"),
    ]  # fmt: skip


def collision():
    end = 3e-9
    made = falling(ICE, 9.0, end, [3000, 6000, 12000])
    title = "A head-on collision above the sticking velocity: a contact is born and breaks"
    return case("collision", title, ["normal"], {"scene": made}, collision_questions(ICE, 9.0, end))


def sticking():
    speeds, end, questions = {"slow": 5.83, "middle": 7.14, "fast": 11.9}, 3e-9, []
    scenes = {name: falling(ICE, speed, end, [3000, 6000, 12000]) for name, speed in speeds.items()}
    limit = sqrt(2 * (energy(ICE, U_BREAK) - energy(ICE, U_BIRTH)) / ICE.m)
    law, formula = "A22 (9), (10)", "v_s = [2 (8/15 2^(2/3) + 4/45) F_c delta_c/m*]^(1/2)"
    for name in ("middle", "fast"):
        value = separation(ICE, speeds[name]) / exact(speeds[name])
        measure = {**at(end, "approach", name), "over": -speeds[name]}
        questions.append(asked(f"restitution at {speeds[name]} m/s", measure, value, "", "(1 - v_s^2/v^2)^(1/2)", law))
    sticks = dict(scene="slow", kind="separated")
    questions.append(asked(f"separated after {speeds['slow']} m/s", sticks, mpf(0), "", "0: v < v_s", law, 1))
    line = dict(kind="sticking", scenes=["middle", "fast"], speeds=[speeds["middle"], speeds["fast"]])
    questions.append(asked("sticking velocity", line, limit, "m/s", formula, law))
    return case("sticking", "Sticking velocity, and restitution above it", ["normal"], scenes, questions)


def oscillation():
    c, speed, end = ICE, 4.0, 3e-9
    made = pair(c, c.d0, velocity2=along_x(mpf(-4)), duration=end, steps=[1500, 3000, 6000])
    kinetic = c.m * exact(speed) ** 2 / 2 + energy(c, mpf(1)) - energy(c, U_BIRTH)
    with mp.workdps(70):
        high = greatest(c, kinetic)
        low = turning(c, kinetic, (mpf("0.8"), mpf("0.81")))
        first, half = passing(c, kinetic, mpf(1), high), passing(c, kinetic, low, high)
    window = lambda t: dict(after=rounded(t - half / 3, 3), before=rounded(t + half / 3, 3))
    energies, law = "U_n(delta) - U_n(delta0) = m* v^2/2", "A22 (2), (8)"
    return case(
        "oscillation",
        "A pair set ringing about equilibrium, without drag",
        ["normal"],
        {"scene": made},
        [
            asked("greatest overlap", when("overlap", "approach", **window(first)), overlap(c, high), "m", energies, law),
            asked("least overlap", when("overlap", "approach", **window(first + half)), overlap(c, low), "m", energies, law),
            asked("period", when("time", "overlap", c.d0, **window(2 * half)), 2 * half, "s", "2 int d delta/[2 (K - U_n)/m*]^(1/2) between the turning points", "A22 (5), (8)"),
        ],
    )  # fmt: skip


# ---- drag ----


def damped_rate(c):
    """u' and v' of m* v' = -F(u) - (2 A E* a + k_n m0/t0) v, v = d delta/dt."""

    def rate(_, y):
        u, v = y
        return [v / (c.d0 * (12 * u**3 - 2)), -(force(c, u) + (c.viscous * c.a0 * u**2 + c.drag) * v) / c.m]

    return rate


def linear_drag():
    c, speed, end = contact("ice", 1e-7, "ice", 1e-7, 0.05), 4.0, 3e-9
    made = falling(c, speed, end, [3000, 6000, 12000], linear_damping=0.05)
    t, y, questions = exact(GAP) / exact(speed), [U_BIRTH, exact(speed)], []
    law = "m* d2 delta/dt2 = -F - k_n (m0/t0) d delta/dt, m0 = 2 m*, t0 with E*, from delta = 0 with the speed of approach"
    for time in (1e-9, 2e-9, 3e-9):
        y = integrate(damped_rate(c), t, exact(time), y, c.t0)
        t, name = exact(time), f"at {time * 1e9:g} ns"
        questions.append(
            asked(f"overlap {name}", at(time, "overlap"), overlap(c, y[0]), "m", law, "A22 (5); K13 (2), (4)", c.d0)
        )
        questions.append(asked(f"approach {name}", at(time, "approach"), y[1], "m/s", law, "A22 (5); K13 (2), (4)", exact(speed)))  # fmt: skip
    return case("linear-drag", "A pair that sticks and rings down under drag in proportion to velocity", ["normal", "linear drag"], {"scene": made}, questions)  # fmt: skip


def viscous_drag():
    kind, speed, end = ("viscous ice",) * 2, 40.0, 1.5e-9
    c = contact(kind[0], 1e-7, kind[1], 1e-7)
    made, birth = falling(c, speed, end, [6000, 12000, 24000], kind), exact(GAP) / exact(speed)
    by_time, v0 = damped_rate(c), exact(speed)

    def by_speed(v, y):  # t and u, while the deceleration is above zero
        du, dv = by_time(None, [y[1], v])
        return [1 / dv, du / dv]

    def by_root(u, y):  # t and v, smooth up to the break
        du, dv = by_time(None, [u, y[1]])
        return [1 / du, dv / du]

    turn, top = integrate(by_speed, v0, mpf(0), [birth, U_BIRTH], v0 / 8)
    t, u = integrate(by_speed, mpf(0), -v0 / 20, [turn, top], v0 / 40)
    broken, v = integrate(by_root, u, U_BREAK, [t, -v0 / 20], mpf("0.05"))
    law = "m* d2 delta/dt2 = -F - 2 A E* a d delta/dt, A = mean of T_vis/nu^2 of the two grains, from delta = 0 to -delta_c"
    source, flight = "A22 (5), (7)", dict(scene="scene", kind="break", distance=rounded(c.r1 + c.r2 + c.dc))
    return case(
        "viscous-drag",
        "A collision with drag in proportion to contact radius and velocity",
        ["normal", "viscous drag"],
        {"scene": made},
        [
            asked("greatest overlap", when("overlap", "approach", before=end), overlap(c, top), "m", law, source),
            asked("time of the greatest overlap", when("time", "approach", before=end), turn, "s", law, source),
            asked("time of the break", flight, broken, "s", law, source),
            asked("speed of separation", at(end, "approach"), v, "m/s", law, source),
        ],
    )


# ---- a plane ----


def plane():
    c, speed, end = contact("ice", 1e-7, "ice", inf), 8.0, 3e-9
    wall = dict(material="ice", normal=[1.0, 0.0, 0.0], position=[0.0, 0.0, 0.0])
    made = dict(grains=[grain("ice", 1e-7, c.r1 + exact(GAP), along_x(-exact(speed)))], plane=wall, contact=constants(c), duration=end, steps=[6000, 12000, 24000])  # fmt: skip
    questions = collision_questions(c, speed, end)
    turning, duration = rounded(c.slide / c.r1 / 2, 3), 1e-8
    rate = rounded(exact(turning) / exact(duration))
    rolled = dict(
        grains=[grain("ice", 1e-7, c.r1 - c.d0)],
        plane=wall,
        contact=constants(c),
        duration=duration,
        steps=[500, 1000, 2000],
    )
    rolled["prescribed"] = [segment(duration, spin1=[0.0, 0.0, rate])]
    rolled["prescribed"][0]["velocity"], rolled["prescribed"][0]["spin"] = [REST], [[0.0, 0.0, rate]]
    angle = exact(rate) * exact(duration)
    sine, cosine = mp.sin(angle), mp.cos(angle)
    limit = "grain and half-space: the limit r2 -> infinity of W07"
    questions += [
        asked("force of a grain that turns in place", at(duration, "force1.y", "turned"), c.ks * c.r1 * sine, "N", "k_s r sin theta, k_s of R = r", f"A22 (18); {limit}"),
        asked("torque on it", at(duration, "torque1.z", "turned"), -(c.ks * c.r1**2 * sine * cosine + c.kr * c.r1**2 * sine), "N m", "-(k_s r^2 cos theta + k_r r^2) sin theta, k_r = 12 pi gamma", f"A22 (14), (18); {limit}"),
    ]  # fmt: skip
    title = "A grain and a half-space: collision, and the grain turned in place"
    return case("plane", title, ["normal", "plane"], {"scene": made, "turned": rolled}, questions)
