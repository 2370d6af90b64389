# SPDX-License-Identifier: MIT
"""Sliding, rolling and twisting of two grains in contact, prescribed (closed forms) and free (integration)."""

from integration import integrate
from law import *
from normal_cases import ICE, pulled
from questions import asked, at, case, constants, grain, pair, segment, to_and_fro

X, AWAY, AXES = [mpf(1), mpf(0), mpf(0)], [mpf(-1), mpf(0), mpf(0)], "xyz"
QUARTER, STEPS = 2e-9, [500, 1000, 2000]  # of a cycle of prescribed spins
POINTERS = "contact pointers turned with the grains: A24 (A1) to (A8)"


def cycle(c, name, formula, source, first, limit, work, spins, materials=("ice", "ice"), scene="scene", delta=None):
    """Scene of prescribed spins (spin1, spin2 of the first quarter) with a closed cycle, at an overlap (None: that of
    equilibrium), and its questions: components before and at the limit, {component: value} each, and the work of the cycle."""
    made = pair(c, delta or c.d0, materials, duration=5 * QUARTER, steps=STEPS)
    made["prescribed"] = to_and_fro(QUARTER, **spins)
    early = rounded(exact(QUARTER) / 20, 6)
    questions = [asked(f"{of} of {name} before the limit", at(early, of, scene), value, unit(of), formula, source) for of, value in first.items()]  # fmt: skip
    questions += [asked(f"{of} of {name} at the limit", at(QUARTER, of, scene), value, unit(of), f"{formula}; held at the limit", f"{source}; W07") for of, value in limit.items()]  # fmt: skip
    spent = dict(scene=scene, kind="work", after=QUARTER, before=5 * QUARTER)
    questions.append(asked(f"work of a closed cycle of {name}", spent, work, "J", "2 (limit force) (slip each way)", f"{source}; W07"))  # fmt: skip
    return made, questions


def unit(of):
    return "N" if of.startswith("force") else "N m"


def turning_rate(angle):
    """[rad/s], as it stands in the file, for an angle in a quarter, of which a twentieth is before the limit."""
    return rounded(exact(rounded(angle, 6)) / exact(QUARTER))


def slid(c, materials=("ice", "ice"), scene="scene", delta=None):
    total, distance = c.r1 + c.r2, c.r1 + c.r2 - (delta or c.d0)
    rate = turning_rate(6 * c.slide / total)
    end, small, least = exact(rate) * exact(QUARTER), exact(rate) * exact(QUARTER) / 20, asin(c.slide / total)
    full = sqrt(total**2 - c.slide**2)
    value = lambda z, zeta: {"force1.y": -c.ks * z * zeta / distance, "torque1.z": -c.r1 * c.ks * z * zeta / total}
    first, limit = value(total * cos(small), total * sin(small)), value(full, c.slide)
    work = 2 * c.ks * c.slide * full * (2 * end - 2 * least)
    spins = dict(spin1=[0.0, 0.0, rate], spin2=[0.0, 0.0, rate])
    formula = "F = k_s z zeta/d, z = (r1 + r2) cos theta, zeta = (r1 + r2) sin theta, M1 = r1 k_s zeta cos theta, limit zeta_crit = (G'/G*) a0/(16 pi), (2 - nu) a0/(16 pi) for like materials"  # fmt: skip
    return cycle(c, "sliding", formula, "A22 (18), (19); A24 (A1), (A5), (A8)", first, limit, work, spins, materials, scene, delta)  # fmt: skip


def rolled(c, materials=("ice", "ice"), scene="scene", delta=None):
    rate = turning_rate(6 * c.roll / (2 * c.R))
    end, small, least = exact(rate) * exact(QUARTER), exact(rate) * exact(QUARTER) / 20, asin(c.roll / (2 * c.R))
    value = lambda theta: {"torque1.z": -c.R * c.kr * 2 * c.R * sin(theta) * cos(theta)}
    work = 2 * c.kr * c.roll * 2 * c.R * cos(least) * (2 * end - 2 * least)
    spins = dict(spin1=[0.0, 0.0, rate], spin2=[0.0, 0.0, -rate])
    formula = "M = R k_r xi cos theta, xi = 2 R sin theta, k_r = 4 F_c/R, limit xi_crit"
    return cycle(c, "rolling", formula, "A22 (14); A24 (A2), (A6)", value(small), value(least), work, spins, materials, scene, delta)  # fmt: skip


