# SPDX-License-Identifier: MIT
"""Normal motion of two grains, and of a grain and a plane."""

from law import *

TWO, GAP = contact(), 2.13e-9
LEAST = (mpf(1) / 2) ** (mpf(1) / 3)  # u of the largest pull
PULL = "u^3 = 1/2: F = 4 F_c (u^6 - u^3) = -F_c, delta/delta0 = 3 u^4 - 2 u"
QUADRATURE = "t = int d delta/[2 (K - U_n)/m*]^(1/2) over the overlap, from its formation at delta = 0"


# ---- prescribed ----


def pulled(c, speed, materials=("ice", "ice"), scene="scene"):
    """Scene of a slow pull [m/s] from 1.5 equilibrium overlaps to 0.99 of the break, and its three questions."""
    made = pair(c, mpf(3) / 2 * c.d0, materials, duration=1e-8, steps=[500, 1000, 2000])
    made["prescribed"] = [segment(1e-8, velocity2=[speed, 0.0, 0.0])]
    least, balanced = dict(scene=scene, kind="least", least="push", after=0.0, before=9.9e-9), dict(before=9.9e-9)
    return made, [
        asked("equilibrium overlap", when("overlap", "push", **balanced, scene=scene), c.d0, "m",
              "delta0 = a0^2/(3R), a0 = (9 pi gamma R^2/E*)^(1/3)", "A22 (1), (2)"),
        asked("largest pull", {**least, "of": "push"}, -c.Fc, "N", f"F_c = 3 pi gamma R; {PULL}", "JKR; A22 (5), (6)"),
        asked("overlap of the largest pull", {**least, "of": "overlap"}, overlap(c, LEAST), "m", PULL, "A22 (2), (5)"),
    ]  # fmt: skip


def equilibrium():
    made, questions = pulled(TWO, 0.236429175985075)
    title = "Equilibrium and pull-off, grain 2 drawn away slowly"
    return case("equilibrium", title, "normal", {"scene": made}, questions)


def hysteresis():
    c, speed, turn, end = TWO, 0.510155406843857, 5.2e-9, 1.12e-8  # delta0 in 2 ns
    made = pair(c, mpf("-0.6") * c.d0, duration=end, steps=[560, 1120, 2240])
    made["prescribed"] = [segment(t, velocity2=[v, 0.0, 0.0]) for t, v in ((turn, -speed), (end, speed))]
    start, v, questions = exact(made["grains"][1]["position"][0]), exact(speed), []
    for time in (6e-10, 1.6e-9, 5.2e-9, 8.8e-9, 9.8e-9, 1.08e-8, 1.09e-8):
        way, t = "approach" if time <= turn else "retreat", exact(time)
        delta = c.r1 + c.r2 - start + v * (min(t, exact(turn)) - max(t - exact(turn), 0))
        touching = -c.dc < delta if way == "retreat" else delta > 0
        value = force(c, radius_root(c, delta)) if touching else mpf(0)
        law = "no contact: forms at 0, breaks at -delta_c = -(9/16)^(1/3) delta0"
        law = "F = 4 F_c (u^6 - u^3), delta/delta0 = 3 u^4 - 2 u" if touching else law
        name = f"force on {way} at {float(delta / c.d0):.2f} delta0"
        questions.append(asked(name, at(time, "push"), value, "N", law, "A22 (2), (3), (5)", c.Fc))
    title = "Force along approach and retreat: no contact before delta = 0, contact kept until -delta_c"
    return case("hysteresis", title, "normal", {"scene": made}, questions)


# ---- collisions ----


def falling(c, speed, duration, steps, materials=("ice", "ice"), **more):
    return pair(c, -exact(GAP), materials, velocity2=along_x(-exact(speed)), duration=duration, steps=steps, **more)


def separation(c, speed):
    """Speed of separation after an elastic collision above the sticking velocity."""
    return sqrt(exact(speed) ** 2 - 2 * (energy(c, U_BREAK) - energy(c, U_BIRTH)) / c.m)


def turning(c, kinetic, near=(mpf("1.4"), mpf("1.5"))):
    """u near two others where a pair with a kinetic energy at the overlap 0 has no speed; beyond equilibrium."""
    excess = lambda u: (energy(c, u) - energy(c, U_BIRTH) - kinetic) / (c.Fc * c.dc)
    return mp.findroot(excess, near)


def passing(c, kinetic, low, high):
    """Time from one u to another; kinetic: energy at the overlap 0."""
    total = kinetic + energy(c, U_BIRTH)
    rate = lambda u: c.d0 * (12 * u**3 - 2) / sqrt(2 * (total - energy(c, u)) / c.m)
    with mp.workdps(70):  # the square root vanishes at turning points
        return mp.quad(rate, [low, (low + high) / 2, high])


