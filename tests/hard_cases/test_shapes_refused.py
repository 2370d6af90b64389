"""What the contact law cannot hold between is refused in one line: shapes, clumps, planes that turn or are free."""

import time

import pytest
from scenes import *

R = 1e-7  # of the grains [m]


def facet(m):
    O.bodies.append(utils.facet([(-9e-7, -9e-7, 0), (9e-7, -9e-7, 0), (0, 9e-7, 0)], material=m))


def clump(m):
    O.bodies.appendClumped([utils.sphere((x, 0, -0.9 * R), R, material=m) for x in (0, 1e-7)])


def plane(m, **changes):
    body = utils.wall(0, axis=2, material=m)
    O.bodies.append(body)
    for name, value in changes.items():
        setattr(body.state, name, value)


REFUSED = [
    ("facet", {}, "body 0 is a Facet: bodies of JKRMat must be Spheres or Walls"),
    ("clump", {}, "body 0 is a member of clump 2: grains of JKRMat must be single spheres"),
    ("plane", dict(blockedDOFs="xyXYZ"), "body 0, a Wall: blockedDOFs must be 'xyzXYZ'"),
    ("plane", dict(neck=0.5), "neck: must be 0 in scenes with a Wall"),
]


def refusal_of(add, changes):
    """What the functors refuse such a scene with, at the latest soon after the step."""
    neck = changes.get("neck", 0)
    new_scene(1e-3 * unit, neck=neck)
    globals()[add](ice(), **{} if neck else changes)
    grain((0, 0, 0.999 * R), R, ice())
    try:
        O.step()
        end = time.time() + 10
        while time.time() < end:
            pass
    except RuntimeError as error:
        return str(error)


@pytest.mark.in_yade
@pytest.mark.parametrize("add, changes, line", REFUSED, ids=[line[:24] for _, _, line in REFUSED])
def test_refused_in_one_line_by_functors_and_engine(add, changes, line):
    message = refusal_of(add, changes)
    assert line in message and "\n" not in message
    fused_engine(neck=changes.get("neck", 0))
    message = refusal()
    assert line in message and "\n" not in message


def refusals_by_threads():
    return [refusal_of(add, changes) for add, changes, _ in REFUSED]


def test_refused_whichever_thread_meets_it(yade):
    assert all(line in message for message, (_, _, line) in zip(yade(refusals_by_threads, threads=3), REFUSED))
