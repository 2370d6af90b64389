"""The virial's stress against the force on walls: loose grains pressed between two plates of fixed ones."""

import numpy as np
import pytest

from analysis.theory import ICE, pair_constants

PAIR = pair_constants(ICE, 1e-7)

PRESS = """
from scenes import *
from analysis.measures.virial import contact_stress
R, unit = 1e-7, constants(ice(), 1e-7)["timeUnit"]
# Periodic along y and z; along x so long that the plates' backs and images are out of reach.
new_scene(0.2 * unit, damping=0.2)
rows = 3
width = 2 * R * rows
O.periodic = True
O.cell.setBox(40 * R, width, width)
random = np.random.default_rng(3)
site = np.stack(np.meshgrid(np.arange(rows), np.arange(rows)), axis=-1).reshape(-1, 2)
plates = [[grain((x, *(2 * s + 1) * R), R, ice(), blocked="xyzXYZ") for s in site] for x in (13 * R, 27 * R)]
loose = []
while len(loose) < 24:
    x = np.array([random.uniform(15.2 * R, 24.8 * R), *random.uniform(0, width, 2)])
    away = np.array(loose).reshape(-1, 3) - x
    away[:, 1:] -= width * np.round(away[:, 1:] / width)
    if not len(loose) or np.linalg.norm(away, axis=1).min() > 2.02 * R:
        loose.append(x)
for x in loose:
    grain(x, R, ice())

def move(speed, steps):
    for plate, v in zip(plates, (speed, -speed)):
        for k in plate:
            O.bodies[k].state.vel = (v, 0, 0)
    O.run(steps, True)

def measured():
    contacts = [i for i in O.interactions if i.isReal]
    x, cell = positions(), np.array(O.cell.size)
    pairs = np.array([(i.id1, i.id2) for i in contacts])
    force = -np.array([i.phys.normalForce + i.phys.shearForce for i in contacts])  # on the first
    apart = x[plates[1][0], 0] - x[plates[0][0], 0]
    stress = contact_stress(x, pairs, force, cell) * np.prod(cell) / (apart * width**2)
    pushed = [sum(O.forces.f(k)[0] for k in plate) / width**2 for plate in plates]
    return [stress[0, 0], -pushed[0], pushed[1]]

result["rows"] = []
move(1.0, 6600)
for _ in range(2):
    move(1.0, 600)
    move(0.0, 2000)
    over_time = []
    for _ in range(280):
        O.step()
        if O.iter % 7 == 0:
            over_time.append(measured())
    result["rows"].append(dict(zip(("virial", "left", "right"), np.mean(over_time, axis=0))))
result["slid"] = dict(O.energy.items())["slidingDissipation"]
"""


def test_stress_is_the_force_on_the_plates(yade):
    """With the plates at rest each is pushed by the virial's stress along x, tangential forces included, times its area: the
    force through every plane between their centres is the same, in the mean over time. Vibrations that rolling and twisting
    springs keep, undamped, average to less than a thousandth of a contact's force on the area of a grain."""
    found = yade(PRESS)
    rows = found["rows"]
    scale = PAIR.pull_off_force / 4e-14  # of a contact on the area of a grain
    for row in rows:
        assert row["left"] == pytest.approx(row["virial"], abs=1e-3 * scale), row
        assert row["right"] == pytest.approx(row["virial"], abs=1e-3 * scale), row
    virial = np.array([row["virial"] for row in rows])
    assert virial[-1] > 0.1 * scale and np.ptp(virial) > 0.1 * scale
    assert found["slid"] > 0  # grains have rearranged, no crystal is pressed
