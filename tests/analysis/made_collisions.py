"""Run folders of made-up collisions of elastoplastic aggregates with known answers."""

import numpy as np
from written_runs import RADIUS, record, state_arrays, write_run

from analysis.runs.format import CHANNELS
from analysis.theory.andrews import Spheres
from analysis.theory.andrews_motion import motion

MODULI, OFFSET, FILLING, DENSITY = (2.0e6, 20e6), 0.25 * RADIUS, 0.4, 1000.0


def made_run(
    path,
    size,
    velocity,
    seed,
    shift,
    filling=FILLING,
    sticks=False,
    settles=True,
    ended=True,
    stretch=1.0,
    **parameters,
):
    """Write a run folder of two aggregates of two grains each that move as Andrews's spheres of radius `size`
    [grain radii] would, with compressions and times larger by the factor `stretch`, and d too large by
    `shift` [grain radii] throughout. With `sticks` they stay in contact, and unless `settles` is False come to
    rest by the end."""
    spheres = Spheres(0.5 * (size * RADIUS + OFFSET), filling * DENSITY, *MODULI)
    course = motion(velocity, spheres)
    contact = 2.0 * (RADIUS - OFFSET) / velocity
    time = np.linspace(0.0, contact + 2.0 * course.time_of_parting, 401)
    time = np.append(time, [parameters[name] for name in ("duration",) if name in parameters])
    d = stretch * course.compression((time - contact) / stretch) - 2.0 * OFFSET + shift * RADIUS
    v = course.velocity((time - contact) / stretch)
    if sticks and settles:
        parted = contact + stretch * course.time_of_parting
        v = v * np.clip((time[-1] - time) / (time[-1] - parted), 0.0, 1.0)
    history = {name: np.zeros(time.size) for name in CHANNELS}
    energy = 1e-15 * velocity**2
    history["kinetic"] = energy * (v / velocity) ** 2
    history["slidingDissipation"] = energy - history["kinetic"]
    touching = (time > contact) & (sticks | (time < contact + stretch * course.time_of_parting))
    history.update(time=time, d=d, v=v, contacts=2 + touching, contacts_between=touching.astype(int))
    states = [
        _state(time[k], d[k], v[k], size, bool(touching[k])) for k in (*range(0, 401, 50), *range(401, len(time)))
    ]
    values = {
        "packing": "cpe",
        "material": "ice",
        "filling": filling,
        "radius": size,
        "velocity": velocity,
        "seed": seed,
        "impact": 0.0,
        "stepFraction": 0.1,
        **parameters,
    }
    return write_run(path, record(size * RADIUS, values), history, states, ended)


def _state(time, d, v, size, touching):
    x = size * RADIUS - 0.5 * d
    position = [[-x, 0, 0], [-x, 2 * RADIUS, 0], [x, 0, 0], [x, 2 * RADIUS, 0]]
    velocity = [[v / 2, 0, 0]] * 2 + [[-v / 2, 0, 0]] * 2
    return state_arrays(time, position, velocity, [0, 0, 1, 1], [[0, 1], [2, 3]] + [[0, 2]] * touching)
