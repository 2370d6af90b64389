"""Made-up collisions of elastoplastic aggregates with known answers: points for the fits, and whole run
folders."""

import numpy as np
from written_runs import RADIUS, record, state_arrays, write_run

from analysis.runs.format import CHANNELS
from analysis.studies.elastoplastic.points import make_points
from analysis.studies.elastoplastic.velocity_fit import reduced_radius
from analysis.theory.andrews import Spheres, largest_compression, time_of_largest_compression
from analysis.theory.andrews_motion import motion

MODULI, OFFSET, FILLING, DENSITY = (2.0e6, 20e6), 0.25 * RADIUS, 0.4, 1000.0
V = 10**0.5


def made_points(random, seeds, radii=(40.0, 60.0, 80.0), velocities=(V,), scatter=0.2, moduli=MODULI):
    """Points whose d_max and t_max are Andrews's and scatter: half of the variance belongs to the pair (same
    seed, same at all velocities), as it does in collisions of the same aggregates."""
    filling, radius, velocity, samples, names = [], [], [], [], []
    for size in radii:
        pair = random.normal(size=seeds)
        for v in velocities:
            spheres = Spheres(reduced_radius(size * RADIUS, OFFSET), FILLING * DENSITY, *moduli)
            d = float(largest_compression(v, spheres)) - 2.0 * OFFSET
            t = float(time_of_largest_compression(v, spheres)) + 2.0 * (RADIUS - OFFSET) / v
            noise = scatter * np.sqrt(0.5) * (pair + random.normal(size=seeds))
            other = scatter * random.normal(size=seeds)
            filling.append(FILLING)
            radius.append(size * RADIUS)
            velocity.append(v)
            samples.append((d + RADIUS * noise, t + RADIUS / v * (0.5 * noise + 0.5 * other)))
            names.append(tuple(range(1, seeds + 1)))
    return make_points(np.array(filling), np.array(radius), np.array(velocity), tuple(samples), tuple(names))


def line_of(moduli=MODULI, v=V):
    """{c1, c2, offset, ratio} that made_points has without scatter; lengths in grain radii."""
    ratio = float(largest_compression(v, Spheres(1.0, FILLING * DENSITY, *moduli)))
    offset = OFFSET / RADIUS
    return {"c1": ratio / 2.0, "c2": offset * (2.0 - ratio / 2.0), "offset": offset, "ratio": ratio}


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
    spheres = Spheres(reduced_radius(size * RADIUS, OFFSET), filling * DENSITY, *MODULI)
    course = motion(velocity, spheres)
    contact = 2.0 * (RADIUS - OFFSET) / velocity
    time = np.linspace(0.0, contact + 2.0 * course.time_of_parting, 401)
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
    states = [_state(time[k], d[k], v[k], size, bool(touching[k])) for k in range(0, 401, 50)]
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
