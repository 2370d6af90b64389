"""The contact law of contact_law/MODEL.md once more, in plain Python, to be read beside the papers.

It shares nothing with the plugin, has its constants from analysis.theory, and is slow.
tests/equivalence/test_reference_law.py holds functors and engine to it. A22, A24: Arakawa et al. 2022, 2024; K13:
Kataoka et al. 2013; S17: Sirono & Ueno 2017; W07: Wada et al. 2007. SI units; vectors are arrays (3,). Of a contact:
grains 1 and 2, n the unit vector from 2 to 1, delta the overlap.
"""

from dataclasses import replace
from math import pi, sqrt
from types import SimpleNamespace

import numpy as np

from analysis import theory

MODES = ("normal", "sliding", "rolling", "twisting")
LOST = tuple(f"{mode}Dissipation" for mode in MODES[1:]) + (
    "connection",
    "disconnection",
    "drag",
    "springDamping",
    "bondBreaking",
)


def cross(a, b):
    return np.array([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])


def turned(v, angle):
    """v turned by |angle| about angle [rad]: Rodrigues' formula."""
    size = sqrt(angle @ angle)
    if size == 0:
        return v
    axis = angle / size
    return v + np.sin(size) * cross(axis, v) + 2 * np.sin(size / 2) ** 2 * cross(axis, cross(axis, v))


# ---- constants and normal motion, from analysis.theory; m1, m2: theory.Material ----


def pair(m1, r1, m2, r2, beta, damping=0, sliding_factor=1, rolling_factor=1, spring_damping=0, mixed_factor=1):
    """Constants of a contact of grains with radii r1, r2, which necks (beta) have shrunk at constant mass."""
    s = theory.shrunk_radius(beta)
    m1, m2 = (replace(m, density=m.density / s**3) for m in (m1, m2))
    of_springs = sliding_factor, rolling_factor, spring_damping
    c = theory.pair_constants(m1, s * r1, m2, s * r2, damping, *of_springs, mixed_factor)
    of_springs = dict(r1=s * r1, r2=s * r2, R=c.reduced_radius)
    of_springs |= dict(ks=c.sliding_stiffness, kr=c.rolling_stiffness, kt=c.twisting_stiffness)
    limits = dict(zeta_crit=c.critical_sliding, xi_crit=c.critical_rolling, phi_crit=c.critical_twisting)
    normal = dict(d0=c.equilibrium_overlap, dc=c.pull_off_overlap, Fc=c.pull_off_force)
    drag = dict(viscous=c.drag_per_contact_radius, damping=c.linear_drag, springs=c.spring_damping)
    return SimpleNamespace(**of_springs, **limits, **normal, **drag, a0=c.equilibrium_contact_radius)


def bond(m1, r1, m2, r2, beta, mixed_factor=1):
    """Constants of a sintered bond of grains with radii r1, r2 before sintering."""
    b = theory.bond_constants(m1, r1, beta, m2, r2, mixed_factor)
    of_springs = dict(r1=r1, r2=r2, R=r1 * r2 / (r1 + r2))
    of_springs |= dict(ks=b.sliding_stiffness, kr=b.rolling_stiffness, kt=b.twisting_stiffness)
    return SimpleNamespace(**of_springs, kn=b.normal_stiffness, breaking=b.breaking_energy)


U_AT_CONNECTION, U_AT_PULL_OFF = -8 / 15 * 2 ** (2 / 3), 4 / 45  # A22 (9), (10), in F_c delta_c


def jkr(c, delta):
    """(contact radius, force, energy) at an overlap: A22 (2), (5), (8)."""
    u = float(theory.contact_radius_root(delta / c.d0))
    energy = 4 * 6 ** (1 / 3) * (4 / 5 * u**10 - 4 / 3 * u**7 + u**4 / 3)
    return c.a0 * u**2, c.Fc * 4 * (u**6 - u**3), c.Fc * c.dc * energy


def missed_at_pull_off(g, terms=8):
    """Trapezoidal sum less integral of x^(1/2) over x = g, g + 1, g + 2, ...: Euler-Maclaurin's remainder after some
    terms. With the plugin's eight it is exact to 1e-8."""
    x = g + np.arange(terms + 1)
    total = np.sqrt(x).sum() - (sqrt(g) + sqrt(x[-1])) / 2 - 2 / 3 * (x[-1] ** 1.5 - g**1.5)
    return total - x[-1] ** -0.5 / 24 + x[-1] ** -2.5 / 1920


