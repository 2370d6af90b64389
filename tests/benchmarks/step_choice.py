"""The ledger's error against the step in scenes of every kind, and the constants of yade_scripts/step_choice.py from it.

    python3 tests/benchmarks/step_choice.py      measures the scenes that have no error, fits, writes results

The scenes are the lines of results/step_choice.csv (collisions) and results/step_choice_compression.csv: their set (grid,
study, random), the parameters that they give, and the errors that were measured; a new one is a line without an error (all
of them, but the study's, which are runs of a study: two hours on one core). The
constants are fitted to grids of scenes and the study's runs; random scenes between and beyond only judge them. Writes these
tables after every few scenes, and results/step_choice.md (fit and scatter).
"""

import sys
from dataclasses import dataclass
from pathlib import Path

import pandas as pd
from measured_on import RESULTS, TOP, machine

sys.path.insert(0, str(TOP))

NEVER_MET = 1e-9  # of K(0): the error of aggregates that passed each other or didn't get that far is rounding
FILLINGS = (0.1, 0.2, 0.3, 0.4, 0.5)  # of compressions, at which errors were taken
AT_FILLINGS = tuple(f"error{filling:g}" for filling in FILLINGS)
WHOLE = ("grains", "projectileGrains", "planar", "seed")  # numbers
CHUNK = 20  # scenes in one YADE


@dataclass(frozen=True)
class Table:
    """A file, and its columns of errors; comments ("# sets: where") say where these were measured."""

    path: Path
    errors: tuple = ("error",)

    def read(self):
        """DataFrame"""
        return pd.read_csv(self.path, comment="#", float_precision="round_trip")

    def given(self, scene):
        """{name: value} of the parameters that a scene (a row) gives."""
        others = ("set", *self.errors)
        given = {name: value for name, value in scene.items() if name not in others and value == value}
        return {name: int(value) if name in WHOLE else value for name, value in given.items()}

    def origins(self):
        """{sets: where they were measured}, the comments."""
        lines = self.path.read_text().splitlines()
        return dict(line[2:].split(": ", 1) for line in lines if line.startswith("#"))

    def write(self, scenes, **origins):
        """Write the scenes; origins: what to say of sets that are new, the others' comments stay."""
        text = "".join(f"# {name}: {words}\n" for name, words in {**self.origins(), **origins}.items())
        scenes = scenes.astype({name: "Int64" for name in WHOLE if name in scenes})
        shown = lambda error: "" if error != error else f"{error:.4g}"
        errors = scenes[[*self.errors]].apply(lambda column: column.map(shown))
        self.path.write_text(text + scenes.assign(**errors).to_csv(index=False))

    def measure(self):
        """Measure the scenes that have no error; those that fail keep none, and are named."""
        from errors import of_scripts

        scenes, about = self.read(), machine()
        numbers = list(scenes.index[scenes.error.isna()])
        for start in range(0, len(numbers), CHUNK):
            print(f"{self.path.stem}: {start} of {len(numbers)} scenes", flush=True)
            chunk = numbers[start : start + CHUNK]
            for k, found in zip(chunk, of_scripts([self.given(scenes.loc[k]) for k in chunk]), strict=True):
                if "failed" in found:
                    print(self.given(scenes.loc[k]), found["failed"], file=sys.stderr)
                known = {f"error{filling:g}": error for filling, (error, _) in found.get("byFilling", {}).items()}
                for name in self.errors:
                    scenes.loc[k, name] = {"error": found.get("ledger"), **known}.get(name)
            self.write(scenes, **{"measured last on": f"{about['cpu']}, commit {about['commit']}"})


COLLISIONS = Table(RESULTS / "step_choice.csv")
COMPRESSIONS = Table(RESULTS / "step_choice_compression.csv", ("error", *AT_FILLINGS))


def met(scenes):
    """The collisions in which the aggregates met."""
    return scenes[scenes.error > NEVER_MET]


def main():
    import step_choice_report as report

    for table in (COLLISIONS, COMPRESSIONS):
        table.measure()
    text = report.text()
    (RESULTS / "step_choice.md").write_text(text)
    print(text)


if __name__ == "__main__":
    main()
