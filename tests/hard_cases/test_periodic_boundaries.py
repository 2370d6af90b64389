"""What periodic cells do to careless codes: grains in contact that cross boundaries, cells too small or too skew, scripts that change the cell."""

import numpy as np
import pytest

SCENE = """
from scenes import *
unit = constants(ice(), 1e-7)["timeUnit"]
def box(size, step=0.1, homo=0, **options):
    new_scene(step * unit)
    O.periodic = True
    O.cell.setBox(*size)
    O.cell.homoDeform = homo
    if parameters.get("mover", "fused") == "fused":
        fused_engine(**options)
def shrinking(rate):
    return Matrix3(-rate / unit, 0, 0, 0, -rate / unit, 0, 0, 0, -rate / unit)
"""


@pytest.mark.parametrize("mover", ["fused", "functors"])
def test_nothing_happens_to_grains_in_contact_that_cross_a_boundary(yade, mover):
    """Six touching grains that fly, spin and slip across all three boundaries, through more than a whole cell: the same as in open space, but for rounding."""
    found = yade(
        SCENE
        + """
def fly(periodic):
    if periodic: box((1.5e-6, 1.5e-6, 1.5e-6))
    else:
        new_scene(0.1 * unit)
        if parameters["mover"] == "fused": fused_engine()
    cluster(6, 3, [ice(viscoelasticTime=1e-12)], [1e-7], speed=2.0, spin=2e7)
    for b in O.bodies:
        b.state.pos += Vector3(1.2e-6, 0.75e-6, 0.3e-6)
        b.state.vel += Vector3(200, -160, 120)
    tracks = []
    for _ in range(45):
        O.run(20, True)
        tracks.append(positions())
    return np.array(tracks), energies()
inside, sums = fly(True)
open_space, others = fly(False)
result["difference"] = float(np.abs(inside - open_space).max() / 1e-7)
result["cells"] = [int(np.ptp(np.floor(inside[:, :, k] / 1.5e-6), axis=0).min()) for k in range(3)]
result["energies"] = max(abs(sums[n] - others[n]) for n in CHANNELS if n != "kinetic") / (sums["slidingDissipation"] + sums["drag"])
result["lost"] = sums
""",
        {"mover": mover},
    )
    assert min(found["cells"]) >= 1  # every grain has crossed every boundary
    assert found["lost"]["slidingDissipation"] > 0 and found["lost"]["drag"] > 0
    assert found["difference"] < 1e-8 and found["energies"] < 1e-8, found


def test_neighbours_are_found_in_cells_of_few_grains(yade):
    """The smallest cell that may be, one grid cell an axis at times: as many contacts as all pairs' nearest images have."""
    found = yade(
        SCENE
        + """
size = np.array([5.7e-7, 6.5e-7, 9e-7])
box(size)
random = np.random.default_rng(4)
placed = []
while len(placed) < 40:
    x = size * random.random(3)
    if all(np.linalg.norm((x - y) - size * np.round((x - y) / size)) > 1.9e-7 for y in placed) or len(placed) > 24:
        placed.append(x)
    if len(placed) > 24: break
for x in placed[:24]:
    grain(x + size * random.integers(-3, 4, size=3), 1e-7, ice())
O.engines[0].prepare()
apart = positions()[:, None] - positions()[None]
apart -= size * np.round(apart / size)
result["wanted"] = int((np.linalg.norm(apart, axis=2)[np.triu_indices(len(apart), 1)] < 2e-7).sum())
result["contacts"] = O.engines[0].statistics()["contacts"]
"""
    )
    assert found["contacts"] == found["wanted"] > 3


def test_a_shrinking_cell_stops_the_run_before_it_is_too_small(yade):
    found = yade(
        SCENE
        + """
box((6e-7, 8e-7, 8e-7), subSteps=10)
O.dt *= 10
grain((1e-7, 0, 0), 1e-7, ice())
O.cell.velGrad = shrinking(1e-4)
result["message"] = refusal(steps=1000)
result["position"] = O.bodies[0].state.pos[0]
result["stopped"] = [O.time / O.dt, O.cell.hSize[0, 0]]
"""
    )
    assert "the periodic cell of (5.59" in found["message"] and "too small: must be at least 5.6" in found["message"]
    assert "the last good state" in found["message"] and "\n" not in found["message"]
    assert found["position"] == 1e-7 and found["stopped"][0] == pytest.approx(np.log(6 / 5.6) / 1e-4, rel=0.001)


@pytest.mark.parametrize(
    "change,message",
    [
        (
            "O.cell.hSize = Matrix3(1e-6, 1e-8, 0, 0, 1e-6, 0, 0, 0, 1e-6)",
            "O.cell.hSize has the element (0, 1) = 1e-08: must be a box along the axes (diagonal)",
        ),
        (
            "O.cell.velGrad = Matrix3(0, 0, 1, 0, 0, 0, 0, 0, 0)",
            "O.cell.velGrad has the element (0, 2) = 1: must be stretching along the axes (diagonal)",
        ),
        (
            "O.cell.velGrad = Matrix3(float('nan'), 0, 0, 0, 0, 0, 0, 0, 0)",
            "O.cell.velGrad has the element (0, 0) = nan",
        ),
        (
            "O.cell.setBox(1e-6, 5e-7, 1e-6)",
            "the periodic cell of (1e-06, 5e-07, 1e-06) m is too small: must be at least 5.6",
        ),
        (
            "O.run(3, True); O.cell.setBox(2e-6, 2e-6, 2e-6)",
            "O.cell was given another size (2e-06, 2e-06, 2e-06) m by a script, after the start with (1e-06, 1e-06, 1e-06) m",
        ),
        (
            "O.run(3, True); O.periodic = False",
            "O.periodic was changed after the start: it must stay True; make a new engine",
        ),
        (
            "O.run(3, True); O.cell.velGrad = shrinking(0.8); O.step()",
            "by more than half the smallest radius in a small step",
        ),
    ],
)
def test_cells_that_the_engine_cannot_follow_are_refused_in_one_line(yade, change, message):
    found = yade(
        SCENE
        + f"""
box((1e-6, 1e-6, 1e-6))
grain((0, 0, 0), 1e-7, ice())
grain((3e-7, 0, 0), 1e-7, ice())
try:
    {change}
    O.step()
    result["message"] = ""
except Exception as error:
    result["message"] = str(error)
"""
    )
    assert message in found["message"] and "\n" not in found["message"], found["message"]