def collision_questions(c, speed, end):
    kinetic, together = c.m * exact(speed) ** 2 / 2, c.r1 + (0 if c.r2 == inf else c.r2)
    with mp.workdps(70):
        top = turning(c, kinetic)
        turn = exact(GAP) / exact(speed) + passing(c, kinetic, U_BIRTH, top)
        broken = turn + passing(c, kinetic, U_BREAK, top)
    late, source = dict(after=rounded(turn * mpf("1.05"), 3), before=end), "A22 (5), (8)"
    closed = "[v^2 - 2 (8/15 2^(2/3) + 4/45) F_c delta_c/m*]^(1/2)"
    return [
        asked("greatest overlap", when("overlap", "approach", before=end), overlap(c, top), "m",
              "U_n(delta) - U_n(0) = m* v^2/2", "A22 (2), (8)"),
        asked("time of the greatest overlap", when("time", "approach", before=end), turn, "s", QUADRATURE, source),
        asked("speed when the overlap is zero again", when("approach", "overlap", **late), -exact(speed), "m/s",
              "-v: formation gives the grains no kinetic energy", "A22 (9)"),
        asked("time of the break", flight(together + c.dc), broken, "s", QUADRATURE + ", to -delta_c", "A22 (3), (8)"),
        asked("speed of separation", at(end, "approach"), -separation(c, speed), "m/s", closed, "A22 (9), (10)"),
        asked("energy lost as the contact forms", channel("connection", end), -energy(c, U_BIRTH), "J",
              "(8/15) 2^(2/3) F_c delta_c", "A22 (9)"),
        asked("energy lost as it breaks", channel("disconnection", end), energy(c, U_BREAK), "J",
              "(4/45) F_c delta_c", "A22 (10)"),
    ]  # fmt: skip


def collision():
    made = falling(TWO, 9.0, 3e-9, [3000, 6000, 12000])
    title = "A head-on collision above the sticking velocity: a contact is born and breaks"
    return case("collision", title, "normal", {"scene": made}, collision_questions(TWO, 9.0, 3e-9))


def sticking():
    c, speeds, end, law = TWO, {"slow": 5.83, "middle": 7.14, "fast": 11.9}, 3e-9, "A22 (9), (10)"
    scenes = {name: falling(c, speed, end, [3000, 6000, 12000]) for name, speed in speeds.items()}
    questions = []
    for name in ("middle", "fast"):
        measure = {**at(end, "approach", name), "over": -speeds[name]}
        value = separation(c, speeds[name]) / exact(speeds[name])
        questions.append(asked(f"restitution at {speeds[name]} m/s", measure, value, "", "(1 - v_s^2/v^2)^(1/2)", law))
    sticks = dict(scene="slow", kind="separated")
    questions.append(asked(f"separated after {speeds['slow']} m/s", sticks, mpf(0), "", "0: v < v_s", law, 1))
    line = dict(kind="sticking", scenes=["middle", "fast"], speeds=[speeds["middle"], speeds["fast"]])
    limit = sqrt(2 * (energy(c, U_BREAK) - energy(c, U_BIRTH)) / c.m)
    formula = "v_s = [2 (8/15 2^(2/3) + 4/45) F_c delta_c/m*]^(1/2)"
    questions.append(asked("sticking velocity", line, limit, "m/s", formula, law))
    return case("sticking", "Sticking velocity, and restitution above it", "normal", scenes, questions)


def oscillation():
    c, speed = TWO, mpf(4)
    made = pair(c, c.d0, velocity2=along_x(-speed), duration=3e-9, steps=[1500, 3000, 6000])
    kinetic = c.m * speed**2 / 2 + energy(c, mpf(1)) - energy(c, U_BIRTH)
    with mp.workdps(70):
        high, low = turning(c, kinetic), turning(c, kinetic, (mpf("0.8"), mpf("0.81")))
        first, half = passing(c, kinetic, mpf(1), high), passing(c, kinetic, low, high)
    window = lambda t: dict(after=rounded(t - half / 3, 3), before=rounded(t + half / 3, 3))
    energies, law = "U_n(delta) - U_n(delta0) = m* v^2/2", "A22 (2), (8)"
    period = "2 int d delta/[2 (K - U_n)/m*]^(1/2) between the turning points"
    again = {**when("time", "overlap", **window(2 * half)), "equals": 1.02031081368771e-09}  # delta0
    questions = [
        asked("greatest overlap", when("overlap", "approach", **window(first)), overlap(c, high), "m", energies, law),
        asked(
            "least overlap", when("overlap", "approach", **window(first + half)), overlap(c, low), "m", energies, law
        ),
        asked("period", again, 2 * half, "s", period, "A22 (5), (8)"),
    ]
    title = "A pair set ringing about equilibrium, without drag"
    return case("oscillation", title, "normal", {"scene": made}, questions)


# ---- drag ----


def damped_rate(c):
    """u' and v' of m* v' = -F(u) - (2 A E* a + k_n m0/t0) v, v = d delta/dt."""

    def rate(_, y):
        u, v = y
        return vector(v / (c.d0 * (12 * u**3 - 2)), -(force(c, u) + (c.viscous * c.a0 * u**2 + c.drag) * v) / c.m)

    return rate


