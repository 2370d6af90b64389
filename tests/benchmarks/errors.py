"""Error and cost of a collision against the time step, by runs of collide.py."""

import json
import sys
import tempfile
from pathlib import Path

import numpy as np
import pandas as pd
from measured_on import HERE, TOP

sys.path.insert(0, str(HERE.parent))
from yade_server import YadeServer

from analysis import open_run
from analysis.measures.compression import maximum_compression
from analysis.runs import ledger

GRAIN_RADIUS = 1e-7  # m
FITTED = (0.02, 0.2)  # t0, between which the order of convergence is fitted


def of_scripts(rows):
    """What runs of collide.py, or with strainRate of compress.py, gave.

    Parameters
    ----------
    rows : list of dictionaries of parameters.

    Returns
    -------
    A list of dictionaries: ledger (largest error of the sum of all channels over K(0), of a compression over the work
    of the boundaries), d_max [grain radii], seconds; of a run that did not end only failed, its last words.
    """
    yade = YadeServer()
    with tempfile.TemporaryDirectory() as folder:
        for k, given in enumerate(rows):
            script = TOP / "yade_scripts" / ("compress.py" if "strainRate" in given else "collide.py")
            place = Path(folder) / str(k)
            place.mkdir()
            given = {"threads": 1, **given, "out": "run"}
            yade.run(script, place, arguments=[f"{name}={value}" for name, value in given.items()])
        return [_of_run(Path(folder) / str(k)) for k in range(len(rows))]


def _of_run(place):
    path = place / "run"
    if not (path / "ended").exists():
        printed = (place / "stdout").read_text() + (place / "stderr").read_text()
        return {"failed": printed.strip().splitlines()[-1]}
    history, seconds = open_run(path).history, json.loads((path / "run.json").read_text())["wallTime"]
    if "filling" in history:
        total, work = ledger.total_energy(history), -ledger.work_on_boundaries(history)[-1]
        return {"ledger": np.abs(total - total[0]).max() / work, "d_max": None, "seconds": seconds}
    largest = maximum_compression(history["time"], history["d"], history["v"])
    d_max = largest.length / GRAIN_RADIUS if largest else None
    return {"ledger": ledger.closure(history), "d_max": d_max, "seconds": seconds}


def by_step(steps, seeds, radius, duration):
    """Root mean square errors of collisions at 3.16 m/s against the time step.

    Parameters
    ----------
    steps : in t0, the shortest first.
    seeds : number of collisions for each step.
    radius, duration : of each aggregate [grain radii], of the run [s].

    Returns
    -------
    DataFrame by step [t0]: ledger (over K(0)), d_max (less that of the shortest step and the same seed [grain radii]),
    seconds a run.
    """
    rows = [
        {"radius": radius, "duration": duration, "stepFraction": s, "seed": k}
        for s in steps
        for k in range(1, 1 + seeds)
    ]
    found = pd.DataFrame(of_scripts(rows)).assign(step=[row["stepFraction"] for row in rows])
    finest = found.d_max.to_numpy(float)[:seeds]
    found["d_max"] = found.d_max.to_numpy(float) - np.tile(finest, len(steps))
    mean_square = lambda values: np.sqrt(np.mean(values**2))
    return found.groupby("step").agg({"ledger": mean_square, "d_max": mean_square, "seconds": "mean"})


def order(steps, error, fitted=FITTED):
    """Slope of log error against log step between two steps [t0]; nan where fewer than three lie there."""
    within = (steps >= fitted[0]) & (steps <= fitted[1]) & (error > 0)
    if np.count_nonzero(within) < 3:
        return np.nan
    return np.polyfit(np.log(steps[within]), np.log(error[within]), 1)[0]
