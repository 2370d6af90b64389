"""Speed of the engine and of other codes, and error against the time step: measured, and printed as one page.

    /usr/bin/python3 tests/benchmarks/bench.py [bench | papers | peers] [--scene NAME,NAME] [--quick | --tiny]

bench: sizes of aggregates, unlike grains, and the error of a collision; papers: moments of the papers' runs, which are
made first (minutes each, once: build/bench/scenes); peers: one collision by every code that is installed.
Leaves the page in build/bench/GROUP.txt, the measurements in build/bench/GROUP.csv. Keep the machine quiet meanwhile.
"""

import argparse
import os
import sys
import tempfile
from contextlib import ExitStack
from dataclasses import dataclass, replace

import codes
import measured_scenes
import numpy as np
import pandas as pd
import scene_file

from analysis import open_run
from analysis.progress import progress
from yade_scripts import collide

OUT = codes.TOP / "build/bench"
HEAD = """{group}: contact updates a second, {cpu}, {cores} cores, commit {commit}

A contact update is one step of one touching contact; M/s: million a second, ms: of a small step, one thread and two.
All codes take turns in {rounds} rounds; medians, and of engine / code the least and most of the rounds.
The engine runs in YADE, {together} small steps in an O.step. The machine's load average before: {load:.1f}.
"""
GRAIN_RADIUS = 1e-7  # m
FITTED = (0.02, 0.2)  # t0, between which the order of convergence is fitted


@dataclass(frozen=True)
class Settings:
    """How much is measured."""

    rounds: int = 5
    seconds: float = 1.5  # of one measurement
    stretch: float = 0.05  # fraction of a run's small steps that measuring a moment may take
    peer_rounds: int = 3
    peer_steps: int = 100  # at most
    skins: tuple = (0.3, 0.6, 1.0)  # of a peer's lists [grain radii]: its best counts
    error: tuple = ((0.01, 0.02, 0.05, 0.1, 0.2, 0.3, 0.4), 3, 20, 130e-9)  # steps [t0], seeds, radius, duration [s]


FULL = Settings()
QUICK = Settings(2, 0.5, 0.03, 1, 30, (0.6,), ((0.05, 0.1, 0.2, 0.4), 1, 20, 130e-9))
TINY = replace(QUICK, rounds=1, seconds=0.03, peer_steps=20, error=((0.1, 0.2, 0.4), 1, 4, 2e-9))


def arguments(words=None):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("group", nargs="?", default="bench", choices=["bench", "papers", "peers"])
    parser.add_argument("--scene", help="of these scenes only, of the group's")
    parser.add_argument("--quick", action="store_const", dest="how", const=QUICK, default=FULL, help="measure less")
    parser.add_argument("--tiny", action="store_const", dest="how", const=TINY, help="only show that it works")
    given = parser.parse_args(words)
    groups = {"bench": measured_scenes.BENCH, "papers": measured_scenes.PAPERS, "peers": measured_scenes.PEERS}
    if given.how != FULL:
        groups["bench"] = measured_scenes.QUICK if given.how == QUICK else measured_scenes.TINY
    given.scenes = groups[given.group]
    if given.scene:
        if unknown := [name for name in given.scene.split(",") if name not in given.scenes]:
            parser.error(f"--scene {unknown[0]}: must be of {', '.join(given.scenes)}")
        given.scenes = {name: given.scenes[name] for name in given.scene.split(",")}
    return given


# ---- measuring ----


def measure(scene, moment, start, path, how):
    """Rows of all codes on the file of a moment, and {code: why it was not measured}. Each round measures all once."""
    grains, rows = scene_file.load(path), []
    missing = {code: reason for code in scene.codes if (reason := codes.missing(code, grains))}
    here = [code for code in scene.codes if code not in missing]
    # small steps: all rounds together leave a flight in the air, and are a small part of another run
    flight = scene.apart / start.step / 1.2 if moment == next(iter(scene.moments)) else 0
    most = int((flight or how.stretch * start.steps) / how.rounds / 2)
    with ExitStack() as stack:
        opened = {code: codes.open_code(code, path, start.together, how) for code in here}
        for code in opened.values():
            stack.callback(code.close)
        turns = [(code, threads) for code in here for threads in codes.threads_of(code)]
        for turn in range(how.rounds):
            for code, threads in progress(turns, f"{scene.title}, {moment}: round {turn + 1} of {how.rounds}"):
                if code in missing or (turn >= how.peer_rounds and codes.CODES[code].program):
                    continue
                try:
                    answer = opened[code].measure(threads, how.seconds, most)
                except codes.CodeFailed as error:
                    if not codes.CODES[code].program:
                        raise
                    missing[code] = f"failed: {' '.join(str(error).split())[:200]}"
                    continue
                rows.append({"moment": moment, "code": code, "threads": threads, "round": turn, **answer})
    return rows, missing


def measured(scenes, how):
    """(DataFrame, a row a measurement; {scene: Start}; {code: reason}; the machine's load before)."""
    rows, starts, missing, load = [], {}, {}, os.getloadavg()[0]
    for name, scene in scenes.items():
        starts[name], paths = measured_scenes.make(name, scene)
        for moment, path in paths.items():
            found, without = measure(scene, moment, starts[name], path, how)
            rows += [{"scene": name, **row} for row in found]
            missing |= without
    table = pd.DataFrame(rows)
    table["ms"] = 1e3 * table.seconds / table.steps
    return table.assign(rate=1e-3 * table.contacts / table.ms), starts, missing, load