def linear_drag():
    c, speed, questions = contact(linear_damping=0.05), 4.0, []
    made = falling(c, speed, 3e-9, [3000, 6000, 12000], linear_damping=0.05)
    t, y = exact(GAP) / exact(speed), [U_BIRTH, exact(speed)]
    law = "m* d2 delta/dt2 = -F - k_n (m0/t0) d delta/dt, m0 = 2 m*, t0 with E*, "
    law, source = law + "from delta = 0 with the speed of approach", "A22 (5); K13 (2), (4)"
    for time in (1e-9, 2e-9, 3e-9):
        y = integrate(damped_rate(c), t, exact(time), y, 12)
        t, name = exact(time), f"at {time * 1e9:g} ns"
        questions.append(asked(f"overlap {name}", at(time, "overlap"), overlap(c, y[0]), "m", law, source, c.d0))
        questions.append(asked(f"approach {name}", at(time, "approach"), y[1], "m/s", law, source, exact(speed)))
    title = "A pair that sticks and rings down under drag in proportion to velocity"
    return case("linear-drag", title, "normal, linear drag", {"scene": made}, questions)


def viscous_drag():
    kinds, speed, end = ("viscous ice",) * 2, 40.0, 1.5e-9
    c = contact(kinds[0], 1e-7, kinds[1], 1e-7)
    made, birth = falling(c, speed, end, [6000, 12000, 24000], kinds), exact(GAP) / exact(speed)
    by_time, v0 = damped_rate(c), exact(speed)

    def by_speed(v, y):  # t and u, while the deceleration is above zero
        du, dv = by_time(None, [y[1], v])
        return vector(1 / dv, du / dv)

    def by_root(u, y):  # t and v, smooth up to the break
        du, dv = by_time(None, [u, y[1]])
        return vector(1 / du, dv / du)

    u, v = integrate(by_time, birth, exact(2e-10), [U_BIRTH, v0], 40)  # by time while the force pulls
    turn, top = integrate(by_speed, v, mpf(0), [exact(2e-10), u], 16)
    t, u = integrate(by_speed, mpf(0), -v0 / 4, [turn, top], 16)
    broken, v = integrate(by_root, u, U_BREAK, [t, -v0 / 4], 80)
    law = "m* d2 delta/dt2 = -F - 2 A E* a d delta/dt, A = mean of T_vis/nu^2 of the two grains, "
    law, source = law + "from delta = 0 to -delta_c", "A22 (5), (7)"
    questions = [
        asked("greatest overlap", when("overlap", "approach", before=end), overlap(c, top), "m", law, source),
        asked("time of the greatest overlap", when("time", "approach", before=end), turn, "s", law, source),
        asked("time of the break", flight(c.r1 + c.r2 + c.dc), broken, "s", law, source),
        asked("speed of separation", at(end, "approach"), v, "m/s", law, source),
    ]
    title = "A collision with drag in proportion to contact radius and velocity"
    return case("viscous-drag", title, "normal, viscous drag", {"scene": made}, questions)


# ---- a plane ----


def plane():
    c, speed, end, duration = contact(r2=inf), 8.0, 3e-9, 1e-8
    wall = dict(material="ice", normal=[1.0, 0.0, 0.0], position=[0.0, 0.0, 0.0])
    scene = lambda grain, **more: dict(grains=[grain], plane=wall, contact=constants(c), **more)
    falling_ = grain("ice", 1e-7, c.r1 + exact(GAP), along_x(-exact(speed)))
    made = scene(falling_, duration=end, steps=[6000, 12000, 24000])
    spin = [0.0, 0.0, rounded(exact(rounded(c.slide / c.r1 / 2, 3)) / exact(duration))]
    rolled = scene(grain("ice", 1e-7, c.r1 - c.d0), duration=duration, steps=[500, 1000, 2000])
    rolled["prescribed"] = [dict(until=duration, velocity=[REST], spin=[spin])]
    angle, limit = exact(spin[2]) * exact(duration), "grain and half-space: the limit r2 -> infinity of W07"
    shear, torque = c.ks * c.r1 * sin(angle), -(c.ks * c.r1**2 * sin(angle) * cos(angle) + c.kr * c.r1**2 * sin(angle))
    questions = collision_questions(c, speed, end) + [
        asked("force of a grain that turns in place", at(duration, "force1.y", "turned"), shear, "N",
              "k_s r sin theta, k_s of R = r", f"A22 (18); {limit}"),
        asked("torque on it", at(duration, "torque1.z", "turned"), torque, "N m",
              "-(k_s r^2 cos theta + k_r r^2) sin theta, k_r = 12 pi gamma", f"A22 (14), (18); {limit}"),
    ]  # fmt: skip
    title = "A grain and a half-space: collision, and the grain turned in place"
    return case("plane", title, "normal, plane", {"scene": made, "turned": rolled}, questions)
