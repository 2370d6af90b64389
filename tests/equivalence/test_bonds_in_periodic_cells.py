"""Sintered bonds in periodic cells: the fused engine against the functors step by step, and its own ledger."""

import pytest
from scenes import *

pytestmark = pytest.mark.in_yade
WORK = "boundaryWork"


def start(kind="like", rate=0.0, homo=0, step=0.05, seed=1, side=3, speed=12.0, mover="functors"):
    """A cubic lattice of touching grains that closes on itself through the boundaries, some of them in other
    periods; each with some velocity and spin."""
    new_scene(step * unit, mover, neck=0.4)
    materials, radii = ([ice(), soft()], [1e-7, 1.1e-7]) if kind == "unlike" else KINDS[kind]
    random = np.random.default_rng(seed)
    size = np.full(3, side * 1.985 * np.mean(radii))
    periodic_cell(*size, homo=homo, velocity_gradient=-rate / unit * np.array([1, 0.7, 0.4]))
    for k in range(side**3):
        site = np.array([k % side, k // side % side, k // side**2])
        x = size * (site + 0.5) / side + size * random.integers(-1, 2, size=3)
        n = k + k // side + k // side**2 if kind == "unlike" else k
        velocity, spin = speed * random.normal(size=3), 1e7 * speed * random.normal(size=3)
        grain(x, radii[n % len(radii)], materials[n % len(materials)], velocity, spin)


@pytest.mark.parametrize("kind,rate,homo", [("like", 0, 0), ("unlike", 0, 2), ("like", 2e-3, 0), ("drag", 2e-3, 1)])
def test_engine_and_functors_agree_step_by_step(kind, rate, homo):
    """As for ordinary contacts (test_periodic.py): with prepare() the engine takes the velocity gradient at once.
    Where the grains have a mean field, boundaryWork of the functors does not know of it; in a changing cell YADE
    counts kinetic energy from velGrad times position."""
    side = 4 if kind == "unlike" else 3
    start(kind, rate, homo, side=side)
    functors, of_functors = record(201, WORK), broken()
    start(kind, rate, homo, side=side, mover="fused")
    O.engines[0].prepare()
    bonds = O.engines[0].statistics()["bonds"]
    engine, of_engine = record(200, WORK), broken()
    assert bonds > 40 and sum(of_engine) > 10
    assert np.abs(np.subtract(of_engine, of_functors)).sum() <= 1
    assert (engine[1][-1][WORK] != 0) == (rate != 0)
    left_out = {"kinetic", *([WORK] if homo else [])} if rate else set()
    difference, energy = compared(functors, engine, {*CHANNELS, WORK} - left_out)
    assert difference[:60].max() < 1e-11 and difference.max() < 1e-7
    assert max(energy.values()) < 1e-7


@pytest.mark.parametrize("homo", [0, 2])
def test_ledger_of_bonds_in_a_shrinking_cell_closes_with_second_order(homo):
    """Root mean square over six scenes of the largest closure error over the first kinetic energy, at steps a factor
    4 apart: second order gives 16, first order 4."""

    def closure(step, seed):
        start("like", 1e-3, homo, step, seed, mover="fused")
        O.engines[0].prepare()
        kinetic = energies()["kinetic"]
        worst = largest_change(round(12 / step), WORK) / kinetic
        assert sum(broken()) > 5 and abs(energies(WORK)[WORK]) > 1e-3 * kinetic
        return worst

    coarse, fine = (rms(closure(step, seed) for seed in range(6)) for step in (0.08, 0.02))
    assert coarse < 2e-2 and coarse / fine > 9