def twisted(c, materials=("ice", "ice"), scene="scene", delta=None):
    rate = turning_rate(6 * c.twist)
    end, small = exact(rate) * exact(QUARTER), exact(rate) * exact(QUARTER) / 20
    work = 2 * c.kt * c.twist * (2 * end - 2 * c.twist)
    spins, value = dict(spin1=[rate, 0.0, 0.0]), lambda phi: {"torque1.x": -c.kt * phi}
    formula = "M = k_t phi, k_t = (16/3) G' a0^3, limit phi_crit = 1/(16 pi)"
    return cycle(c, "twisting", formula, "A22 (23), (24); A24 (A4), (A7)", value(small), value(c.twist), work, spins, materials, scene, delta)  # fmt: skip


def sliding():
    return alone("sliding", slid, "Both grains turned the same way: stiffness, limit, work of a closed cycle")


def rolling():
    return alone("rolling", rolled, "Grains turned opposite ways: stiffness, limit, work of a closed cycle")


def twisting():
    return alone("twisting", twisted, "Grain 1 turned about the normal: stiffness, limit, work of a closed cycle")


def alone(name, scene_of, title):
    made, questions = scene_of(ICE)
    return case(name, title, [name], {"scene": made}, questions)


def under_load():
    c, scenes, questions = ICE, {}, []
    for name, scene_of in (("slid", slid), ("rolled", rolled), ("twisted", twisted)):
        scenes[name], found = scene_of(c, scene=name, delta=3 * c.d0)
        questions += found
    for question in questions:
        question["formula"] += "; the same at every overlap but for d"
    title = "Sliding, rolling and twisting of grains pressed to three times the equilibrium overlap: stiffnesses and limits do not follow the load"  # fmt: skip
    return case("under-load", title, ["normal", "sliding", "rolling", "twisting"], scenes, questions)


TURN, MIDWAY, END = 2e-9, 3e-9, 1.4e-8  # s


def turned_slip(c, scene, limit, length, same):
    """Both grains turned the same way (or opposite ways), with a displacement of length sin(angle), to twice the limit along y,
    then by an axis turned by atan(4/3); questions while the held displacement follows, and where it has."""
    theta, rate = asin(limit / length), turning_rate(2 * limit / length)
    sign, (wy, wz) = 1 if same else -1, (rounded(exact(rate) * share) for share in (mpf("-0.8"), mpf("0.6")))
    made = pair(c, c.d0, duration=END, steps=[5600, 11200, 22400])
    spins = [dict(spin1=spin, spin2=[sign * w for w in spin]) for spin in ([0.0, 0.0, rate], [0.0, wy, wz])]
    made["prescribed"] = [segment(until, **spin) for until, spin in zip((TURN, END), spins)]
    wy, wz = exact(wy), exact(wz)
    way, decay = mp.atan2(-wy, wz), sqrt(wy**2 + wz**2) * cos(theta) / sin(theta)
    formula = f"{POINTERS}; held at the limit with its direction kept: at beta from y, tan((beta_v - beta)/2) = tan(beta_v/2) exp(-w t cot theta) at the time t after the turn, beta_v the way of the motion, sin theta = limit/{'(r1 + r2)' if same else '(2 R)'}"  # fmt: skip
    questions = []
    for name, time in (("as its way turns", MIDWAY), ("after the turn", END)):
        beta = way - 2 * mp.atan(mp.tan(way / 2) * mp.exp(-decay * (exact(time) - exact(TURN))))
        n1 = [cos(theta), sin(theta) * cos(beta), sin(theta) * sin(beta)]
        n2 = [-n1[0], *(-sign * x for x in n1[1:])]
        questions += all_components(c, n1, n2, 0, f"of {scene} {name}", time, scene, formula, "A24; W07", "yz")
    for question in questions:
        if question["measure"]["at"] == MIDWAY:
            question["order"] = 1
    return made, [q for q in questions if float(q["value"]) and "torque2" not in q["name"]]  # grain 2 is a mirror image


def turning_slip():
    slides, slid_ = turned_slip(ICE, "sliding", ICE.slide, ICE.r1 + ICE.r2, True)
    rolls, rolled_ = turned_slip(ICE, "rolling", ICE.roll, 2 * ICE.R, False)
    title = "A slip whose direction turns: the limit is a circle"
    return case("turning-slip", title, ["sliding", "rolling"], {"sliding": slides, "rolling": rolls}, slid_ + rolled_)


