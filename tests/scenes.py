"""Small scenes for tests marked in_yade: `from scenes import *` brings YADE's names, the contact law's, and these."""

import sys

import numpy as np

from analysis.runs.format import BROKEN_BONDS

if "yade" in sys.modules:  # pytest itself, which collects the tests, does without
    from yade import utils
    from yade.minieigenHP import *
    from yade.wrapper import *

    import contact_law

    CHANNELS = [name for name, kind in contact_law.channels if kind != "work"]
    LOST = [name for name, kind in contact_law.channels if kind == "lost"]


def ice(**other):
    return JKRMat(**{**dict(young=7e9, poisson=0.25, density=1000, surfaceEnergy=0.1, criticalRolling=0.8e-9), **other})


def soft(**other):
    return JKRMat(
        **{**dict(young=3e9, poisson=0.33, density=1300, surfaceEnergy=0.05, criticalRolling=1.1e-9), **other}
    )


SHORT = {
    "damping": "linearDamping",
    "sliding_factor": "slidingStiffnessFactor",
    "rolling_factor": "rollingStiffnessFactor",
    "spring_damping": "springDamping",
    "mixed_factor": "mixedSurfaceEnergyFactor",
}


def attributes(options):
    """Options by the names that functor and engine have."""
    return {SHORT.get(name, name): value for name, value in options.items()}


def constants(material1, radius1, material2=None, radius2=None, **options):
    functor = Ip2_JKRMat_JKRMat_JKRWadaPhys(**attributes(options))
    return functor.pairConstants(material1, radius1, material2 or material1, radius2 or radius1)


def functor_engines(
    damping=0, verlet=0.0, neck=0, sliding_factor=1, rolling_factor=1, spring_damping=0, mixed_factor=1, **law
):
    """With all of YADE's shapes that meet spheres; the law refuses facets and boxes."""
    bounds = [Bo1_Sphere_Aabb(), Bo1_Wall_Aabb(), Bo1_Facet_Aabb(), Bo1_Box_Aabb()]
    shapes = [Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom(), Ig2_Facet_Sphere_ScGeom(), Ig2_Box_Sphere_ScGeom()]
    of_pairs = dict(damping=damping, neck=neck, sliding_factor=sliding_factor, rolling_factor=rolling_factor)
    of_pairs |= dict(spring_damping=spring_damping, mixed_factor=mixed_factor)
    pairs = Ip2_JKRMat_JKRMat_JKRWadaPhys(**attributes(of_pairs))
    loop = InteractionLoop(shapes, [pairs], [Law2_ScGeom_JKRWadaPhys_JKRWada(**law)])
    return [ForceResetter(), InsertionSortCollider(bounds, verletDist=verlet), loop, NewtonIntegrator(damping=0)]


def new_scene(dt, mover="functors", **options):
    """An empty scene with functor_engines(), or ("fused") the engine with the same options and its own; dt: the small
    step."""
    O.reset()
    O.dt, O.trackEnergy = dt * options.get("subSteps", 1), True
    if mover == "functors":
        O.engines = functor_engines(**options)
    else:
        fused_engine(**attributes(options))


def grain(position, radius, material, velocity=(0, 0, 0), spin=(0, 0, 0), blocked=""):
    """Append a sphere; returns its id."""
    body = utils.sphere([float(x) for x in position], float(radius), material=material)
    body.state.vel, body.state.angVel = ([float(x) for x in given] for given in (velocity, spin))
    body.state.blockedDOFs = blocked
    return O.bodies.append(body)


def cluster(count, seed, materials, radii, speed=1.0, spin=1e7):
    """A chain of touching grains in random directions, with random velocities and spins."""
    random = np.random.default_rng(seed)
    placed = []
    for k in range(count):
        material, radius = materials[k % len(materials)], radii[k % len(radii)]
        while True:
            if not placed:
                x = np.zeros(3)
            else:
                other, r, m = placed[random.integers(len(placed))]
                direction = random.normal(size=3)
                overlap = constants(m, r, material, radius)["equilibriumOverlap"]
                x = other + (r + radius - overlap) * direction / np.linalg.norm(direction)
            if all(np.linalg.norm(x - y) > r + radius + 1e-9 or np.array_equal(y, other) for y, r, _ in placed):
                break
        placed.append((x, radius, material))
    for x, radius, material in placed:
        grain(x, radius, material, speed * random.normal(size=3), spin * random.normal(size=3))


def energies(*works):
    """The channels now, and these works; zero where the scene has none."""
    have = dict(O.energy.items())
    return {name: have.get(name, 0.0) for name in (*CHANNELS, *works)}


def total_energy(*works):
    return sum(energies(*works).values())


def steps(number):
    """So many calls of O.step: O.run() waits long for its thread."""
    for _ in range(number):
        O.step()


def largest_change(looks, *works, every=1, step=lambda: O.step()):
    """How far the sum of all channels and these works gets from what it is now [J]: after each of `looks` times
    `every` calls of step()."""
    first = total_energy(*works)
    largest = 0
    for _ in range(looks):
        for _ in range(every):
            step()
        largest = max(largest, abs(total_energy(*works) - first))
    return largest


def rms(numbers):
    return np.sqrt(np.mean(np.square([*numbers]), axis=0))


