# SPDX-License-Identifier: MIT
"""Sliding, rolling and twisting of two grains in contact, prescribed (closed forms) and free (integration)."""

from law import *
from normal_cases import pulled

TWO = contact()
X, AXES = vector(1, 0, 0), "xyz"
QUARTER, STEPS = 2e-9, [500, 1000, 2000]  # of a cycle of prescribed spins
POINTERS = "contact pointers turned with the grains: A24 (A1) to (A8)"
WORK = "2 (limit force) (slip each way)"


def unit(of):
    return "N" if of.startswith("force") else "N m"


def turning_rate(angle):
    """[rad/s], as in the file, for an angle in a quarter of a cycle, whose first twentieth is before the limit."""
    return rounded(exact(rounded(angle, 6)) / exact(QUARTER))


# ---- closed cycles of one mode: a scene and its questions ----


def cycle(name, c, law, before, limit, work, spins, delta=None, scene="scene", materials=("ice", "ice")):
    """A closed cycle, prescribed, and questions for components before and at the limit, and for its work.

    law: (formula, source); before, limit: {component: value}; spins: of the first quarter; delta: overlap, None: that
    of equilibrium.
    """
    made = pair(c, delta or c.d0, materials, duration=5 * QUARTER, steps=STEPS)
    ends = ((1, 1.0), (3, -1.0), (5, 1.0))  # forwards a quarter, backwards two, forwards two
    made["prescribed"] = [
        segment(rounded(k * exact(QUARTER), 6), **{grain: [sign * x for x in spin] for grain, spin in spins.items()})
        for k, sign in ends
    ]
    formula, source = law
    held = f"{formula}; held at the limit", f"{source}; W07"
    other, back = {of: -value for of, value in limit.items()}, rounded(3 * exact(QUARTER), 6)
    moments = [("before the limit", before, rounded(exact(QUARTER) / 20, 6), law)]
    moments += [("at the limit", limit, QUARTER, held), ("at the limit the other way", other, back, held)]
    questions = []
    for words, values, time, its_law in moments:
        for of, value in values.items():
            questions.append(asked(f"{of} of {name} {words}", at(time, of, scene), value, unit(of), *its_law))
    spent = dict(scene=scene, kind="work", after=QUARTER, before=5 * QUARTER)
    questions.append(asked(f"work of a closed cycle of {name}", spent, work, "J", WORK, f"{source}; W07"))
    return made, questions


def slid(c, delta=None, **where):
    total, distance = c.r1 + c.r2, c.r1 + c.r2 - (delta or c.d0)
    rate = turning_rate(6 * c.slide / total)
    end, small, least = exact(rate) * exact(QUARTER), exact(rate) * exact(QUARTER) / 20, asin(c.slide / total)
    full = sqrt(total**2 - c.slide**2)
    value = lambda z, zeta: {"force1.y": -c.ks * z * zeta / distance, "torque1.z": -c.r1 * c.ks * z * zeta / total}
    before, limit = value(total * cos(small), total * sin(small)), value(full, c.slide)
    work = 2 * c.ks * c.slide * full * (2 * end - 2 * least)
    formula = (
        "F = k_s z zeta/d, z = (r1 + r2) cos theta, zeta = (r1 + r2) sin theta, M1 = r1 k_s zeta cos theta, "
        "limit zeta_crit = (G'/G*) a0/(16 pi), (2 - nu) a0/(16 pi) for like materials"
    )
    law, spins = (formula, "A22 (18), (19); A24 (A1), (A5), (A8)"), dict(spin1=[0.0, 0.0, rate], spin2=[0.0, 0.0, rate])
    return cycle("sliding", c, law, before, limit, work, spins, delta, **where)


def rolled(c, delta=None, **where):
    rate = turning_rate(6 * c.roll / (2 * c.R))
    end, small, least = exact(rate) * exact(QUARTER), exact(rate) * exact(QUARTER) / 20, asin(c.roll / (2 * c.R))
    value = lambda theta: {"torque1.z": -c.R * c.kr * 2 * c.R * sin(theta) * cos(theta)}
    work = 2 * c.kr * c.roll * 2 * c.R * cos(least) * (2 * end - 2 * least)
    formula = "M = R k_r xi cos theta, xi = 2 R sin theta, k_r = 4 F_c/R, limit xi_crit"
    law, spins = (formula, "A22 (14); A24 (A2), (A6)"), dict(spin1=[0.0, 0.0, rate], spin2=[0.0, 0.0, -rate])
    return cycle("rolling", c, law, value(small), value(least), work, spins, delta, **where)


