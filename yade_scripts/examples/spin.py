"""An aggregate is spun up until it breaks, by forces whose work the ledger books.

yade -n -x yade_scripts/examples/spin.py [grains=300 seed=1 rate=3e13 out=runs/spin]

study.py runs it for each row of a table with a column !SCRIPT.
"""

import os
import sys
from dataclasses import dataclass

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(sys.argv[0])))))
import numpy as np

import contact_law  # makes JKRMat and the other classes known
from analysis import fragment_labels
from yade_scripts import packings
from yade_scripts.parameters import POSITIVE, SWITCH, Parameters, between, one_line_errors, parameter
from yade_scripts.run.parameters import FOLDER, from_arguments


@dataclass(frozen=True)
class SpinParameters(Parameters):
    """What a table or the command line may set."""

    grains: int = parameter(300, between(2, 100_000), "of the aggregate")
    seed: int = parameter(1, POSITIVE, "of the aggregate")
    rate: float = parameter(3e13, POSITIVE, "rise of the angular velocity", "rad/s^2")
    out: str = parameter("runs/spin", FOLDER, "run folder")
    resume: int = parameter(0, SWITCH, "as study.py gives it")


with one_line_errors("spin.py"):
    given = SpinParameters.parse(from_arguments(sys.argv[1:]))
RADIUS = 1e-7  # m
ice = JKRMat(young=7e9, poisson=0.25, density=1000, surfaceEnergy=0.1, criticalRolling=0.8e-9, viscoelasticTime=6e-12)
constants = Ip2_JKRMat_JKRMat_JKRWadaPhys().pairConstants(ice, RADIUS, ice, RADIUS)
overlap = constants["equilibriumOverlap"]
aggregate = packings.bpca(given.grains, RADIUS, overlap, seed=given.seed)
aggregate = packings.brought_to_rest(aggregate, RADIUS, overlap)
for position in aggregate.position:
    O.bodies.append(utils.sphere(position, RADIUS, material=ice))


def spin_up():
    """Forces and torques of the rate about z, which act throughout the next O.step."""
    for body in O.bodies:
        x, y, _ = body.state.pos
        O.forces.addF(body.id, given.rate * body.state.mass * Vector3(-y, x, 0))
        O.forces.addT(body.id, given.rate * body.state.inertia[2] * Vector3(0, 0, 1))


def spin():
    """Angular velocity [rad/s] about z of a rigid body with this angular momentum."""
    state = contact_law.snapshot()
    (x, y, _), (vx, vy, _), turn = state["position"].T, state["velocity"].T, state["angular_velocity"][:, 2]
    own = 0.4 * RADIUS**2
    return (x * vy - y * vx + own * turn).sum() / (x**2 + y**2 + own).sum()


def pieces():
    return np.bincount(fragment_labels(given.grains, contact_law.snapshot()["contact_pairs"]))


O.engines = [PyRunner(command="spin_up()", iterPeriod=1), JKRWadaEngine(subSteps=50)]
O.dt = 50 * 0.1 * constants["timeUnit"]
series = lambda: {"spin": spin(), "pieces": len(pieces())}
about = {"grains": given.grains, "seed": given.seed, "rate": given.rate}
run = contact_law.record(given.out, every=10, series=series, parameters=about, overwrite=True)
while len(pieces()) == 1:
    O.run(40, True)

fastest, parts = run.recent("spin", O.time).max(), pieces().tolist()
print(f"{given.grains} grains broke at {fastest:.2e} rad/s, after {O.time:.2e} s; the pieces have {parts} grains")
sys.exit(0)
