"""The virial's stress against the force on walls: loose grains pressed between two plates of fixed ones."""

import pytest
from scenes import *

from analysis.measures.virial import contact_stress

R, ROWS = 1e-7, 3
WIDTH = 2 * R * ROWS


def plates_with_grains_between():
    """Ids of the grains of both plates. Periodic along y and z; along x so long that the plates' backs and images are out of reach."""
    new_scene(0.2 * unit, damping=0.2)
    periodic_cell(40 * R, WIDTH, WIDTH)
    random = np.random.default_rng(3)
    site = np.stack(np.meshgrid(np.arange(ROWS), np.arange(ROWS)), axis=-1).reshape(-1, 2)
    plates = [[grain((x, *(2 * s + 1) * R), R, ice(), blocked="xyzXYZ") for s in site] for x in (13 * R, 27 * R)]
    loose = []
    while len(loose) < 24:
        x = np.array([random.uniform(15.2 * R, 24.8 * R), *random.uniform(0, WIDTH, 2)])
        away = np.array(loose).reshape(-1, 3) - x
        away[:, 1:] -= WIDTH * np.round(away[:, 1:] / WIDTH)
        if not len(loose) or np.linalg.norm(away, axis=1).min() > 2.02 * R:
            loose.append(x)
    for x in loose:
        grain(x, R, ice())
    return plates


def move(plates, speed, steps):
    for plate, v in zip(plates, (speed, -speed)):
        for k in plate:
            O.bodies[k].state.vel = (v, 0, 0)
    O.run(steps, True)


def measured(plates):
    """Pressure [Pa] along x by the virial, on the left and on the right plate."""
    contacts = [i for i in O.interactions if i.isReal]
    x, cell = positions(), np.array(O.cell.size)
    pairs = np.array([(i.id1, i.id2) for i in contacts])
    force = -np.array([i.phys.normalForce + i.phys.shearForce for i in contacts])  # on the first
    apart = x[plates[1][0], 0] - x[plates[0][0], 0]
    stress = contact_stress(x, pairs, force, cell) * np.prod(cell) / (apart * WIDTH**2)
    pushed = [sum(O.forces.f(k)[0] for k in plate) / WIDTH**2 for plate in plates]
    return stress[0, 0], -pushed[0], pushed[1]


@pytest.mark.in_yade
def test_stress_is_the_force_on_the_plates():
    """With the plates at rest each is pushed by the virial's stress along x, tangential forces included, times its area: the
    force through every plane between their centres is the same, in the mean over time. Vibrations that rolling and twisting
    springs keep, undamped, average to less than a thousandth of a contact's force on the area of a grain."""
    plates = plates_with_grains_between()
    move(plates, 1.0, 6600)
    scale, virials = constants(ice(), R)["pullOffForce"] / 4e-14, []  # of a contact on the area of a grain
    for _ in range(2):
        move(plates, 1.0, 600)
        move(plates, 0.0, 2000)
        over_time = []
        for _ in range(280):
            O.step()
            if O.iter % 7 == 0:
                over_time.append(measured(plates))
        virial, left, right = np.mean(over_time, axis=0)
        assert left == pytest.approx(virial, abs=1e-3 * scale) and right == pytest.approx(virial, abs=1e-3 * scale)
        virials.append(virial)
    assert virials[-1] > 0.1 * scale and np.ptp(virials) > 0.1 * scale
    assert energies()["slidingDissipation"] > 0  # grains have rearranged, no crystal is pressed