def twisted(c, delta=None, **where):
    rate = turning_rate(6 * c.twist)
    end, small = exact(rate) * exact(QUARTER), exact(rate) * exact(QUARTER) / 20
    value, work = lambda phi: {"torque1.x": -c.kt * phi}, 2 * c.kt * c.twist * (2 * end - 2 * c.twist)
    law = "M = k_t phi, k_t = (16/3) G' a0^3, limit phi_crit = 1/(16 pi)", "A22 (23), (24); A24 (A4), (A7)"
    return cycle("twisting", c, law, value(small), value(c.twist), work, dict(spin1=[rate, 0.0, 0.0]), delta, **where)


MODES = {"slid": slid, "rolled": rolled, "twisted": twisted}


def alone(name, scene_of, title):
    made, questions = scene_of(TWO)
    return case(name, f"{title}: stiffness, limit, work of a closed cycle", name, {"scene": made}, questions)


def sliding():
    return alone("sliding", slid, "Both grains turned the same way")


def rolling():
    return alone("rolling", rolled, "Grains turned opposite ways")


def twisting():
    return alone("twisting", twisted, "Grain 1 turned about the normal")


def all_modes(name, title, made, added):
    """Case of several scenes, {scene: (scene, questions)}; added: to each formula."""
    questions = [question for _, found in made.values() for question in found]
    for question in questions:
        question["formula"] += added
    scenes = {scene: of for scene, (of, _) in made.items()}
    return case(name, title, "normal, sliding, rolling, twisting", scenes, questions)


def under_load():
    title = "Sliding, rolling and twisting of grains pressed to three times the equilibrium overlap: "
    title += "stiffnesses and limits do not follow the load"
    made = {name: mode(TWO, 3 * TWO.d0, scene=name) for name, mode in MODES.items()}
    return all_modes("under-load", title, made, "; the same at every overlap but for d")


def unlike_materials():
    c, kinds = contact(name2="soft"), ("ice", "soft")
    made = {"pulled": pulled(c, 0.257660692708395, kinds, scene="pulled")}
    made |= {name: mode(c, scene=name, materials=kinds) for name, mode in MODES.items()}
    added = "; 1/E* = sum (1 - nu^2)/E, 1/G* = sum (2 - nu)/G, 1/G' = sum 1/G; gamma geometric, xi_crit arithmetic mean"
    return all_modes("unlike-materials", "Grains of two materials: every constant of the contact", made, added)


# ---- several springs at once, and slips whose direction turns ----


def all_components(c, n1, n2, phi, name, time, scene, law, axes=AXES):
    """Questions for every component of force and torques at a time, grains held at the equilibrium overlap."""
    force1, torque1, torque2 = springs(c, -X, c.r1 + c.r2 - c.d0, n1, n2, phi)
    found = []
    for of, vector in (("force1", force1), ("torque1", torque1), ("torque2", torque2)):
        for axis, value in zip(AXES, vector):
            if axis in axes and not (of == "force1" and axis == "x"):
                what = at(time, f"{of}.{axis}", scene)
                found.append(asked(f"{of}.{axis} {name}", what, value, unit(of), *law, size(vector)))
    return found


TURN, MIDWAY, END = 2e-9, 3e-9, 1.4e-8  # s
HELD = (
    "; held at the limit with its direction kept: at beta from y, tan((beta_v - beta)/2) = tan(beta_v/2) "
    "exp(-w t cot theta) at the time t after the turn, beta_v the way of the motion, sin theta = limit/"
)


