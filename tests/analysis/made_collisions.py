"""Run folders of made-up collisions of elastoplastic aggregates with known answers."""

import numpy as np
from written_runs import RADIUS, losing, record, state_arrays, write_run

from analysis.theory.andrews import Spheres
from analysis.theory.andrews_motion import motion

MODULI, OFFSET, FILLING, DENSITY = (2.0e6, 20e6), 0.25 * RADIUS, 0.4, 1000.0


def made_run(path, size, velocity, seed, sticks=False, settles=True, stretch=1.0, **parameters):
    """Write a run folder of two aggregates of two grains each that move as Andrews's spheres of radius `size` [grain radii] would, with
    compressions and times larger by the factor `stretch`. With `sticks` they stay in contact, and unless `settles` is False come to rest
    by the end."""
    spheres = Spheres(0.5 * (size * RADIUS + OFFSET), FILLING * DENSITY, *MODULI)
    course = motion(velocity, spheres)
    contact = 2.0 * (RADIUS - OFFSET) / velocity
    time = np.linspace(0.0, contact + 2.0 * course.time_of_parting, 401)
    time = np.append(time, [parameters[name] for name in ("duration",) if name in parameters])
    d = stretch * course.compression((time - contact) / stretch) - 2.0 * OFFSET
    v = course.velocity((time - contact) / stretch)
    parted = contact + stretch * course.time_of_parting
    if sticks and settles:
        v = v * np.clip((time[-1] - time) / (time[-1] - parted), 0.0, 1.0)
    kinetic, touching = 1e-15 * v**2, (time > contact) & (sticks | (time < parted))
    own = dict(kinetic=kinetic, slidingDissipation=1e-15 * velocity**2 - kinetic, contacts=2 + touching)
    history = losing(time, touching=touching, d=d, v=v, **own)
    shown = (*range(0, 401, 50), *range(401, len(time)))
    states = [_state(time[k], d[k], v[k], size, bool(touching[k])) for k in shown]
    scene = dict(packing="cpe", material="ice", filling=FILLING, radius=size, velocity=velocity, seed=seed)
    about = record(size * RADIUS, {**scene, "impact": 0.0, "stepFraction": 0.1, **parameters})
    return write_run(path, about, history, states)


def _state(time, d, v, size, touching):
    x = size * RADIUS - 0.5 * d
    position = [[-x, 0, 0], [-x, 2 * RADIUS, 0], [x, 0, 0], [x, 2 * RADIUS, 0]]
    velocity = [[v / 2, 0, 0]] * 2 + [[-v / 2, 0, 0]] * 2
    return state_arrays(time, position, velocity, [0, 0, 1, 1], [[0, 1], [2, 3]] + [[0, 2]] * touching)
