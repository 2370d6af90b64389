"""JKRWadaEngine in periodic cells against the functors, step by step; images across every side."""

import pytest
from scenes import *

pytestmark = pytest.mark.in_yade
WORK = "boundaryWork"


def start(kind, rate, homo, count=27, **options):
    """Grains on a loose lattice that fills the cell, shrinking by `rate` a time unit, and each with some velocity
    and spin; some lie in other periods."""
    new_scene(0.1 * unit, **options)
    materials, radii = KINDS[kind]
    random = np.random.default_rng(1)
    side = int(round(count ** (1 / 3)))
    size = side * 1.02 * 2 * max(radii)
    gradient = -rate / unit * np.array([1, 0.7, 0.4])
    periodic_cell(size, 1.02 * size, 1.04 * size, homo=homo, velocity_gradient=gradient)
    for k in range(count):
        site = np.array([k % side, k // side % side, k // side**2]) + 0.5 + 0.001 * random.normal(size=3)
        x = size * site / side + size * random.integers(-1, 2, size=3) * (1, 1.02, 1.04)
        velocity, spin = 3 * random.normal(size=3), 2e7 * random.normal(size=3)
        grain(x, radii[k % len(radii)], materials[k % len(materials)], velocity, spin)


def cell_size():
    return np.array([O.cell.hSize[k, k] for k in range(3)])


def record_with_sizes(n):
    """record(n), and the cell's sizes (n, 3) ahead of each step."""
    sizes = []
    return record(n, WORK, before=lambda k: sizes.append(cell_size())), np.array(sizes)


AT_REST = [("like", 0, 2, "held"), ("unlike", 0, 0, "held")]
SHRINKING = [("like", 0, "held"), ("drag", 1, "held"), ("unlike", 1, "held"), ("like", 2, "held"), ("drag", 0, "cut")]


@pytest.mark.parametrize("kind,rate,homo,limit", AT_REST + [(kind, 2e-3, *how) for kind, *how in SHRINKING])
def test_engine_and_functors_agree_step_by_step(kind, rate, homo, limit):
    """Grains of which some lie in other periods than their neighbours, in a cell at rest, in a shrinking one through
    which they fly (homoDeform 0), and in one whose mean field moves them.

    With prepare() the engine takes the velocity gradient at once, so that its cell is an update ahead of the
    functors' O.cell at the same grains' positions: the functors' forces at these positions see the same size. In the
    first step with a mean field NewtonIntegrator leaves its convective term (homoDeform 2) out; the velocities that
    the functors are given have what the engine's have of it. Not compared: boundaryWork of the functors, which does
    not know of mean fields, and YADE's kinetic energy, in which velocities are counted from velGrad times position."""
    start(kind, rate, homo, limit=limit)
    if homo == 2 and rate:
        gradient = np.diag(np.array(O.cell.nextVelGrad).reshape(3, 3))
        for b in O.bodies:
            mean = gradient * np.array(b.state.pos)
            whole = (np.array(b.state.vel) + mean) * (1 + gradient * O.dt) / (1 + gradient * O.dt / 2)
            b.state.vel = Vector3(whole - mean)
    functors, functor_sizes = record_with_sizes(301)
    start(kind, rate, homo, mover="fused", limit=limit)
    O.engines[0].prepare()
    engine, sizes = record_with_sizes(300)
    last = engine[1][-1]
    assert O.engines[0].statistics()["events"] > 50 and last["connection"] > 0 and last["slidingDissipation"] > 0
    assert (last[WORK] != 0) == (rate != 0)
    assert np.abs(functor_sizes[2:] - sizes[1:]).max() < 1e-12 * 1e-7
    left_out = {"kinetic", *([WORK] if homo else [])} if rate else set()
    difference, energy = compared(functors, engine, {*CHANNELS, WORK} - left_out)
    assert difference[:100].max() < 1e-12 and difference.max() < 1e-9 and max(energy.values()) < 1e-9


def test_exported_interactions_are_those_of_the_nearest_images():
    start("unlike", 1e-3, 1)
    engine_of_sub_steps(10, exportInteractions=True)
    O.run(100, True)
    size, crossing = cell_size(), 0
    for i in O.interactions:
        a, b = O.bodies[i.id1], O.bodies[i.id2]
        branch = np.array(b.state.pos) + size * np.array(i.cellDist) - np.array(a.state.pos)
        distance = np.linalg.norm(branch)
        assert np.abs(branch / distance - np.array(i.geom.normal)).max() < 1e-12
        assert abs(a.shape.radius + b.shape.radius - distance - i.geom.penetrationDepth) < 1e-12 * 1e-7
        crossing += any(i.cellDist)
    assert crossing > 5


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_grains_touch_across_the_longest_side(axis):
    """Their nearest images follow from that side's own length."""
    new_scene(0.1 * unit)
    across = np.eye(3)[axis]
    size = 6e-7 * (1 + 2 * across)
    periodic_cell(*size)
    half = 1e-7 - constants(ice(), 1e-7)["equilibriumOverlap"] / 2
    for sign in (1, -1):
        grain(size / 2 * (1 - across) + (sign * half) % size * across, 1e-7, ice())
    fused_engine()
    O.step()
    assert O.engines[0].statistics()["contacts"] == 1