# ---- springs (W07, A24 appendix A), of a contact or a bond; p: a contact now, with pointers n1, n2 and twist phi ----


def displacements(c, p):
    """(zeta, xi), A24 (A1), (A2)."""
    zeta0 = c.r1 * p.n1 - c.r2 * p.n2
    return zeta0 - (zeta0 @ p.n) * p.n, c.R * (p.n1 + p.n2)


def springs(c, p):
    """Force on grain 1 and torques on both: A24 (A5)-(A8)."""
    zeta, xi = displacements(c, p)
    z = (c.r1 * p.n1 - c.r2 * p.n2) @ p.n
    torque1 = -c.r1 * c.ks * cross(p.n1, zeta) - c.R * c.kr * cross(p.n1, xi) - c.kt * p.phi * p.n
    torque2 = c.r2 * c.ks * cross(p.n2, zeta) - c.R * c.kr * cross(p.n2, xi) + c.kt * p.phi * p.n
    return c.ks * z * zeta / p.distance, torque1, torque2


def move(p, displacement, limit, radius1, radius2):
    """W07: pointers moved by the excess over a limit, each lengthened by 1/(1 - (n.e)^2) and of length 1 again."""
    size = sqrt(displacement @ displacement)
    e = displacement / size
    moved = [n - (size - limit) / r / (1 - (n @ e) ** 2) * e for n, r in ((p.n1, radius1), (p.n2, radius2))]
    p.n1, p.n2 = (n / sqrt(n @ n) for n in moved)


def return_to_limits(c, p, before, dt, lost):
    """Displacements beyond their limits return to them: twisting, then sliding, then rolling. Books what that
    dissipates."""
    phi, p.phi = p.phi, min(max(p.phi, -c.phi_crit), c.phi_crit)
    if dt:
        p.slipped[1] += (phi - p.phi) / dt * p.n
    lost["twistingDissipation"] += c.kt / 2 * (before.phi + p.phi) * (phi - p.phi)
    trial1, trial2, (zeta, xi) = p.n1, p.n2, displacements(c, p)
    slid, rolled = zeta @ zeta > c.zeta_crit**2, xi @ xi > c.xi_crit**2
    if slid:
        move(p, zeta, c.zeta_crit, c.r1 + c.r2, -(c.r1 + c.r2))
    if rolled:
        move(p, displacements(c, p)[1], c.xi_crit, c.r1, c.r2)
    if not (slid or rolled):
        return
    d1, d2 = p.n1 - trial1, p.n2 - trial2
    zeta_now, xi_now = displacements(c, p)
    if dt:
        p.slipped += [(zeta - zeta_now) / dt, cross(xi - xi_now, p.n) / (c.R * dt)]
    n_rate = (p.v - (p.v @ p.n) * p.n) / p.distance
    zeta_rate = c.r1 * cross(p.w1, d1) - c.r2 * cross(p.w2, d2) - ((c.r1 * d1 - c.r2 * d2) @ p.n) * n_rate
    xi_rate = c.R * (cross(p.w1, d1) + cross(p.w2, d2))
    sliding = c.ks / 2 * ((before.zeta + zeta_now) @ (zeta - zeta_now) + dt * zeta_now @ zeta_rate)
    rolling = c.kr / 2 * ((before.xi + xi_now) @ (xi - xi_now) + dt * xi_now @ xi_rate)
    lost["slidingDissipation"] += sliding if slid and rolled else sliding + rolling if slid else 0
    lost["rollingDissipation"] += rolling if slid and rolled else sliding + rolling if rolled else 0


# ---- damping of springs (MODEL.md, "Damped springs"); rates: of zeta, and of grains turning against each other ----


def straining(c, p, dt):
    """The grains' motion through a step as rates, and the normal half-way through it."""
    distance = p.distance / (1 + dt / 2 * p.v @ p.n / p.distance)
    n = p.n - (p.v - (p.v @ p.n) * p.n) * dt / 2 / p.distance
    across = (c.r1 + c.r2) / distance * (p.v - (p.v @ n) * n)
    return np.array([across - cross(c.r1 * p.w1 + c.r2 * p.w2, n), p.w1 - p.w2]), n


AT_REST = SimpleNamespace(rates=np.zeros((2, 3)), rates_now=np.zeros((2, 3)))


def powers(c, n, a, b):
    """By springs, sliding, rolling and twisting."""
    twist = (a[1] @ n) * (b[1] @ n)
    return np.array([c.ks * a[0] @ b[0], c.R**2 * c.kr * (a[1] @ b[1] - twist), c.kt * twist])