def turned_slip(c, scene, limit, length, same):
    """A scene and its questions while the held displacement follows, and where it has.

    Both grains are turned the same way (or opposite ways), with a displacement of length sin(angle), to twice the limit
    along y, then by an axis turned by atan(4/3).
    """
    theta, rate = asin(limit / length), turning_rate(2 * limit / length)
    sign, (wy, wz) = 1 if same else -1, (rounded(exact(rate) * share) for share in (mpf("-0.8"), mpf("0.6")))
    made = pair(c, c.d0, duration=END, steps=[5600, 11200, 22400])
    spins = [dict(spin1=spin, spin2=[sign * w for w in spin]) for spin in ([0.0, 0.0, rate], [0.0, wy, wz])]
    made["prescribed"] = [segment(until, **spin) for until, spin in zip((TURN, END), spins)]
    wy, wz = exact(wy), exact(wz)
    way, decay = mp.atan2(-wy, wz), sqrt(wy**2 + wz**2) * cos(theta) / sin(theta)
    law, questions = (POINTERS + HELD + ("(r1 + r2)" if same else "(2 R)"), "A24; W07"), []
    for name, time in (("as its way turns", MIDWAY), ("after the turn", END)):
        beta = way - 2 * mp.atan(mp.tan(way / 2) * mp.exp(-decay * (exact(time) - exact(TURN))))
        n1 = vector(cos(theta), sin(theta) * cos(beta), sin(theta) * sin(beta))
        n2 = -vector(1, sign, sign) * n1
        questions += all_components(c, n1, n2, 0, f"of {scene} {name}", time, scene, law, "yz")
    for question in questions:
        if question["measure"]["at"] == MIDWAY:
            question["order"] = 1
    return made, [q for q in questions if float(q["value"]) and "torque2" not in q["name"]]  # grain 2 is a mirror image


def turning_slip():
    slides, slid_ = turned_slip(TWO, "sliding", TWO.slide, TWO.r1 + TWO.r2, True)
    rolls, rolled_ = turned_slip(TWO, "rolling", TWO.roll, 2 * TWO.R, False)
    title, scenes = "A slip whose direction turns: the limit is a circle", {"sliding": slides, "rolling": rolls}
    return case("turning-slip", title, "sliding, rolling", scenes, slid_ + rolled_)


def both_ways(c, scene, moved="W07"):
    """Grain 1 turned alone: within the limits, and until sliding and rolling are both at theirs."""
    made, rate = pair(c, c.d0, duration=QUARTER, steps=STEPS), turning_rate(40 * c.slide / c.r1)
    made["prescribed"], early = [segment(QUARTER, spin1=[0.0, 0.0, rate])], rounded(exact(QUARTER) / 100, 6)
    n1 = turned(X, vector(0, 0, exact(rate) * exact(early)))
    questions = all_components(c, n1, -X, 0, "within the limits", early, scene, (POINTERS, "A24"), "yz")
    # angles about z by which the pointers are turned at both limits
    apart = 2 * asin(c.roll / (2 * c.R))
    excess = lambda angle: (c.r1 * sin(angle) + c.r2 * sin(angle - apart) - c.slide) / c.slide
    angle = mp.findroot(excess, apart / 2)
    n1, n2 = turned(X, vector(0, 0, angle)), turned(-X, vector(0, 0, angle - apart))
    law = POINTERS + "; |zeta| = zeta_crit and |xi| = xi_crit", f"A24; {moved}"
    questions += all_components(c, n1, n2, 0, "at both limits", QUARTER, scene, law, "yz")
    return made, [q for q in questions if float(q["value"])]


def two_at_once():
    c = TWO
    made, questions = both_ways(c, "planar")
    spins = [[turning_rate(k * c.slide / c.r1) for k in parts] for parts in ((9.0, 4.0, 6.0), (-7.0, 3.0, -2.0))]
    space = pair(c, c.d0, duration=QUARTER, steps=STEPS)
    space["prescribed"], early = [segment(QUARTER, spin1=spins[0], spin2=spins[1])], rounded(exact(QUARTER) / 20, 6)
    angles = [vector(*spin) * exact(early) for spin in spins]
    n1, n2, phi = turned(X, angles[0]), turned(-X, angles[1]), angles[1][0] - angles[0][0]
    name, law = "of all three within the limits", (POINTERS, "A24")
    questions += all_components(c, n1, n2, phi, name, early, "space", law)
    title = "Two and three at once: sliding and rolling held at both limits; all three springs within theirs"
    return case("two-at-once", title, "sliding, rolling, twisting", {"planar": made, "space": space}, questions)


