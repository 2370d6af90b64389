"""The measured scenes of step_choice.py: the tables of results/, which also say which scenes there are."""

from dataclasses import dataclass
from pathlib import Path

import pandas as pd
from measured_on import RESULTS

NEVER_MET = 1e-9  # of K(0): the error of aggregates that passed each other or didn't get that far is rounding
FILLINGS = (0.1, 0.2, 0.3, 0.4, 0.5)  # of compressions, at which errors were taken
AT_FILLINGS = [f"error{filling:g}" for filling in FILLINGS]
WHOLE = ("grains", "projectileGrains", "planar", "seed")  # numbers


@dataclass(frozen=True)
class Table:
    """A file: a line for each scene, with its set (grid, study, random), the parameters that it gives, and its errors; comments ("# sets: where") say where these were
    measured. A scene without an error is still to be measured."""

    path: Path
    errors: tuple = ("error",)

    def read(self):
        """DataFrame"""
        return pd.read_csv(self.path, comment="#", float_precision="round_trip")

    def given(self, scene):
        """{name: value} of the parameters that a scene (a row) gives."""
        given = {
            name: value for name, value in scene.items() if name != "set" and name not in self.errors and value == value
        }
        return {name: int(value) if name in WHOLE else value for name, value in given.items()}

    def origins(self):
        """{sets: where they were measured}, the comments."""
        with self.path.open() as file:
            return dict(line[2:].strip().split(": ", 1) for line in file if line[0] == "#")

    def write(self, scenes, **origins):
        """Write the scenes; origins: what to say of sets that are new, the others' comments stay."""
        text = "".join(f"# {name}: {words}\n" for name, words in {**self.origins(), **origins}.items())
        scenes = scenes.astype({name: "Int64" for name in WHOLE if name in scenes})
        errors = scenes[[*self.errors]].applymap(lambda error: "" if error != error else f"{error:.4g}")
        self.path.write_text(text + scenes.assign(**errors).to_csv(index=False))


COLLISIONS = Table(RESULTS / "step_choice.csv")
COMPRESSIONS = Table(RESULTS / "step_choice_compression.csv", ("error", *AT_FILLINGS))


def met(scenes):
    """The collisions in which the aggregates met."""
    return scenes[scenes.error > NEVER_MET]
