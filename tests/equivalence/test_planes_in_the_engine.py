"""Grains on planes (Walls) with JKRWadaEngine: against the functors, to rounding and step by step, and in a cell."""

import pytest
from scenes import *

pytestmark = pytest.mark.in_yade


def start(kind="like", count=27, **options):
    """Grains that fly together, through a plane at rest (the first body) and pushed by one of soft() (the last):
    (wall, wall)."""
    new_scene(0.1 * unit, **options)
    r, layers = max(KINDS[kind][1]), np.ceil(count ** (1 / 3))
    rest = O.bodies.append(utils.wall(2.02 * r * (layers / 2 - 1) + 0.06 * r, axis=0, material=ice()))
    converging(count, 1, *KINDS[kind])
    for body in O.bodies:
        if body.id != rest and body.state.pos[0] > 2.02 * r * (layers / 2 - 1):
            body.state.pos += Vector3(0.12 * r, 0, 0)
    piston = O.bodies.append(utils.wall(2.02 * r * layers / 2 + 0.06 * r, axis=2, material=soft()))
    O.bodies[piston].state.vel = (0.5, 0, -5 * layers)
    return rest, piston


def on_planes():
    if isinstance(O.engines[0], JKRWadaEngine):
        O.engines[0].writeInteractions()
    return sum(isinstance(O.bodies[i.id1].shape, Wall) for i in O.interactions if i.isReal)


@pytest.mark.parametrize("instructions", ["", "portable"])
@pytest.mark.parametrize("limit", ["held", "cut"])
@pytest.mark.parametrize("kind", ["like", "unlike", "drag"])
def test_engine_and_functors_agree_step_by_step(kind, limit, instructions):
    walls = start(kind, limit=limit)
    functors = record(401, "constraintWork")
    touching, forces = on_planes(), [np.array(O.forces.f(wall)) for wall in walls]
    start(kind, mover="fused", limit=limit, instructions=instructions)
    engine = record(400, "constraintWork")
    difference, energy = compared(functors, engine, [*CHANNELS, "constraintWork"])
    assert difference[:100].max() < 1e-12 and difference.max() < 1e-9 and max(energy.values()) < 1e-9
    assert abs(engine[1][-1]["constraintWork"]) > 1e-3 * engine[1][0]["kinetic"]
    assert on_planes() == touching == O.engines[0].statistics()["planeContacts"] > 4
    for wall, force in zip(walls, forces):
        assert np.abs(np.array(O.forces.f(wall)) - force).max() < 1e-6 * constants(ice(), 1e-7)["pullOffForce"]


def test_in_a_wide_periodic_cell_as_in_the_open():
    def end(periodic):
        start(mover="fused")
        if periodic:
            periodic_cell(1e-5, 1e-5, 1e-5)
        O.run(150, True)
        assert O.engines[0].statistics()["planeContacts"] > 4
        return positions()

    assert np.abs(end(True) - end(False)).max() < 1e-12 * 1e-7
    end(True)
    O.cell.velGrad = Matrix3(-1e3, 0, 0, 0, 0, 0, 0, 0, 0)
    assert "a Wall: O.cell.velGrad must be zero: planes do not move with a cell" in refusal()
    end(False)
    wall = next(b for b in O.bodies if isinstance(b.shape, Wall))
    wall.state.vel = (float("nan"), 0, 0)
    assert f"body {wall.id}, a Wall, has a position or velocity that is not a finite number" in refusal()
    wall.state.vel = Vector3.Zero
    wall.mask = 2
    assert f"body {wall.id}, a Wall, was replaced or changed" in refusal()
