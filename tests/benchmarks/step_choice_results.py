"""The measured scenes of step_choice.py: tables of results/, read and written."""

import csv

from measured_on import RESULTS

NEVER_MET = 1e-9  # of K(0): the error of aggregates that passed each other or didn't get that far is rounding
FILLINGS = (0.1, 0.2, 0.3, 0.4, 0.5)  # of compressions, at which errors were taken


class Table:
    """A file of results/: a line for each scene. columns: {name: (type, value where a scene has none)}; errors: the
    names of what was measured; comments say where."""

    def __init__(self, name, columns, errors):
        self.path, self.columns, self.errors = RESULTS / name, {"set": (str, "grid"), **columns}, errors

    def key(self, scene):
        """What tells a scene from others."""
        return tuple(scene.get(name, default) for name, (_, default) in self.columns.items() if name != "set")

    def given(self, scene):
        """The scene's parameters that are not their defaults."""
        names = (name for name in self.columns if name != "set")
        return {name: scene[name] for name in names if scene.get(name, self.columns[name][1]) != self.columns[name][1]}

    def read(self):
        """The measured scenes, each with its errors."""
        if not self.path.exists():
            return []
        with self.path.open() as file:
            return [self._scene(row) for row in csv.DictReader(line for line in file if line[0] != "#")]

    def _scene(self, row):
        scene = {}
        for name, (kind, default) in self.columns.items():
            scene[name] = kind(row[name]) if row.get(name) else default
        return {**scene, **{name: float(row[name]) if row[name] else None for name in self.errors}}

    def origins(self):
        """{sets: where they were measured}, the comments."""
        if not self.path.exists():
            return {}
        with self.path.open() as file:
            return dict(line[2:].strip().split(": ", 1) for line in file if line[0] == "#")

    def write(self, measured, **origins):
        """Write the scenes; origins: what to say of sets that are new, the others' comments stay."""
        with_comments = {**self.origins(), **origins}
        with self.path.open("w") as file:
            file.writelines(f"# {name}: {text}\n" for name, text in with_comments.items())
            writer = csv.DictWriter(file, [*self.columns, *self.errors], lineterminator="\n")
            writer.writeheader()
            for scene in measured:
                row = {name: scene.get(name, default) for name, (_, default) in self.columns.items()}
                errors = {name: scene.get(name) for name in self.errors}
                writer.writerow({**row, **{name: "" if e is None else f"{e:.4g}" for name, e in errors.items()}})


COLLISIONS = Table(
    "step_choice.csv",
    {
        "material": (str, "ice"),
        "packing": (str, "cpe"),
        "radius": (float, None),
        "filling": (float, None),
        "grains": (int, None),
        "projectileGrains": (int, None),
        "planar": (int, 0),
        "neck": (float, 0.0),
        "limit": (str, "held"),
        "criticalRolling": (float, None),
        "velocity": (float, None),
        "impact": (float, 0.0),
        "viscoelasticTime": (float, 0.0),
        "stepFraction": (float, None),
        "seed": (int, None),
    },
    ("error",),
)
COMPRESSIONS = Table(
    "step_choice_compression.csv",
    {
        "material": (str, "ice"),
        "grains": (int, None),
        "strainRate": (float, None),
        "linearDamping": (float, 0.01),
        "viscoelasticTime": (float, 0.0),
        "criticalRolling": (float, None),
        "limit": (str, "held"),
        "stretch": (str, "no"),
        "finalFilling": (float, 0.5),
        "stepFraction": (float, None),
        "seed": (int, None),
    },
    ("error", *(f"error{filling:g}" for filling in FILLINGS)),
)


def met(scenes):
    """The collisions in which the aggregates met."""
    return [s for s in scenes if s["error"] > NEVER_MET]
