"""Error and cost against the time step, on A24's scene at 20 grain radii and on a bounce of two grains; part of make bench.

For each step (in t0) the collision of three seeds up to 130 ns (maximum compression is at about 100): largest closure error of the ledger over K(0),
and |d_max - d_max at the finest step| in grain radii; and the root mean square error of a pair's rebound speed over twelve initial gaps, against the
closed form v^2 - v_stick^2. Writes results/error.json and results/error.png.
"""
import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import matplotlib
import numpy as np

from measured_on import RESULTS, TOP, machine

sys.path[:0] = [str(TOP), str(TOP / "tests")]
matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

from analysis.theory import ICE, pair_constants, sticking_velocity_without_drag  # noqa: E402
from conftest import run_yade  # noqa: E402

STEPS = (0.4, 0.3, 0.2, 0.1, 0.05, 0.025, 0.0125)
SEEDS = (1, 2, 3)
SPEED = 9.0  # of the pair [m/s]

BOUNCE = """
from scenes import *
def apart(after):
    if O.time > after and not O.energy["disconnection"] == 0: O.pause()
for step in parameters["steps"]:
    speeds = []
    for gap in 2e-9 + 1e-10 * np.arange(12) / 1.7:
        new_scene(step * constants(ice(), 1e-7)["timeUnit"])
        grain((0, 0, 0), 1e-7, ice())
        grain((2e-7 + gap, 0, 0), 1e-7, ice(), (-parameters["speed"], 0, 0))
        fused_engine()
        O.engines += [PyRunner(command="apart(%r)" % (2 * gap / parameters["speed"]), iterPeriod=max(1, int(1 / step)))]
        O.run(int(100 / step), True)
        speeds.append(O.bodies[1].state.vel[0] - O.bodies[0].state.vel[0])
    result[step] = speeds
"""


def collide(step, seed, folder):
    """(closure error over K(0), d_max [grain radii], seconds) of one collision."""
    out = Path(folder) / f"{step}-{seed}"
    start = time.monotonic()
    subprocess.run(["yade", "-n", "-x", str(TOP / "yade_scripts/collide.py"), f"stepFraction={step}", f"seed={seed}", "duration=130e-9", f"out={out}"], check=True, capture_output=True)
    seconds = time.monotonic() - start
    summary = json.loads(subprocess.run(["/usr/bin/python3", "-m", "analysis", "summary", "--json", str(out)], cwd=TOP, check=True, capture_output=True, text=True).stdout)
    return summary["energy_closure"], summary["d_max"] / 1e-7, seconds


def measure():
    """{"collision": {step: [[closure, d_max, seconds] of each seed]}, "bounce": {step: [speeds]}}"""
    collisions = {}
    with tempfile.TemporaryDirectory() as folder:
        for step in STEPS:
            collisions[step] = [collide(step, seed, folder) for seed in SEEDS]
            print(f"step {step} t0: closure {[f'{c:.1e}' for c, _, _ in collisions[step]]}, d_max {[f'{d:.5f}' for _, d, _ in collisions[step]]} r_p, {sum(s for *_, s in collisions[step]):.0f} s", flush=True)
    return {"collision": collisions, "bounce": run_yade(BOUNCE, {"steps": STEPS, "speed": SPEED})}


def draw(results, about):
    """The figure: errors against the step, with lines of second order."""
    steps = np.array(STEPS)
    closure = [np.sqrt(np.mean([c**2 for c, _, _ in results["collision"][step]])) for step in STEPS]
    finest = np.array([d for _, d, _ in results["collision"][STEPS[-1]]])
    d_max = [np.sqrt(np.mean([(d - f) ** 2 for (_, d, _), f in zip(results["collision"][step], finest)])) for step in STEPS[:-1]]
    exact = np.sqrt(SPEED**2 - sticking_velocity_without_drag(pair_constants(ICE, 1e-7)) ** 2)
    bounce = [np.sqrt(np.mean((np.array(results["bounce"][str(step)]) / exact - 1) ** 2)) for step in STEPS]
    figure, axes = plt.subplots(1, 3, figsize=(13, 4.2), constrained_layout=True)
    panels = (("collision: ledger's largest error / K(0)", steps, closure), ("collision: |d_max - finest| [grain radii]", steps[:-1], d_max), ("pair: error of the rebound speed", steps, bounce))
    for axis, (title, x, y) in zip(axes, panels):
        axis.loglog(x, y, "o-", color="#c1272d", label="root mean square")
        axis.loglog(x, y[-3] * (x / x[-3]) ** 2, ":", color="0.4", label="second order")
        axis.set_xlabel("time step  [$t_0$]")
        axis.set_title(title, fontsize=10.5)
        axis.legend(frameon=False)
        axis.grid(alpha=0.25)
    figure.suptitle(f"fused engine, commit {about['commit']}; collision of 2 x 3,200 ice grains at 3.16 m/s, seeds {', '.join(map(str, SEEDS))}", fontsize=10)
    figure.savefig(RESULTS / "error.png", dpi=110)


def main():
    RESULTS.mkdir(exist_ok=True)
    about, results = machine(), measure()
    draw(results, about)
    (RESULTS / "error.json").write_text(json.dumps({"machine": about, **results}, indent=1))


if __name__ == "__main__":
    main()