def at_both_limits(c):
    """Angles (theta1, theta2) about z by which the pointers are turned when sliding and rolling are both at their limits."""
    apart = 2 * asin(c.roll / (2 * c.R))
    excess = lambda theta: (c.r1 * sin(theta) + c.r2 * sin(theta - apart) - c.slide) / c.slide
    theta1 = mp.findroot(excess, apart / 2)
    return theta1, theta1 - apart


def all_components(c, n1, n2, phi, name, time, scene, formula, source, axes=AXES):
    """Questions for every component of force and torques at a time, grains held at the equilibrium overlap."""
    force, torque1, torque2 = springs(c, AWAY, c.r1 + c.r2 - c.d0, n1, n2, phi)
    found = []
    for of, vector in (("force1", force), ("torque1", torque1), ("torque2", torque2)):
        for k, axis in enumerate(AXES):
            if axis in axes and not (of == "force1" and axis == "x"):
                scale = sqrt(dot(vector, vector))
                found.append(asked(f"{of}.{axis} {name}", at(time, f"{of}.{axis}", scene), vector[k], unit(of), formula, source, scale))  # fmt: skip
    return found


def both_ways(c, scene):
    """Grain 1 turned alone: within the limits, and until sliding and rolling are both at theirs."""
    made, rate = pair(c, c.d0, duration=QUARTER, steps=STEPS), turning_rate(40 * c.slide / c.r1)
    made["prescribed"], early = [segment(QUARTER, spin1=[0.0, 0.0, rate])], rounded(exact(QUARTER) / 100, 6)
    n1 = turned(X, [mpf(0), mpf(0), exact(rate) * exact(early)])
    questions = all_components(c, n1, AWAY, 0, "within the limits", early, scene, POINTERS, "A24", "yz")
    theta1, theta2 = at_both_limits(c)
    n1, n2 = (turned(v, [mpf(0), mpf(0), theta]) for v, theta in ((X, theta1), (AWAY, theta2)))
    formula = POINTERS + "; |zeta| = zeta_crit and |xi| = xi_crit"
    return made, [q for q in questions + all_components(c, n1, n2, 0, "at both limits", QUARTER, scene, formula, "A24; W07", "yz") if float(q["value"])]  # fmt: skip


def two_at_once():
    c = ICE
    made, questions = both_ways(c, "planar")
    spins = [[turning_rate(part * c.slide / c.r1) for part in parts] for parts in ((9.0, 4.0, 6.0), (-7.0, 3.0, -2.0))]
    space = pair(c, c.d0, duration=QUARTER, steps=STEPS)
    space["prescribed"], early = [segment(QUARTER, spin1=spins[0], spin2=spins[1])], rounded(exact(QUARTER) / 20, 6)
    angles = [[exact(w) * exact(early) for w in spin] for spin in spins]
    n1, n2, phi = turned(X, angles[0]), turned(AWAY, angles[1]), angles[1][0] - angles[0][0]
    check_limits(c, AWAY, n1, n2, phi)
    questions += all_components(c, n1, n2, phi, "of all three within the limits", early, "space", POINTERS, "A24")
    title = "Two and three at once: sliding and rolling held at both limits; all three springs within theirs"
    return case("two-at-once", title, ["sliding", "rolling", "twisting"], {"planar": made, "space": space}, questions)


def unlike_radii():
    made, questions = both_ways(contact("ice", 1e-7, "ice", 2.5e-7), "scene")
    for question in questions:
        question["source"] = question["source"].replace("W07", "W07 with the moves of README.md")
    title = "Grains of 0.1 and 0.25 um, the smaller one turned"
    return case("unlike-radii", title, ["sliding", "rolling"], {"scene": made}, questions)


def unlike_materials():
    kinds = ("ice", "soft")
    c, scenes, questions = contact(kinds[0], 1e-7, kinds[1], 1e-7), {}, []
    for name, scene_of in (("pulled", pulled), ("slid", slid), ("rolled", rolled), ("twisted", twisted)):
        scenes[name], found = scene_of(c, kinds, scene=name)
        questions += found
    for question in questions:
        question["formula"] += "; 1/E* = sum (1 - nu^2)/E, 1/G* = sum (2 - nu)/G, 1/G' = sum 1/G; gamma geometric, xi_crit arithmetic mean"  # fmt: skip
    title = "Grains of two materials: every constant of the contact"
    return case("unlike-materials", title, ["normal", "sliding", "rolling", "twisting"], scenes, questions)