def damping(c, p, rates):
    """As springs()."""
    force = c.springs * c.ks * (rates[0] - (rates[0] @ p.n) * p.n)
    twist = (rates[1] @ p.n) * p.n
    couple = c.springs * (c.R**2 * c.kr * (rates[1] - twist) + c.kt * twist)
    return -(c.r1 + c.r2) / p.distance * force, c.r1 * cross(p.n, force) - couple, c.r2 * cross(p.n, force) + couple


# ---- springs that are cut at their limits and formed anew (S17 section 3.2; MODEL.md, "Cut springs") ----


def passage(then, now, limit):
    """A displacement that grows evenly from one to the other while its spring is cut at the limit, again and again:
    (that of the last spring, the mean over the way)."""
    way, x, left, mean = now - then, then, 1.0, 0.0
    while True:
        squared, along, missing = way @ way, x @ way, limit**2 - x @ x
        s = (sqrt(along**2 + squared * missing) - along) / squared if missing > 0 else 0.0
        if s >= left:
            return x + left * way, mean + left * (x + left / 2 * way)
        mean, left, x = mean + s * (x + s / 2 * way), left - s, 0 * x


def by_mode(c, p):
    zeta, xi = displacements(c, p)
    return {"sliding": zeta, "rolling": xi, "twisting": np.array([p.phi])}


def with_displacement(c, p, mode, wanted):
    """p with another displacement of one mode, the others the same to first order in the pointers' angles."""
    q, by = SimpleNamespace(**vars(p)), wanted - by_mode(c, p)[mode]
    if mode == "twisting":
        q.phi = wanted[0]
    elif sqrt(by @ by) > 0:
        r1, r2 = (c.r1 + c.r2, -(c.r1 + c.r2)) if mode == "sliding" else (c.r1, c.r2)
        move(q, -by, 0.0, r1, r2)
    return q


def cut_at_limits(c, p, old, dt, time):
    """Cuts the springs beyond their limits. time: fraction of the step for which the contact has existed. Returns by
    mode: displacement a step ago and as it was carried here, whether it was cut, and the contact whose spring acts
    before now, with the fraction for which it does."""
    turn = dt * (cross(p.n, p.v) / p.distance + (p.w1 + p.w2) @ p.n / 2 * p.n)
    then = {"sliding": turned(old.zeta, turn), "rolling": turned(old.xi, turn), "twisting": np.array([old.phi])}
    limit, trial, ways = {"sliding": c.zeta_crit, "rolling": c.xi_crit, "twisting": c.phi_crit}, by_mode(c, p), {}
    for mode in ("twisting", "sliding", "rolling"):
        if trial[mode] @ trial[mode] > limit[mode] ** 2:
            left, ways[mode] = passage(then[mode], trial[mode], limit[mode])
            vars(p).update(vars(with_displacement(c, p, mode, left)))
    acting = {mode: with_displacement(c, p, mode, time * mean - then[mode] / 2) for mode, mean in ways.items()}
    return {m: (then[m], trial[m], m in ways, acting.get(m, p), 1.0 if m in ways else time / 2) for m in trial}


def of_mode(c, mode, p):
    """p with the springs of one mode alone."""
    stiffness = {name: getattr(c, name) if m == mode else 0.0 for m, name in STIFFNESS.items()}
    return SimpleNamespace(**{**vars(p), "springs": springs(SimpleNamespace(**{**vars(c), **stiffness}), p)})


STIFFNESS = {"sliding": "ks", "rolling": "kr", "twisting": "kt"}


# ---- grains, contacts and bonds through time steps (MODEL.md, "The integrator and the ledger") ----


