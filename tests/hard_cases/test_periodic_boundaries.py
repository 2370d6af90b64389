"""What periodic cells do to careless codes: grains in contact that cross boundaries, cells too small or too skew,
scripts that change the cell."""

import pytest
from changes import require_refused, run
from scenes import *

pytestmark = pytest.mark.in_yade


def box(size, mover="fused", **options):
    """An empty periodic cell with edges `size` [m]."""
    new_scene(0.1 * unit, mover, **options)
    periodic_cell(*size, homo=0)


def shrinking(rate):
    return Matrix3.Identity * (-rate / unit)


@pytest.mark.parametrize("mover", ["fused", "functors"])
def test_nothing_happens_to_grains_in_contact_that_cross_a_boundary(mover):
    """Six touching grains that fly, spin and slip across all three boundaries, through more than a whole cell: the
    same as in open space, but for rounding."""

    def fly(periodic):
        box((1.5e-6, 1.5e-6, 1.5e-6), mover)
        O.periodic = periodic
        cluster(6, 3, [ice(viscoelasticTime=1e-12)], [1e-7], speed=2.0, spin=2e7)
        for b in O.bodies:
            b.state.pos += Vector3(1.2e-6, 0.75e-6, 0.3e-6)
            b.state.vel += Vector3(200, -160, 120)
        tracks = []
        for _ in range(45):
            O.run(20, True)
            tracks.append(positions())
        return np.array(tracks), energies()

    (inside, sums), (open_space, others) = fly(True), fly(False)
    crossed = np.ptp(np.floor(inside / 1.5e-6), axis=0)
    assert crossed.min() >= 1  # every grain, every boundary
    assert sums["slidingDissipation"] > 0 and sums["drag"] > 0
    assert np.abs(inside - open_space).max() < 1e-8 * 1e-7
    for name in set(CHANNELS) - {"kinetic"}:
        assert abs(sums[name] - others[name]) < 1e-8 * (sums["slidingDissipation"] + sums["drag"]), name


def test_neighbours_are_found_in_cells_of_few_grains():
    """The smallest cell that may be, one grid cell an axis at times: as many contacts as all pairs' nearest images
    have."""
    size = np.array([5.7e-7, 6.5e-7, 9e-7])
    box(size)
    distance = lambda x, y: np.linalg.norm(x - y - size * np.round((x - y) / size), axis=-1)
    random, placed = np.random.default_rng(4), np.empty((0, 3))
    while len(placed) < 24:
        x = size * random.random(3)
        if (distance(x, placed) > 1.9e-7).all():
            placed = np.vstack([placed, x])
    for x in placed:
        grain(x + size * random.integers(-3, 4, size=3), 1e-7, ice())
    O.engines[0].prepare()
    touching = np.count_nonzero(np.triu(distance(positions()[:, None], positions()) < 2e-7, 1))
    assert O.engines[0].statistics()["contacts"] == touching > 3


def test_a_shrinking_cell_stops_the_run_before_it_is_too_small():
    box((6e-7, 8e-7, 8e-7), subSteps=10)
    grain((1e-7, 0, 0), 1e-7, ice())
    O.cell.velGrad = shrinking(1e-4)
    message = refusal(steps=1000)
    for words in ("the periodic cell of (5.59", "too small: must be at least 5.6", "the last good state"):
        assert words in message and "\n" not in message
    assert O.bodies[0].state.pos[0] == 1e-7
    assert O.time / O.dt == pytest.approx(np.log(6 / 5.6) / 1e-4, rel=0.001)


CELLS = {
    "O.cell.hSize = Matrix3(1e-6, 1e-8, 0, 0, 1e-6, 0, 0, 0, 1e-6)": [
        "hSize has the element (0, 1) = 1e-08",
        "diagonal",
    ],
    "O.cell.velGrad = Matrix3(0, 1e3, 0, 0, 0, 0, 0, 0, 0); O.step(); O.step()": ["YADE's own loop", "two plates"],
    "O.cell.setBox(1e-6, 5e-7, 1e-6)": ["cell of (1e-06, 5e-07, 1e-06) m is too small", "at least 5.6"],
    "O.run(3, True); O.cell.velGrad = shrinking(0.8); O.step()": [
        "by more than half the smallest radius in a small step"
    ],
}


def test_cells_that_the_engine_cannot_follow_are_refused_in_one_line():
    def attempt(text):
        box((1e-6, 1e-6, 1e-6))
        for x in (0, 3e-7):
            grain((x, 0, 0), 1e-7, ice())
        run(text, shrinking=shrinking)
        O.step()

    require_refused(CELLS, attempt)