def unlike_radii():
    made, questions = both_ways(contact(r2=2.5e-7), "scene", "W07 with the moves of README.md")
    title = "Grains of 0.1 and 0.25 um, the smaller one turned"
    return case("unlike-radii", title, "sliding, rolling", {"scene": made}, questions)


# ---- a free pair ----


def free_rate(c):
    """Rates of (x, v, w1, w2, n1, n2, phi) of a free pair of equal grains, x and v of grain 1 less grain 2; no slip."""
    inertia = mpf(2) / 5 * c.m1 * c.r1**2

    def rate(_, y):
        (x, v, w1, w2, n1, n2), phi = y[:18].reshape(6, 3), y[18]
        n = x / size(x)
        tangential, torque1, torque2 = springs(c, n, size(x), n1, n2, phi)
        push = force(c, radius_root(c, c.r1 + c.r2 - size(x)))
        acceleration = (push * n + tangential) / c.m
        turning = torque1 / inertia, torque2 / inertia, np.cross(w1, n1), np.cross(w2, n2)
        return np.concatenate([v, acceleration, *turning, [(w1 - w2) @ n]])

    return rate


def free_rotation():
    c, end, speed, spins = TWO, 4e-9, 15.0, [[2.5e6, 1.2e7, 1.58e8], [-4e6, 5e6, 1.46e8]]
    first = grain("ice", 1e-7, 0, [0.0, -speed, 1.0], spins[0])
    second = grain("ice", 1e-7, c.r1 + c.r2 - c.d0, [0.0, speed, -1.0], spins[1])
    made = dict(grains=[first, second], contact=constants(c), duration=end, steps=[4000, 8000, 16000])
    x, v, w1, w2 = -vector(*second["position"]), -2 * vector(*second["velocity"]), *(vector(*spin) for spin in spins)
    y, step = np.concatenate([x, v, w1, w2, X, -X, [mpf(0)]]), exact(end) / 40
    for k in range(40):
        y = integrate(free_rate(c), k * step, (k + 1) * step, y, 1, columns=9)
    law = "F = F_n n_c + F_s, torques: springs of pointers that turn with the grains; integrated"
    law, questions = (law, "A22 (5); A24 (A1) to (A8)"), []
    position2, velocity2 = -(y[0:3] + x) / 2, -y[3:6] / 2  # the centre of mass rests at half of the first distance
    scales = {
        "position2": size(y[0:3]) / 2,
        "velocity2": size(velocity2),
        "spin1": size(y[6:9]),
        "spin2": size(y[9:12]),
    }
    ends = (("m", position2), ("m/s", velocity2), ("rad/s", y[6:9]), ("rad/s", y[9:12]))
    for (of, scale), (unit_, values) in zip(scales.items(), ends):
        for axis, value in zip(AXES, values):
            questions.append(asked(f"{of}.{axis} at the end", at(end, f"{of}.{axis}"), value, unit_, *law, scale))
    momentum = mpf(2) / 5 * c.m1 * c.r1**2 * (w1 + w2) + c.m * np.cross(x, v)
    law = "conserved: sum of m x v + I w about the centre of mass", "A24 (A5) to (A8)", size(momentum)
    for axis, value in zip(AXES, momentum):
        what = at(end, f"angular_momentum.{axis}")
        questions.append(asked(f"angular momentum {axis}", what, value, "kg m2/s", *law))
    law = "conserved: springs within their limits", "A22 (8), A24", c.Fc * c.dc
    questions.append(asked("change of the energy", channel("total", end), mpf(0), "J", *law))
    title = "A free pair that turns in space while all its springs swing: trajectory, energy and angular momentum"
    return case("free-rotation", title, "normal, sliding, rolling, twisting", {"scene": made}, questions)


# ---- free grains that slip ----

WAYS = ((1, 0, 0), (0.8, 0.6, 0), (0.6, 0, 0.8), (0.8, -0.6, 0), (0.6, 0, -0.8))  # from each grain to the next


