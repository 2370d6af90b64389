"""Whatever the neighbour lists do, grains that overlap are in contact: looked for among all pairs, every few small
steps."""

import pytest
from scenes import *
from scipy.spatial import cKDTree

pytestmark = pytest.mark.in_yade


def missed():
    """Overlapping pairs without a contact, and how many overlap."""
    now = contact_law.snapshot()
    x, r = now["position"], now["radius"]
    box = np.array(O.cell.size) if O.periodic else None
    if O.periodic:
        x = x % box
    pairs = cKDTree(x, boxsize=box).query_pairs(2 * r.max(), output_type="ndarray")
    d = x[pairs[:, 0]] - x[pairs[:, 1]]
    if O.periodic:
        d -= box * np.round(d / box)
    overlaps = pairs[np.linalg.norm(d, axis=1) < (1 - 1e-9) * (r[pairs[:, 0]] + r[pairs[:, 1]])]
    touching = {tuple(sorted(pair)) for pair in now["contact_pairs"].tolist()}
    return [pair for pair in overlaps.tolist() if tuple(sorted(pair)) not in touching], len(overlaps)


def most_overlapping(steps, before_each=lambda k: None):
    """The largest number of pairs that overlapped after any of so many steps, of which none may be missed."""
    most = 0
    for k in range(steps):
        before_each(k)
        O.step()
        lost, count = missed()
        assert lost == []
        most = max(most, count)
    return most


@pytest.mark.parametrize("speed, steps", [(3.0, 150), (15.0, 250), (60.0, 250)])
@pytest.mark.parametrize("radii", [[1e-7], [1e-7, 1.7e-7, 1.2e-7]], ids=["equal", "unlike"])
def test_grains_that_meet_and_fly_apart(speed, steps, radii):
    new_scene(0.1 * unit)
    converging(400, 2, [ice()], radii, speed=speed)
    engine_of_sub_steps(23, domains=4, threads=2)
    assert most_overlapping(steps) > 400
    assert speed < 60 or O.engines[0].statistics()["orders"] >= 1


def test_a_shrinking_cell_whose_rate_jumps():
    """Images approach at the rate of the cell, which changes from one O.step to the next."""
    new_scene(0.1 * unit)
    edge = 2.6e-6
    periodic_cell(edge, edge, edge, homo=0)
    random = np.random.default_rng(3)
    for site in np.ndindex(7, 7, 7):
        place = edge * (np.array(site) + 0.5) / 7 + 2e-8 * random.normal(size=3)
        grain(place, 1e-7, ice(), 0.3 * random.normal(size=3))
    engine_of_sub_steps(20, domains=3, threads=2)

    def jump(k):
        rate = -[0, 2e6, 1e7, 0, 4e7, -1e7][k // 10 % 6]
        O.cell.velGrad = Matrix3(rate, 0, 0, 0, 0.5 * rate, 0, 0, 0, 0.7 * rate)

    assert most_overlapping(200, jump) > 100


def test_steps_that_are_counted_anew():
    """The lists' counter of small steps ends 1,000 after the start for the first time; had it no end, pairs that
    touch would count as due, and form another contact, 10,000 later."""
    new_scene(0.1 * unit)
    for x, speed in ((0, 0), (1.99e-7, 0), (5e-7, -0.4)):
        grain((x, 0, 0), 1e-7, ice(), (speed, 0, 0))
    engine_of_sub_steps(500)
    counts = set()
    assert most_overlapping(40, lambda k: counts.add(O.engines[0].statistics()["contacts"] if k else 1)) == 2
    assert counts == {1, 2}
