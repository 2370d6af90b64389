"""Run folders written for tests, in the format that the collision script writes."""

import hashlib
import json
from math import pi

import numpy as np

from analysis.__main__ import main
from analysis.runs.format import CHANNELS, ENDED_FILE, FORMAT, HISTORY_FILE, RUN_FILE, STATES_FOLDER, state_file
from analysis.theory import ICE, collide_pair, normal_energy, normal_force, pair_constants, pair_motion
from yade_scripts import packings

RADIUS = 1e-7
PAIR = pair_constants(ICE, RADIUS)
PAIR_VELOCITY = 8.0  # of pair_run
MASS = 4.0 / 3.0 * pi * ICE.density * RADIUS**3


def record(aggregate_radius, parameters=None, **others):
    """The dict of run.json for ice grains of 0.1 um and an aggregate radius [m]; others: derived constants that
    differ, or are more."""
    material = {"young": ICE.young, "poisson": ICE.poisson, "surfaceEnergy": ICE.surface_energy, "density": ICE.density}
    material |= {"criticalRolling": ICE.critical_rolling, "viscoelasticTime": 0.0}
    pair = {"equilibriumContactRadius": PAIR.equilibrium_contact_radius, "equilibriumOverlap": PAIR.equilibrium_overlap}
    pair |= {"pullOffOverlap": PAIR.pull_off_overlap, "pullOffForce": PAIR.pull_off_force, "timeUnit": PAIR.time_unit}
    derived = {**material, "grainRadius": RADIUS, "grainMass": MASS, **pair, "timeStep": 0.1 * PAIR.time_unit}
    derived |= {"steps": 0, "aggregateRadius": aggregate_radius, "grainsPerAggregate": 1, **others}
    about = {"format": FORMAT, "kind": "collision", "parameters": parameters or {"material": "ice"}, "derived": derived}
    about |= {"versions": {}, "commit": "unknown", "seed": 1, "hardware": {"cpu": "", "cores": 1}}
    return {**about, "wallTime": 0.0, "outcome": "completed"}


def chain(start, number):
    """Contact pairs of so many grains in a row, from this one on."""
    return [[k, k + 1] for k in range(start, start + number - 1)]


def cubic_lattice(side, axes=(0, 1, 2)):
    """(sites (N,3) in spacings, contact pairs (M,2)) of a simple cubic lattice that fills its cell, connected with
    its images along these axes."""
    site = np.argwhere(np.ones(3 * [side]))
    ahead = (site[:, None] + np.eye(3, dtype=int)) % side @ (side**2, side, 1)
    pairs = np.stack([np.repeat(np.arange(side**3), 3), ahead.ravel()], axis=1)
    along = np.tile(np.arange(3), side**3)
    return site.astype(float), pairs[(site.ravel() < side - 1) | np.isin(along, axes)]


def losing(time, energy=0.0, lost={}, touching=0, **series):
    """A collision's history (T,): an energy [J], of which fractions {channel: part} go evenly over the time; nothing
    else happens but other series."""
    zero = np.zeros(len(time))
    history = {name: lost.get(name, 0.0) * energy * time / time[-1] for name in CHANNELS}
    history["kinetic"] = energy - sum(history.values())
    touching = zero.astype(int) + touching
    usual = {"time": time, "d": zero, "v": zero, "contacts": 0 * touching, "contacts_between": touching}
    return {**history, **usual, **series}


def write_run(path, run_record, history, states, ended=True):
    """Write a run folder: record (dict), history (dict of (T,)), states (list of dicts of arrays)."""
    (path / STATES_FOLDER).mkdir(parents=True)
    (path / RUN_FILE).write_text(json.dumps(run_record))
    np.savez(path / HISTORY_FILE, **history)
    for number, state in enumerate(states):
        np.savez(path / STATES_FOLDER / state_file(number), **state)
    if ended:
        seal(path)
    return path


def seal(path):
    """Write the sums of a folder's files, as they are now."""
    files = sorted(file.relative_to(path) for file in path.glob("**/*") if file.suffix in (".json", ".npz"))
    lines = (f"{hashlib.sha256((path / file).read_bytes()).hexdigest()}  {file.as_posix()}\n" for file in files)
    (path / ENDED_FILE).write_text("".join(lines))


def unseal(path):
    """Make a folder one that has ended without sums, of format 3."""
    text = (path / RUN_FILE).read_text()
    (path / RUN_FILE).write_text(text.replace(f'"format": {FORMAT}', '"format": 3'))
    (path / ENDED_FILE).write_text("")
    return path


def state_arrays(time, position, velocity, aggregate, pairs=()):
    """A state's dict; position, velocity (N,3), aggregate (N,), pairs (M,2)."""
    position = np.asarray(position, dtype=float)
    pairs = np.asarray(pairs, dtype=int).reshape(-1, 2)
    grains = {"position": position, "velocity": np.asarray(velocity, dtype=float)}
    grains |= {"radius": np.full(len(position), RADIUS), "angular_velocity": np.zeros_like(position)}
    grains |= {"aggregate": np.asarray(aggregate, dtype=int)}
    contacts = {"contact_normal_force": np.zeros(len(pairs)), "contact_bonded": np.zeros(len(pairs), dtype=bool)}
    return {"time": time, **grains, "contact_pairs": pairs, **contacts}