def returned(n1, n2, displacement, limit, way1, way2):
    """Pointers (5, 3) of which displacements (5, 3) beyond their limit return to it, as README.md has it."""
    size = np.linalg.norm(displacement, axis=1, keepdims=True)
    e, excess = displacement / np.maximum(size, 1e-300), np.maximum(size - limit, 0)
    for n, way in ((n1, way1), (n2, way2)):
        moved = n - excess / way / (1 - (n * e).sum(axis=1, keepdims=True) ** 2) * e
        yield moved / np.linalg.norm(moved, axis=1, keepdims=True)


def after_the_hit(c, x, v, duration, steps):
    """Positions (6, 3) of a chain of like grains at x, without contact forces, with velocities v: by leapfrog, in
    doubles, with springs that are returned to their limits after each step."""
    c = SimpleNamespace(**{name: float(number) for name, number in vars(c).items()})
    h, w, inertia = duration / steps, 0 * v, 0.4 * c.m1 * c.r1**2
    F, M, turn = 0 * v, 0 * v, lambda n, angle: n + np.cross(angle, n + np.cross(angle, n) / 2)
    n = (x[:-1] - x[1:]) / np.linalg.norm(x[:-1] - x[1:], axis=1, keepdims=True)
    n1, n2, phi = -n, n, np.zeros((5, 1))
    for _ in range(steps):
        v, w = v + h / 2 * F / c.m1, w + h / 2 * M / inertia
        x, n1, n2, before = x + h * v, turn(n1, h * w[:-1]), turn(n2, h * w[1:]), n
        distance = np.linalg.norm(x[:-1] - x[1:], axis=1, keepdims=True)
        n = (x[:-1] - x[1:]) / distance
        phi = phi + h * ((w[:-1] - w[1:]) * (before + n) / 2).sum(axis=1, keepdims=True)
        phi = np.clip(phi, -c.twist, c.twist)
        zeta, xi, _ = displacements(c, n, n1, n2)
        rolls = np.linalg.norm(xi, axis=1, keepdims=True) > c.roll
        n1, n2 = returned(n1, n2, zeta, c.slide, c.r1 + c.r2, -c.r1 - c.r2)
        n1, n2 = returned(n1, n2, np.where(rolls, displacements(c, n, n1, n2)[1], 0), c.roll, c.r1, c.r2)
        delta, u, F, M = c.r1 + c.r2 - distance, 1.0, 0 * v, 0 * v
        assert np.all(delta > -c.dc) and np.all(np.linalg.norm(x[:-2] - x[2:], axis=1) > 2 * c.r1)
        for _ in range(9):
            u = u - (3 * u**4 - 2 * u - delta / c.d0) / (12 * u**3 - 2)
        sliding, M[:-1], torque2 = springs(c, n, distance, n1, n2, phi)
        F[:-1], M[1:] = sliding + force(c, u) * n, M[1:] + torque2
        F[1:] -= sliding + force(c, u) * n
        v, w = v + h / 2 * F / c.m1, w + h / 2 * M / inertia
    return x


def chain():
    c, speed = contact("silicate", 6e-7, "silicate", 6e-7), (0, 0.6, 0.8)
    x = np.array([[rounded(mpf(s) * (2 * c.r1 - c.d0)) for s in row] for row in np.cumsum([(0, 0, 0), *WAYS], axis=0)])
    v, duration = np.zeros((6, 3)), rounded(30 * c.t0, 6)
    v[0] = speed
    grains = [dict(grain("silicate", 6e-7), position=at, velocity=by) for at, by in zip(x.tolist(), v.tolist())]
    made = dict(grains=grains, contact=constants(c), duration=duration, steps=[1200, 2400, 4800])
    law = "springs that slip while grains move freely; leapfrog, 15,000 steps, to 1e-8 r", "A22, A24; W07"
    questions = [
        asked(f"position{k}.{axis} after 30 t0", at(duration, f"position{k}.{axis}"), value, "m", *law, c.r1)
        for k, row in enumerate(after_the_hit(c, x, v, duration, 15_000), 1)
        for axis, value in zip(AXES, row)
    ]
    title = "A bent chain of six grains hit across at 1 m/s: sliding and rolling at their limits while all move freely"
    return case("chain", title, "normal, sliding, rolling, twisting", {"scene": made}, questions)
