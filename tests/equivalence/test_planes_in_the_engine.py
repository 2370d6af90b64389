"""Grains on planes (Walls) with JKRWadaEngine: against the functors (to rounding, step by step), in both directions
of handing over, and against itself: threads, checkpoints, changes by a script."""

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


@pytest.mark.parametrize("limit", ["held", "cut"])
@pytest.mark.parametrize("kind", ["like", "unlike", "drag"])
def test_engine_and_functors_agree_step_by_step(kind, limit):
    walls = start(kind, limit=limit)
    functors = record(401, "constraintWork")
    touching, forces = on_planes(), [np.array(O.forces.f(wall)) for wall in walls]
    start(kind, mover="fused", limit=limit)
    engine = record(400, "constraintWork")
    difference, energy = compared(functors, engine, [*CHANNELS, "constraintWork"])
    assert difference[:100].max() < 1e-12 and difference.max() < 1e-9 and max(energy.values()) < 1e-9
    assert abs(engine[1][-1]["constraintWork"]) > 1e-3 * engine[1][0]["kinetic"]
    assert on_planes() == touching == O.engines[0].statistics()["planeContacts"] > 4
    for wall, force in zip(walls, forces):
        assert np.abs(np.array(O.forces.f(wall)) - force).max() < 1e-6 * constants(ice(), 1e-7)["pullOffForce"]


@pytest.mark.parametrize("kind", ["like", "drag"])
@pytest.mark.parametrize("first", ["functors", "engine"])
def test_handed_over_in_the_middle(kind, first):
    """15 t0 with one, 3 with the other, as with the functors alone, to first order: at steps a factor 4 apart, 4."""

    def error(finer):
        start(kind)
        O.dt /= finer
        O.run(180 * finer, True)
        straight = positions()
        start(kind)
        O.dt /= finer
        functors = O.engines
        for engines in (functors, [JKRWadaEngine(orientations=True)])[:: 1 if first == "functors" else -1]:
            O.engines = engines
            O.run((150 if O.iter == 0 else 30) * finer, True)
        assert on_planes() > 4
        return np.abs(positions() - straight).max() / 1e-7

    coarse, fine = error(1), error(4)
    assert fine < coarse / 3 and coarse < 1e-2


def test_a_plane_moved_or_stopped_by_the_script():
    """Obeyed from the next step on, as by the functors (which see the step before with the velocity set after it)."""

    def end(mover):
        rest, piston = start(mover=mover)
        O.run(100, True)
        O.bodies[piston].state.vel = (0, 0, 3)
        O.bodies[rest].state.pos += Vector3(-1e-9, 0, 0)
        O.run(100, True)
        return positions(), positions()[[rest, piston]]

    (x, planes), (y, same_planes) = end("functors"), end("fused")
    assert (planes == same_planes).all() and np.abs(x - y).max() < 3e-10


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
    changed = f"body {wall.id}, a Wall, was replaced or changed"
    infinite = f"body {wall.id}, a Wall, has a position or velocity that is not a finite number"
    for change, undo, words in (
        ("wall.mask = 2", "wall.mask = 1", changed),
        ("wall.bounded = not wall.bounded", "wall.bounded = not wall.bounded", changed),
        ("kept = wall.state.pos; wall.state.pos = (nan, 0, 0)", "wall.state.pos = kept", infinite),
    ):
        names = dict(wall=wall, nan=float("nan"))
        exec(change, names)
        assert words in refusal()
        exec(undo, names)
        assert not refusal()
    wall.state.vel = (float("nan"), 0, 0)
    fused_engine()
    assert infinite in refusal()
    wall.state.vel = Vector3.Zero
    O.step()
    O.bodies.erase(wall.id)
    assert changed in refusal()