def momenta():
    """(linear, angular momentum about the origin), with positions and velocities as the integrator holds them."""
    states = [b.state for b in O.bodies]
    p = [s.mass * np.array(s.vel) for s in states]
    l = [np.cross(s.pos, own) + np.multiply(s.inertia, s.angVel) for s, own in zip(states, p)]
    return np.sum(p, axis=0), np.sum(l, axis=0)


def momentum_scales():
    """(linear, angular): sums of the grains' own, without their directions and spins."""
    p = [b.state.mass * np.array(b.state.vel) for b in O.bodies]
    l = [np.cross(b.state.pos, own) for b, own in zip(O.bodies, p)]
    return np.linalg.norm(p, axis=1).sum(), np.linalg.norm(l, axis=1).sum()


def converging(count, seed, materials, radii, speed=5.0, spin=2e7):
    """Grains on a loose lattice (no contacts), all flying towards the middle with some spread, and spinning."""
    random = np.random.default_rng(seed)
    side = int(np.ceil(count ** (1 / 3)))
    for k, site in enumerate(list(np.ndindex(side, side, side))[:count]):
        radius, site = radii[k % len(radii)], np.array(site) - (side - 1) / 2
        x = 2.02 * max(radii) * (site + 0.004 * random.normal(size=3))
        velocity = -speed * site + 0.2 * speed * random.normal(size=3)
        grain(x, radius, materials[k % len(materials)], velocity, spin * random.normal(size=3))


def meeting(kind, count=27, step=0.1, **options):
    """An empty scene with a small step [t0], and in it converging() grains of one of KINDS."""
    new_scene(step * unit, **options)
    converging(count, 1, *KINDS[kind])


def periodic_cell(*edges, homo=2, velocity_gradient=(0, 0, 0)):
    """Edges [m]; homo: O.cell.homoDeform; velocity_gradient: its diagonal [1/s]."""
    O.periodic = True
    O.cell.setBox(*map(float, edges))
    O.cell.homoDeform = homo
    if any(velocity_gradient):
        O.cell.velGrad = Matrix3(*np.diag(velocity_gradient).ravel().tolist())


def fused_engine(**options):
    O.engines = [JKRWadaEngine(**options)]


def engine_of_sub_steps(number, **options):
    """The engine in O.steps of so many small steps of O.dt."""
    fused_engine(subSteps=number, **options)
    O.dt *= number


def set_free(packing, material):
    """contact_law.snapshot() of a packing's grains at their start and 2000 t0 later, and their largest kinetic energy
    meanwhile [J]."""
    new_scene(0.1 * constants(material, packing.radius.min())["timeUnit"])
    for x, r in zip(packing.position, packing.radius):
        grain(x, r, material)
    engine_of_sub_steps(100)
    O.engines[0].prepare()
    before, kinetic = contact_law.snapshot(), []
    for _ in range(20):
        O.run(10, True)
        kinetic.append(energies()["kinetic"])
    return before, contact_law.snapshot(), max(kinetic)


def message_of(call):
    """What a call is refused with, or ''."""
    try:
        call()
    except (RuntimeError, ValueError) as error:
        return str(error)
    return ""


def refusal(steps=1):
    """What one of so many O.steps is refused with, or ''."""
    return message_of(lambda: [O.step() for _ in range(steps)])


def positions():
    return np.array([b.state.pos for b in O.bodies])


def motion():
    """Positions, velocities and spins of all grains, as lists."""
    return [[list(b.state.pos), list(b.state.vel), list(b.state.angVel)] for b in O.bodies]


def all_states():
    """motion() of all grains, their blocked degrees of freedom and orientations."""
    return [[*moved, b.state.blockedDOFs, list(b.state.ori)] for moved, b in zip(motion(), O.bodies)]


def saved_and_loaded(name="saved.yade.gz"):
    O.save(name)
    O.load(name)


def record(n, *works, before=lambda k: None):
    """Positions (n, bodies, 3) and energies(*works) after each of n steps; before(k) is called ahead of step k."""
    tracks, sums = [], []
    for k in range(n):
        before(k)
        O.step()
        tracks.append(positions())
        sums.append(energies(*works))
    return np.array(tracks), sums


def compared(functors, engine, channels=None):
    """Differences of record(n + 1) of the functors, whose energies belong to the positions before the step, and
    record(n) of the engine: ((n,) of positions [1e-7 m], largest ones of energies by channel, over the kinetic energy
    at the start)."""
    (tracks, sums), (others, other_sums) = functors, engine
    n, scale = len(others), sums[0]["kinetic"]
    of_energies = {
        c: max(abs(sums[k + 1][c] - other_sums[k][c]) for k in range(n)) / scale for c in channels or CHANNELS
    }
    return np.abs(tracks[:n] - others).max(axis=(1, 2)) / 1e-7, of_energies


def broken():
    """Bonds that have broken so far, by mode."""
    if isinstance(O.engines[0], JKRWadaEngine):
        counts = O.engines[0].statistics()
        return [counts[mode] for mode in BROKEN_BONDS]
    return [getattr(O.engines[2].lawDispatcher.functors[0], mode) for mode in BROKEN_BONDS]


if "yade" in sys.modules:
    unit = constants(ice(), 1e-7)["timeUnit"]  # t0 of two grains of ice [s]
    KINDS = {  # materials and radii [m]
        "like": ([ice()], [1e-7]),
        "unlike": ([ice(), soft()], [1e-7, 1.6e-7, 1.3e-7]),
        "drag": ([ice(viscoelasticTime=2e-12)], [1e-7]),
    }