class Scene:
    """N grains in open space under a leapfrog. materials: the fields of theory.Material each; radii: (N,); x,
    v, w: (N, 3). half_step: v and w are of half a step before x (YADE's functors), not of the same moment (the fused
    engine). options: of pair(). `energies`: by channel, at the present positions."""

    def __init__(self, materials, radii, x, v, w, dt, neck=0.0, half_step=False, limit="held", **options):
        self.materials, self.radii = [theory.Material(*m) for m in materials], np.array(radii)
        self.x, self.v, self.w, self.dt = np.array(x), np.array(v), np.array(w), dt
        self.mass = 4 / 3 * pi * np.array([m.density for m in self.materials])[:, None] * self.radii[:, None] ** 3
        self.inertia = 0.4 * self.mass * self.radii[:, None] ** 2
        self.neck, self.limit, self.options = neck, limit, options
        self.contacts, self.constants, self.lost = {}, {}, dict.fromkeys(LOST, 0.0)
        self.forces(dt if half_step else 0.0, start=True)
        if not half_step:
            self.v, self.w = self.v - dt / 2 * self.F / self.mass, self.w - dt / 2 * self.T / self.inertia
            for (i, j), p in self.contacts.items():
                p.v, p.w1, p.w2 = self.v[i] - self.v[j], self.w[i], self.w[j]
                p.rates = straining(self.constants[i, j][0], p, 0.0)[0]

    def step(self):
        self.v, self.w = self.v + self.dt * self.F / self.mass, self.w + self.dt * self.T / self.inertia
        self.x = self.x + self.dt * self.v
        self.forces(self.dt)

    def forces(self, dt, start=False):
        self.F, self.T, self.work, self.held = 0 * self.x, 0 * self.x, 0.0, dict.fromkeys(MODES, 0.0)
        for i in range(len(self.x)):
            for j in range(i + 1, len(self.x)):
                x, old = self.x[i] - self.x[j], self.contacts.pop((i, j), None)
                if old or x @ x < (self.radii[i] + self.radii[j]) ** 2:
                    self.pair_step(i, j, x, old, dt, start)
        kinetic = (self.mass * self.v**2).sum() / 2 + (self.inertia * self.w**2).sum() / 2
        self.energies = {"kinetic": kinetic + self.work, **self.held, **self.lost}

    def pair_step(self, i, j, x, old, dt, start):
        if (i, j) not in self.constants:
            grains = self.materials[i], self.radii[i], self.materials[j], self.radii[j], self.neck
            contact = pair(*grains, **self.options)
            self.constants[i, j] = contact, bond(*grains, self.options.get("mixed_factor", 1)) if self.neck else None
        c, b = self.constants[i, j]
        p = SimpleNamespace(i=i, j=j, x=x, v=self.v[i] - self.v[j], w1=self.w[i], w2=self.w[j], drag=0.0, bonded=False)
        p.distance, p.mass = sqrt(x @ x), 1 / (1 / self.mass[i, 0] + 1 / self.mass[j, 0])
        p.n, p.delta = x / p.distance, c.r1 + c.r2 - p.distance
        if start and b:
            old, dt = SimpleNamespace(n1=-p.n, n2=p.n, phi=0.0, rest=p.distance, bonded=True), 0.0
        if old is None:
            return self.form(c, p, dt) if p.delta > 0 else None
        p.n1, p.n2 = turned(old.n1, dt * p.w1), turned(old.n2, dt * p.w2)
        p.phi = old.phi + dt * (p.w1 - p.w2) @ (p.n - dt / 2 * (p.v - (p.v @ p.n) * p.n) / p.distance)  # A24 (A4)
        if old.bonded:
            p.bonded, p.rest, p.delta = True, old.rest, old.rest - p.distance
            return self.keep_bond(b, p, old, dt)
        if p.delta < -c.dc:
            return self.break_contact(c, p, old, dt)
        ways = self.within_limits(c, p, old, dt, 1.0)
        self.evaluate(c, p, p.v + (p.v - old.v) / 2)
        self.lost["drag"] += (old.drag + p.drag) / 2 * (p.delta - old.delta)
        self.kick(
            dt, self.before(c, p, 0.5 * (p.normal + p.drag), 0.5, ways, dt), [(p, 0.5 * (p.normal + p.drag), 0.5)]
        )
        self.damp(c, p, dt, old)

    def damp(self, c, p, dt, then, share=1.0, placed=False):
        """Of a contact that has existed for a share of the step; then: rates a step ago, and at that moment. One that
        was placed moved before as it does now, and nothing is booked."""
        if not c.springs:
            return
        rates, n = straining(c, p, dt)
        p.rates = share * rates - p.slipped
        p.rates_now = p.rates + (p.rates - (rates if placed else then.rates)) / 2
        kick = SimpleNamespace(**{**vars(p), "springs": damping(c, p, p.rates_now)})
        self.kick(dt, [(kick, 0.0, 0.5)], [(kick, 0.0, 0.5)])
        if not placed:
            both = then.rates_now + p.rates_now
            self.lost["springDamping"] += c.springs * dt / 2 * powers(c, n, both, rates - p.slipped).sum()
            for mode, energy in zip(MODES[1:], c.springs * dt / 2 * powers(c, n, both, p.slipped)):
                self.lost[f"{mode}Dissipation"] += energy

    def within_limits(self, c, p, old, dt, time):
        p.slipped = np.zeros((2, 3))
        if self.limit == "cut":
            return cut_at_limits(c, p, old, dt, time)
        return return_to_limits(c, p, old, dt, self.lost)

    def before(self, c, p, normal, part, ways, dt):
        """Kicks before now, for kick(); books what cut springs took of the motion."""
        if not ways or not any(cut for _, _, cut, _, _ in ways.values()):
            return [(p, normal, part)]
        kicks, taken = {}, {}
        for mode, (then, trial, cut, acting, fraction) in ways.items():
            k, now = getattr(c, STIFFNESS[mode]), by_mode(c, p)[mode]
            kicks[mode] = of_mode(c, mode, acting), 0.0, fraction
            *_, square, work = self.impulse(dt, [kicks[mode]])
            taken[mode] = k / 2 * (then @ trial - now @ now) - work
            if cut:
                taken[mode] += self.impulse(dt, [(of_mode(c, mode, p), 0.0, 0.5)])[3] - square
        cut = [mode for mode in ("sliding", "rolling") if ways[mode][2]]
        if len(cut) == 1:  # it shifted the other spring
            taken[cut[0]] = taken["sliding"] + taken["rolling"]
        for mode in cut + ["twisting"] * ways["twisting"][2]:
            self.lost[f"{mode}Dissipation"] += taken[mode]
        return [(p, normal, 0.0), *kicks.values()]

    def evaluate(self, c, p, v):
        """Forces and stored energies at this instant; v: relative velocity at it. The contact is there from now on."""
        p.zeta, p.xi = displacements(c, p)
        p.springs = springs(c, p)
        if p.bonded:
            p.normal, energy = c.kn * p.delta, c.kn / 2 * p.delta**2
        else:
            a, p.normal, energy = jkr(c, p.delta)
            p.drag = -(c.viscous * a + c.damping) * v @ p.n  # A22 (7), K13 (4)
        p.held = [energy, c.ks / 2 * p.zeta @ p.zeta, c.kr / 2 * p.xi @ p.xi, c.kt / 2 * p.phi**2]
        if not (p.bonded and max(p.held) > c.breaking):
            self.contacts[p.i, p.j] = p
            self.held = {mode: self.held[mode] + energy for mode, energy in zip(MODES, p.held)}

    def kick(self, dt, before, after=()):
        """Kicks over dt at this instant, (contact, normal force, fraction of the springs' forces) each; the work of
        those that belong `before` it is part of the kinetic energy now. Returns the sum of J^2/2m of what belongs after
        less before, torques included, and that work."""
        p, squares, works = before[0][0], [], []
        for kicks in (before, after):
            force, torque1, torque2, square, work = self.impulse(dt, kicks) if kicks else (*3 * [np.zeros(3)], 0.0, 0.0)
            self.F[p.i], self.F[p.j] = self.F[p.i] + force, self.F[p.j] - force
            self.T[p.i], self.T[p.j] = self.T[p.i] + torque1, self.T[p.j] + torque2
            squares.append(square)
            works.append(work)
        self.work += works[0]
        return squares[1] - squares[0], works[0]

    def impulse(self, dt, kicks):
        """Force, torques, J^2/2m (torques included) and work of kicks."""
        p = kicks[0][0]
        force = sum((normal * q.n + part * q.springs[0] for q, normal, part in kicks), np.zeros(3))
        torque1, torque2 = (sum((part * q.springs[k] for q, _, part in kicks), np.zeros(3)) for k in (1, 2))
        turning = torque1 @ torque1 / self.inertia[p.i, 0] + torque2 @ torque2 / self.inertia[p.j, 0]
        square = dt**2 / 2 * (force @ force / p.mass + turning)
        return force, torque1, torque2, square, dt * (force @ p.v + torque1 @ p.w1 + torque2 @ p.w2)

    def set_new(self, p, since):
        """Pointers and twist of a contact that formed a time `since` ago."""
        x = p.x - since * p.v
        n = x / sqrt(x @ x)
        p.n1, p.n2, p.phi = turned(-n, since * p.w1), turned(n, since * p.w2), since * (p.w1 - p.w2) @ n

    def form(self, c, p, dt):
        x = p.x - dt * p.v
        closing = p.delta - (c.r1 + c.r2 - sqrt(x @ x))
        inside = p.delta <= closing > 0  # the step; otherwise it was placed here, and nothing is booked
        f = p.delta / closing if inside else 0.0  # fraction of the step for which it has existed
        self.set_new(p, f * dt)
        ways = self.within_limits(
            c, p, SimpleNamespace(phi=0.0, zeta=np.zeros(3), xi=np.zeros(3)), dt, f if inside else 1.0
        )
        self.evaluate(c, p, p.v)
        self.damp(c, p, dt, AT_REST, f if inside else 1.0, not inside)
        after, work = 0.5 * (p.normal + p.drag), p.held[0] - c.Fc * c.dc * U_AT_CONNECTION
        if not inside:
            return self.kick(dt, self.before(c, p, after, 0.5, ways, dt), [(p, after, 0.5)])
        ahead = work / closing + f * p.drag
        self.kick(dt, self.before(c, p, ahead, f / 2, ways, dt), [(p, after, 0.5)])
        self.lost["connection"] += -c.Fc * c.dc * U_AT_CONNECTION + (after**2 - ahead**2) * dt**2 / (2 * p.mass)
        self.lost["drag"] += f * p.drag * closing

    def break_contact(self, c, p, old, dt):
        opening = old.delta - p.delta
        g = (old.delta + c.dc) / opening  # fraction of the step after which it broke
        _, normal, energy = jkr(c, old.delta)
        slope = -8 * 6 ** (-1 / 3) / sqrt(18)  # F = F(-delta_c) + slope F_c (x/delta0)^(1/2) before pull-off
        missed = c.Fc * slope * sqrt(opening / c.d0) * missed_at_pull_off(g)
        push = (energy - c.Fc * c.dc * U_AT_PULL_OFF) / opening - normal / 2 + (g - 0.5) * old.drag - missed
        p.springs, (zeta, xi) = springs(c, p), displacements(c, p)
        self.kick(dt, [(p, push, g - 0.5)])
        lost = c.Fc * c.dc * U_AT_PULL_OFF - (push * dt) ** 2 / (2 * p.mass)
        for k, then, now in ((c.ks, old.zeta, zeta), (c.kr, old.xi, xi), (c.kt, old.phi, p.phi)):
            lost += k / 2 * np.dot(then, now) + k * (g - 0.5) * np.dot(now, now - then)
        self.lost["disconnection"] += lost
        if c.springs:
            rates, n = straining(c, p, dt)
            p.springs = damping(c, p, old.rates_now)
            self.kick(dt, [(p, 0.0, g - 0.5)])
            self.lost["springDamping"] += g * c.springs * dt * powers(c, n, old.rates_now, rates).sum()
        self.lost["drag"] -= g * old.drag * opening

    def keep_bond(self, b, p, old, dt):
        self.evaluate(b, p, p.v)
        if max(p.held) <= b.breaking:
            return self.kick(dt, [(p, 0.5 * p.normal, 0.5)], [(p, 0.5 * p.normal, 0.5)])
        modes = [(b.kn, old.delta, p.delta), (b.ks, old.zeta, p.zeta), (b.kr, old.xi, p.xi), (b.kt, old.phi, p.phi)]
        lost = sum(k / 2 * np.dot(then, now) for k, then, now in modes)
        g = 1.0  # fraction of the step after which the first mode held the breaking energy
        for k, then, now in (mode for mode, energy in zip(modes, p.held) if energy > b.breaking):
            way, missing = now - then, 2 * b.breaking / k - np.dot(then, then)
            squared, along = np.dot(way, way), np.dot(then, way)
            g = min(g, (sqrt(along**2 + squared * missing) - along) / squared if missing > 0 else 0.0)
        before, after = [(p, (g - 0.5) * p.normal, g - 0.5)], []
        c, closing = self.constants[p.i, p.j][0], p.delta - old.delta
        q = SimpleNamespace(**{**vars(p), "bonded": False, "delta": c.r1 + c.r2 - p.distance})
        if q.delta > 0:  # an ordinary contact of the shrunk grains takes its place
            f = min(1 - g, q.delta / closing if q.delta < closing else 1.0)
            self.set_new(q, f * dt)
            self.evaluate(c, q, q.v)
            before, after = [*before, (q, f * (q.normal + q.drag), f / 2)], [(q, 0.5 * (q.normal + q.drag), 0.5)]
            self.lost["drag"] += f * q.drag * closing
            lost -= sum(q.held) + f * q.drag * closing
            q.slipped = np.zeros((2, 3))
            self.damp(c, q, dt, AT_REST, f)
        unequal, work = self.kick(dt, before, after)
        self.lost["bondBreaking"] += lost - work + unequal
