"""Whatever the neighbour lists do, grains that overlap are in contact: looked for among all pairs, every few small steps."""

import pytest

SCENE = """
from scenes import *
from scipy.spatial import cKDTree
unit = constants(ice(), 1e-7)["timeUnit"]

def missed():
    "Overlapping pairs without a contact, and how many overlap."
    now = contact_law.snapshot()
    x, r = now["position"], now["radius"]
    box = None
    if O.periodic:
        box = np.array(O.cell.size)
        x = x % box
    tree = cKDTree(x, boxsize=box)
    pairs = tree.query_pairs(2 * r.max(), output_type="ndarray")
    d = x[pairs[:, 0]] - x[pairs[:, 1]]
    if O.periodic: d -= box * np.round(d / box)
    overlaps = pairs[np.linalg.norm(d, axis=1) < (1 - 1e-9) * (r[pairs[:, 0]] + r[pairs[:, 1]])]
    touching = {tuple(sorted(pair)) for pair in now["contact_pairs"].tolist()}
    return [pair for pair in overlaps.tolist() if tuple(sorted(pair)) not in touching], len(overlaps)

def watch(steps):
    found, most = [], 0
    for _ in range(steps):
        O.step()
        lost, count = missed()
        found += lost
        most = max(most, count)
    result.update(missed=len(found), overlapping=most, statistics=O.engines[0].statistics())
"""

COLLIDING = {
    "slow": {"speed": 3.0, "steps": 150},
    "fast": {"speed": 15.0, "steps": 250},
    "faster": {"speed": 60.0, "steps": 250},
}


@pytest.mark.parametrize("case", COLLIDING)
@pytest.mark.parametrize("radii", [[1e-7], [1e-7, 1.7e-7, 1.2e-7]], ids=["equal", "unlike"])
def test_grains_that_meet_and_fly_apart(yade, case, radii):
    found = yade(
        SCENE
        + """
speed, radii = parameters["speed"], parameters["radii"]
new_scene(0.1 * unit)
converging(400, 2, [ice()], radii, speed=speed)
fused_engine(domains=4, threads=2, subSteps=23)
O.dt *= 23
watch(parameters["steps"])
""",
        {**COLLIDING[case], "radii": radii},
    )
    assert found["overlapping"] > 400
    assert found["missed"] == 0, found
    if case == "faster":
        assert found["statistics"]["orders"] >= 1


def test_a_shrinking_cell_whose_rate_jumps(yade):
    """Images approach at the rate of the cell, which changes from one O.step to the next."""
    found = yade(
        SCENE
        + """
new_scene(0.1 * unit)
O.periodic = True
edge = 2.6e-6
O.cell.setBox(edge, edge, edge)
O.cell.homoDeform = 0
random = np.random.default_rng(3)
for site in np.ndindex(7, 7, 7):
    grain(edge * (np.array(site) + 0.5) / 7 + 2e-8 * random.normal(size=3), 1e-7, ice(), 0.3 * random.normal(size=3))
fused_engine(domains=3, threads=2, subSteps=20)
O.dt *= 20
found, most = [], 0
for k in range(200):
    rate = -[0, 2e6, 1e7, 0, 4e7, -1e7][k // 10 % 6]
    O.cell.velGrad = Matrix3(rate, 0, 0, 0, 0.5 * rate, 0, 0, 0, 0.7 * rate)
    O.step()
    lost, count = missed()
    found += lost
    most = max(most, count)
result.update(missed=len(found), overlapping=most, size=list(O.cell.size))
"""
    )
    assert found["overlapping"] > 100, found
    assert found["missed"] == 0, found