def pair_run(path):
    """A run folder of two grains that bounce, from the closed equation of motion (A22 eq 30). Returns the path."""
    collision = collide_pair(PAIR_VELOCITY, PAIR)
    time = np.linspace(0.0, 1.5 * collision.duration, 201)
    overlap, rate = pair_motion(PAIR_VELOCITY, PAIR, time)
    apart = np.isnan(rate)
    after = time - collision.duration
    overlap = np.where(apart, -PAIR.pull_off_overlap - collision.rebound_velocity * after, overlap)
    rate = np.where(apart, -collision.rebound_velocity, rate)
    energies = {
        "kinetic": 0.5 * PAIR.reduced_mass * rate**2,
        "normal": np.where(apart, 0.0, normal_energy(overlap, PAIR)),
        # The contact exists from the first sample on: what it took is part of the start.
        "connection": np.full(201, -normal_energy(0.0, PAIR)),
        "disconnection": np.where(apart, normal_energy(-PAIR.pull_off_overlap, PAIR), 0.0),
    }
    history = losing(time, touching=~apart, contacts=(~apart).astype(int), d=overlap - 2 * RADIUS, v=rate, **energies)
    states = [facing(time[k], overlap[k] - 2 * RADIUS, rate[k], touching=not apart[k]) for k in (0, 67, 200)]
    for k, state in zip((0, 67, 200), states):
        state["contact_normal_force"][:] = normal_force(overlap[k], PAIR)
    return write_run(path, record(0.0), history, states)


def facing(time, d, v, one=((0, 0, 0),), pairs=(), reach=0.0, touching=False):
    """A state's dict: an aggregate `one` (N,3) with contact pairs (M,2) and of radius `reach`, and another like it,
    at the compression length d and the mutual velocity v; touching: their first grains do."""
    grains, shift = len(one), np.array([reach - 0.5 * d, 0, 0])
    pairs = np.reshape(pairs, (-1, 2))
    contacts = np.concatenate([pairs, pairs + grains, [[0, grains]] if touching else np.empty((0, 2))])
    position = np.concatenate([one - shift, one + shift])
    moving = np.repeat([[v / 2, 0, 0], [-v / 2, 0, 0]], grains, axis=0)
    return state_arrays(time, position, moving, np.repeat([0, 1], grains), contacts)


def change_arrays(file, **changed):
    """Other arrays in an .npz file; None: without that one."""
    with np.load(file) as archive:
        arrays = {**archive, **changed}
    np.savez(file, **{name: array for name, array in arrays.items() if array is not None})


def flip(file, where=0.4, bits=4):
    """Flip bits of a byte, at this fraction of a file's length."""
    data = bytearray(file.read_bytes())
    data[int(where * len(data))] ^= bits
    file.write_bytes(bytes(data))


def two_pairs(path, velocity, seed, sticks=True, settles=True, derived={}, how={}, **parameters):
    """A run folder of two aggregates of two grains each: they meet at velocity [m/s], lose their motion to sliding,
    and stick (still parting at the end unless it settles) or part at half their speed. derived: as record's others;
    how: as meeting's. Returns the path."""
    values = {"packing": "cpe", "material": "ice", "grains": 2, "velocity": velocity, "seed": seed, "impact": 0.0}
    pair, lost = np.array([[0, 0, 0], [0, 2 * RADIUS, 0]]), {"slidingDissipation": 1.0}
    about, v = record(RADIUS, {**values, **parameters}, **derived), -0.5 if not sticks else 0.0 if settles else -0.4
    return meeting(path, about, pair, [[0, 1]], velocity, lost, away=v, sticks=sticks, **how)


def two_clusters(path):
    """The same of two clusters of some fifty grains that stick, with forces at random and losses of several kinds."""
    cluster = packings.cpe(0.6, 4.5 * RADIUS, RADIUS, PAIR.equilibrium_overlap, seed=1)
    position = cluster.position - cluster.position.mean(axis=0)
    reach = np.abs(position[:, 0]).max() + RADIUS
    lost = {"connection": 0.3, "drag": 0.9, "normal": -0.2}
    values = {"radius": 4.5, "velocity": 1.0}
    return meeting(path, record(reach, values), position, packings.contacts(cluster), 1.0, lost, states=12)


def meeting(path, about, one, pairs, velocity, lost, away=0.0, sticks=True, ended=True, states=3, lasts=4e-7):
    """A run folder of an aggregate `one` (N,3) with contact pairs (M,2), and another like it, that meet at velocity
    [m/s]: a contact of their first grains forms; lost: {channel: its fraction of the motion's energy}; away: velocity
    at the end over the first."""
    time = np.linspace(0.0, lasts, 401)
    meet, turn = 1e-7, 2e-7
    v = velocity * np.interp(time, [0, meet, turn, 3e-7], [1, 1, 0, away])
    d = -velocity * meet + np.concatenate([[0.0], np.cumsum(0.5 * (v[1:] + v[:-1]) * np.diff(time))])
    grains, random = len(one), np.random.default_rng(1)
    energy, touching = grains * MASS * (velocity / 2) ** 2, (time > meet) & (sticks | (time < 3e-7))
    kinetic = energy * (v / velocity) ** 2
    energies = {"kinetic": kinetic, **{name: part * (energy - kinetic) for name, part in lost.items()}}
    history = losing(time, touching=touching, contacts=2 * len(pairs) + touching, d=d, v=v, **energies)
    kept, reach = [], about["derived"]["aggregateRadius"]
    for k in np.linspace(0, 400, states).astype(int):
        state = facing(time[k], d[k], v[k], one, pairs, reach, touching[k])
        force = random.normal(size=len(state["contact_pairs"])) * PAIR.pull_off_force
        kept.append({**state, "contact_normal_force": force})
    return write_run(path, about, history, kept, ended)


def answered(capsys, study, *arguments):
    """({quantity: row}, number of runs that count, lines on stderr) of what a study answers as JSON."""
    assert main(["study", str(study), *map(str, arguments), "--json"]) == 0
    out, err = capsys.readouterr()
    answer = json.loads(out)
    return {row["quantity"]: row for row in answer["rows"]}, answer["runs"], err
