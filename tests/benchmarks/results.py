"""What was measured, as tables in a folder, and rates, ratios and times of whole runs out of it.

speed.csv    a row a measurement: scene, moment, code, threads, round, contacts, steps, seconds, rate (contact updates a
             second), fraction (processor seconds a second), skin (of a peer's lists) and newton, version (of a peer; instructions of
             the engine), note (why there is no measurement)
moments.csv  a row a moment of a scene: time [s] and progress of its run, on what and how it was measured, and what the
             engine counted in all its measurements there (speed.py)
error.csv    a row a run (errors.py)
"""

import statistics
from dataclasses import dataclass
from pathlib import Path

import pandas as pd

KEYS = {"speed": ["scene", "moment"], "moments": ["scene", "moment"], "error": ["scene", "code"]}
MOMENTS = """scene moment time progress step runSteps grains contacts pieces measuredSteps searches distanceChecks events formed broken
contactUpdates energyChange kinetic boundaryWork lists forces eventHandling integration other bytes others cpu cores commit
settings"""
COLUMNS = {
    "speed": "scene moment code threads round contacts steps seconds rate fraction skin newton version note".split(),
    "moments": MOMENTS.split(),
    "error": "scene code step sample ledger d_max kinetic seconds refused cpu commit".split(),
}


@dataclass(frozen=True)
class Spread:
    """Median, least and most of the rounds."""

    median: float
    least: float
    most: float

    @classmethod
    def of(cls, values):
        return cls(statistics.median(values), min(values), max(values))

    def text(self, digits, unit=1.0):
        """The median, and the others where they differ; in a unit."""
        median, least, most = (f"{value / unit:.{digits}f}" for value in (self.median, self.least, self.most))
        return median if self.least == self.most else f"{median} ({least} - {most})"


class Results:
    """The tables (pandas.DataFrame by the names of COLUMNS) of a folder, which may hold none yet; moments in the order of
    their runs' progress."""

    def __init__(self, folder):
        self.folder = Path(folder)
        for name in COLUMNS:
            self._read(name)

    def _read(self, name):
        path, self._measured, there = self.folder / f"{name}.csv", None, pd.DataFrame(columns=COLUMNS[name])
        if path.exists():
            there = pd.read_csv(path, float_precision="round_trip", dtype={"commit": str})  # which may be digits alone
        # a moment that was measured again comes last in the file
        setattr(self, name, there.sort_values("progress", kind="stable") if name == "moments" else there)

    def put(self, **tables):
        """Write rows (lists of dictionaries) of tables in the place of those of the same scenes and moments (or codes)."""
        self.folder.mkdir(parents=True, exist_ok=True)
        for name, rows in ((name, rows) for name, rows in tables.items() if rows):
            new, old, key = pd.DataFrame(rows, columns=COLUMNS[name]), getattr(self, name), KEYS[name]
            replaced = pd.MultiIndex.from_frame(old[key]).isin(pd.MultiIndex.from_frame(new[key]))
            table = pd.concat([part for part in (old[~replaced], new) if len(part)], ignore_index=True)
            path = self.folder / f"{name}.csv"
            table.to_csv(path.with_suffix(".new"), index=False)
            path.with_suffix(".new").replace(path)
            self._read(name)

    def is_done(self, scene, moment, **wanted):
        """Whether a moment was measured with these values of moments.csv."""
        found = self.moments[(self.moments.scene == scene) & (self.moments.moment == moment)]
        return len(found) == 1 and all(found[name].iloc[0] == value for name, value in wanted.items())

    def of(self, *where):
        """Rows of speed.csv by their round; where: scene, moment, code, threads."""
        if self._measured is None:
            measured = self.speed[self.speed.rate.notna()].set_index("round")
            self._measured = dict(list(measured.groupby(["scene", "moment", "code", "threads"])))
        return self._measured.get(where, self.speed[:0])

    def rate(self, *where):
        """Spread of the contact updates a second, None where nothing was measured."""
        rates = self.of(*where).rate
        return Spread.of(rates) if len(rates) else None

    def ratio(self, first, second):
        """Spread of the ratio of two rates, None where one was not measured: within each round of what was measured together
        (a moment, or the scenes of one moment), else of any round of one and any of the other."""
        a, b = self.of(*first).rate, self.of(*second).rate
        if not len(a) or not len(b):
            return None
        several = set(self.moments.scene[self.moments.scene.duplicated()])
        if a.index.equals(b.index) and (first[:2] == second[:2] or not {first[0], second[0]} & several):
            return Spread.of(a / b)
        return Spread(a.median() / b.median(), a.min() / b.max(), a.max() / b.min())

    def milliseconds(self, *where):
        """ms a small step of each round (Series)."""
        rows = self.of(*where)
        return 1e3 * rows.seconds / rows.steps

    def whole(self, scenes):
        """{name: its rows of moments.csv, in their order in time}, of the scenes (measured_scenes.Scene by name) that have
        several moments, all of which were measured."""
        every = self.moments.groupby("scene", sort=False)
        known = {name: rows for name, rows in every if name in scenes and len(rows) > 1}
        return {name: rows for name, rows in known.items() if set(rows.moment) == set(scenes[name].moments)}

    def minutes(self, moments, code, threads):
        """Of a whole run with its small step, by the medians of the rounds; moments: rows of whole(). None where a moment has
        none."""
        each = [self.milliseconds(row.scene, row.moment, code, threads) for row in moments.itertuples()]
        if not all(len(one) for one in each):
            return None
        mean = sum(weight * one.median() for weight, one in zip(weights(moments), each))
        return mean * moments.runSteps.iloc[0] / 60e3


def weights(moments):
    """Fraction of the run's steps that each of a scene's moments stands for: those nearer to it than to another (of a
    compression in the logarithm of the filling, in which its time is even)."""
    at = list(moments.progress)
    ends = [0.0, *((a + b) / 2 for a, b in zip(at, at[1:])), 1.0]
    return [end - begin for begin, end in zip(ends, ends[1:])]