def errors_by_step(steps, seeds, radius, duration):
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
    sizes = dict(radius=radius, duration=duration, threads=1)
    with tempfile.TemporaryDirectory() as folder:
        runs = collide(folder, jobs=1, stepFraction=steps, seed=range(1, 1 + seeds), **sizes)
        records = [open_run(run).record for run in runs.folder]
    d_max = runs.d_max.to_numpy(float).reshape(len(steps), seeds) / GRAIN_RADIUS
    errors = {"ledger": runs.energy_closure.to_numpy().reshape(len(steps), seeds), "d_max": d_max - d_max[0]}
    found = pd.DataFrame({name: np.sqrt(np.mean(error**2, axis=1)) for name, error in errors.items()}, list(steps))
    seconds = np.reshape([record["wallTime"] for record in records], (len(steps), seeds))
    return found.assign(seconds=seconds.mean(axis=1)).rename_axis("step")


def order(error):
    """Slope of log error (Series by step) against log step, between FITTED; nan where fewer than three lie there."""
    fitted = error[(error.index >= FITTED[0]) & (error.index <= FITTED[1]) & (error > 0)]
    return np.polyfit(np.log(fitted.index), np.log(fitted), 1)[0] if len(fitted) > 2 else np.nan


# ---- the page ----


def by_code(table, scenes):
    """A row for each moment and code: medians of the rounds, and the engine's speed over the code's in a round."""
    rows = []
    for (name, moment), here in table.groupby(["scene", "moment"], sort=False):
        ours = here[here.code == "engine"].set_index(["threads", "round"]).rate
        for code, own in here.groupby("code", sort=False):
            row = {"scene": scenes[name].title, "moment": moment, "code": codes.CODES[code].title}
            row["contacts"] = round(here[here.code == "engine"].contacts.mean())
            for threads, of_threads in own.groupby("threads"):
                ratio = ours.loc[threads] / of_threads.set_index("round").rate
                row |= {
                    f"M/s, {threads}": f"{of_threads.rate.median():.1f}",
                    f"ms, {threads}": f"{of_threads.ms.median():.3g}",
                }
                row[f"engine / code, {threads}"] = f"{ratio.min():.3g} to {ratio.max():.3g}" if code != "engine" else ""
            rows.append(row)
    return pd.DataFrame(rows).fillna("")


def whole_runs(table, scenes, starts):
    """Minutes of whole runs: small steps times the mean of the moments' medians, each weighted by the part of the run
    that is nearest to it (of a compression in the logarithm of the filling, in which its time is even)."""
    rows, ms = [], table.groupby(["scene", "code", "threads", "moment"]).ms.median()
    for name in (name for name in starts if len(scenes[name].moments) > 1):
        at = list(starts[name].progress.values())
        ends = [0.0, *((a + b) / 2 for a, b in zip(at, at[1:])), 1.0]
        weights = pd.Series([end - begin for begin, end in zip(ends, ends[1:])], index=list(scenes[name].moments))
        row = {"scene": scenes[name].title, "small steps": starts[name].steps}
        for (code, threads), of_moments in ms.loc[name].groupby(["code", "threads"]):
            minutes = (of_moments.droplevel([0, 1]) * weights).sum(min_count=len(weights)) * starts[name].steps / 60e3
            row[f"{codes.CODES[code].title}, {threads}"] = f"{minutes:.3g}"
        rows.append(row)
    return pd.DataFrame(rows).fillna("")


def page(group, table, scenes, starts, missing, load, how, error):
    """The text that is printed."""
    head = dict(group=group, rounds=how.rounds, together=measured_scenes.SMALL_STEPS, load=load)
    parts = [HEAD.format(**head, **codes.machine()), by_code(table, scenes).to_string(index=False)]
    whole = whole_runs(table, scenes, starts)
    if len(whole):
        parts += ["\nMinutes of whole runs, from these moments", whole.to_string(index=False)]
    if error is not None:
        parts.append(
            "\nError against the step [t0]: ledger over K(0), d_max less that of the shortest step [grain radii]"
        )
        parts.append(error.to_string(float_format=lambda x: f"{x:.2g}"))
        orders = [f"{name} {order(error[name]):.2f}" for name in ("ledger", "d_max")]
        parts.append(f"order of convergence: {', '.join(orders)}")
    others = [code for code in table.code.unique() if codes.CODES[code].physics]
    parts += ["", *(f"{codes.CODES[code].title}: {codes.CODES[code].physics}" for code in others)]
    parts += [f"{codes.CODES[code].title} is {codes.version(code)}" for code in others]
    return "\n".join(parts + [f"{codes.CODES[code].title} was not measured: {why}" for code, why in missing.items()])


def main():
    given = arguments()
    how, scenes = given.how, given.scenes
    table, starts, missing, load = measured(scenes, how)
    error = errors_by_step(*how.error) if given.group == "bench" else None
    text = page(given.group, table, scenes, starts, missing, load, how, error)
    OUT.mkdir(parents=True, exist_ok=True)
    table.to_csv(OUT / f"{given.group}.csv", index=False)
    (OUT / f"{given.group}.txt").write_text(text + "\n")
    print(text)


if __name__ == "__main__":
    sys.exit(main())