# ---- a free pair ----


def check_limits(c, n, n1, n2, phi):
    """Springs must be well within their limits."""
    zeta, xi, _ = displacements(c, n, n1, n2)
    shares = sqrt(dot(zeta, zeta)) / c.slide, sqrt(dot(xi, xi)) / c.roll, abs(phi) / c.twist
    assert max(shares) < mpf("0.9"), f"beyond its limits: {[float(s) for s in shares]}"


def free_rate(c):
    """Rates of (x, v, w1, w2, n1, n2, phi) of a free pair of equal grains, x and v of grain 1 less grain 2; no slip."""
    inertia = mpf(2) / 5 * c.m1 * c.r1**2

    def rate(_, y):
        x, v, w1, w2, n1, n2, phi = y[0:3], y[3:6], y[6:9], y[9:12], y[12:15], y[15:18], y[18]
        distance = sqrt(dot(x, x))
        n = [k / distance for k in x]
        tangential, torque1, torque2 = springs(c, n, distance, n1, n2, phi)
        push = force_at(c, c.r1 + c.r2 - distance)
        acceleration = [(push * a + b) / c.m for a, b in zip(n, tangential)]
        turns = [[t / inertia for t in torque] for torque in (torque1, torque2)]
        spin = dot(combined((1, w1), (-1, w2)), n)
        return [*v, *acceleration, *turns[0], *turns[1], *cross(w1, n1), *cross(w2, n2), spin]

    return rate


def free_rotation():
    c, end, speed = ICE, 4e-9, 15.0
    spins = [[2.5e6, 1.2e7, 1.58e8], [-4e6, 5e6, 1.46e8]]
    first, second = grain("ice", 1e-7, 0, [0.0, -speed, 1.0], spins[0]), grain("ice", 1e-7, c.r1 + c.r2 - c.d0, [0.0, speed, -1.0], spins[1])  # fmt: skip
    made = dict(grains=[first, second], contact=constants(c), duration=end, steps=[4000, 8000, 16000])
    x, v = [-exact(second["position"][0]), mpf(0), mpf(0)], [mpf(0), -2 * exact(speed), mpf(2)]
    w1, w2 = ([exact(w) for w in spin] for spin in spins)
    y, step = [*x, *v, *w1, *w2, *X, *AWAY, mpf(0)], exact(end) / 40
    for k in range(40):
        y = integrate(free_rate(c), k * step, (k + 1) * step, y, step)
        check_limits(c, [a / sqrt(dot(y[:3], y[:3])) for a in y[:3]], y[12:15], y[15:18], y[18])
    formula = "F = F_n n_c + F_s, torques: springs of pointers that turn with the grains; integrated"
    questions = []
    for of, vector, unit_, factor in (("position2", y[0:3], "m", -mpf(1) / 2), ("velocity2", y[3:6], "m/s", -mpf(1) / 2), ("spin1", y[6:9], "rad/s", 1), ("spin2", y[9:12], "rad/s", 1)):  # fmt: skip
        scale = sqrt(dot(vector, vector)) * abs(factor)
        middle = x if of == "position2" else [mpf(0)] * 3  # the centre of mass rests at half of the first distance
        for k, axis in enumerate(AXES):
            value = factor * vector[k] - middle[k] / 2
            questions.append(asked(f"{of}.{axis} at the end", at(end, f"{of}.{axis}"), value, unit_, formula, "A22 (5); A24 (A1) to (A8)", scale))  # fmt: skip
    spin, orbit = combined((1, w1), (1, w2)), cross(x, v)
    momentum = combined((mpf(2) / 5 * c.m1 * c.r1**2, spin), (c.m, orbit))
    for k, axis in enumerate(AXES):
        size = sqrt(dot(momentum, momentum))
        questions.append(asked(f"angular momentum {axis}", at(end, f"angular_momentum.{axis}"), momentum[k], "kg m2/s", "conserved: sum of m x v + I w about the centre of mass", "A24 (A5) to (A8)", size))  # fmt: skip
    questions.append(asked("change of the energy", dict(scene="scene", kind="channel", of="total", at=end), mpf(0), "J", "conserved: springs within their limits", "A22 (8), A24", c.Fc * c.dc))  # fmt: skip
    title = "A free pair that turns in space while all its springs swing: trajectory, energy and angular momentum"
    return case("free-rotation", title, ["normal", "sliding", "rolling", "twisting"], {"scene": made}, questions)
