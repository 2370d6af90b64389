"""Run folders of made-up collisions of elastoplastic aggregates with known answers."""

import numpy as np
from scipy.integrate import solve_ivp
from written_runs import RADIUS, facing, losing, record, write_run

from analysis.theory.andrews import Spheres, critical_compression

MODULI, OFFSET, FILLING, DENSITY = (2.0e6, 20e6), 0.25 * RADIUS, 0.4, 1000.0


def integrated(velocity, spheres):
    """(times [s], compressions [m], velocities [m/s]) of Andrews's spheres until the largest compression and from
    there until they part, from the force alone (A24 eqs 23, 26, B15, B19, B23, B24)."""
    scale, critical = spheres.reduced_radius, critical_compression(spheres)
    mass, stiffness = 16 * np.pi / 3 * spheres.density * scale**3, 4 / 3 * spheres.young * scale**0.5

    def until(end, start, state, force):
        moving = lambda t, y: [y[1], -force(y[0] * scale) / (mass * scale)]
        end.terminal, end.direction = True, -1
        how = {"rtol": 1e-11, "atol": 1e-13 * velocity / scale, "method": "DOP853", "max_step": 2e-9}
        found = solve_ivp(moving, (start, start + 1e-5), state, events=end, **how)
        return found.t, *(scale * found.y)

    plastic = lambda d: np.pi * scale * spheres.yield_stress * (d - critical / 3)
    growing = lambda d: stiffness * max(d, 0.0) ** 1.5 if d <= critical else plastic(d)
    there = until(lambda t, y: y[1], 0.0, [0.0, velocity / scale], growing)
    apart = max(there[1][-1] - critical, 0.0)
    force = lambda d: stiffness * max(d - apart, 0.0) ** 0.5 * (d + 0.5 * apart)
    return there, until(lambda t, y: y[0] - apart / scale, there[0][-1], [there[1][-1] / scale, 0.0], force)


def made_run(path, size, velocity, seed, sticks=False, settles=True, stretch=1.0, **parameters):
    """Write a run folder of two aggregates of two grains each that move as Andrews's spheres of radius `size` [grain
    radii] would, with compressions and times larger by the factor `stretch`. With `sticks` they stay in contact, and
    unless `settles` is False come to rest by the end."""
    spheres = Spheres(0.5 * (size * RADIUS + OFFSET), FILLING * DENSITY, *MODULI)
    at, compression, speed = np.concatenate(integrated(velocity, spheres), axis=1)
    contact = 2.0 * (RADIUS - OFFSET) / velocity
    time = np.linspace(0.0, contact + 2.0 * at[-1], 401)
    time = np.append(time, [parameters[name] for name in ("duration",) if name in parameters])
    since = (time - contact) / stretch
    free = velocity * np.minimum(since, 0.0) + speed[-1] * np.maximum(since - at[-1], 0.0)
    d = stretch * (np.interp(since, at, compression) + free) - 2.0 * OFFSET
    v = np.interp(since, at, speed)
    parted = contact + stretch * at[-1]
    if sticks and settles:
        v = v * np.clip((time[-1] - time) / (time[-1] - parted), 0.0, 1.0)
    kinetic, touching = 1e-15 * v**2, (time > contact) & (sticks | (time < parted))
    own = dict(kinetic=kinetic, slidingDissipation=1e-15 * velocity**2 - kinetic, contacts=2 + touching)
    history = losing(time, touching=touching, d=d, v=v, **own)
    shown = (*range(0, 401, 50), *range(401, len(time)))
    two = dict(one=[[0, 0, 0], [0, 2 * RADIUS, 0]], pairs=[[0, 1]], reach=size * RADIUS)
    states = [facing(time[k], d[k], v[k], **two, touching=touching[k]) for k in shown]
    scene = dict(packing="cpe", material="ice", filling=FILLING, radius=size, velocity=velocity, seed=seed)
    about = record(size * RADIUS, {**scene, "impact": 0.0, "stepFraction": 0.1, **parameters})
    return write_run(path, about, history, states)
