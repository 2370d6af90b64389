"""What the engine is to reach, and whether it did: what is compared with what, and the bound, as data."""

import statistics
from dataclasses import dataclass
from fnmatch import fnmatch

from measured_scenes import all_scenes
from results import Spread

CORES = {1: "one core", 2: "two cores"}
REFERENCE = "reference"  # stands for the scene where codes and kinds of grains are compared
# (what, bound, scene, the code's number of cores, or both; what its rate is divided by: scene, code): "cpe-*" the slowest size
RATIOS = (
    ("engine / YADE's own loop with its stock cohesive law", 27, REFERENCE, (1,), REFERENCE, "stock"),
    ("engine / LAMMPS", 10, REFERENCE, (1,), REFERENCE, "lammps"),
    ("engine / LIGGGHTS", 5, REFERENCE, (1,), REFERENCE, "liggghts"),
    ("slowest of all sizes / reference", 0.75, "cpe-*", (1, 2), REFERENCE, "engine"),
    ("two materials / like grains", 0.5, "materials", (1, 2), REFERENCE, "engine"),
    ("two sizes of grain / like grains", 0.5, "radii", (1, 2), REFERENCE, "engine"),
    ("A22, flying at 50.1 m/s / the same grains at 0.5 m/s", 0.9, "a22", (2,), "a22-slow", "engine"),
)
# the same of the slowest moment: divided by its own flight, or by another code at the same moment
SLOWEST = (
    ("slowest moment / flying", 0.75, "through-*", (1, 2), "engine"),
    ("slowest moment / LAMMPS", 8, "a22", (2,), "lammps"),
    ("slowest moment / LAMMPS", 8, "a22-drag", (2,), "lammps"),
)
MINUTES = (("a22", 6), ("a22-drag", 6), ("k13", 40))  # of a whole run on two cores
RATES = ((1, 100), (2, 190))  # million contact updates a second of two CPE, R 40, by cores


@dataclass(frozen=True)
class Target:
    """what is compared; the bound; Spread that was measured or None; whether more is better."""

    what: str
    bound: float
    found: Spread
    at_least: bool = True

    def cells(self):
        """[what, wanted, measured, verdict]"""
        wanted = f"{'at least' if self.at_least else 'below'} {self.bound:g}"
        if self.found is None:
            return [self.what, wanted, "-", "not measured"]
        worst = self.found.least if self.at_least else self.found.most
        reached, every = ((x >= self.bound if self.at_least else x < self.bound) for x in (self.found.median, worst))
        verdict = "**reached**" if every else "reached by the median, not in every round"
        found = self.found.text(0 if self.bound >= 100 else 2)
        return [self.what, wanted, found, verdict if reached else "not reached"]


def targets(results, settings):
    """Each Target of what the results have anything to say about."""
    scenes = all_scenes(settings)
    at = {name: rows.moment for name, rows in results.moments.groupby("scene", sort=False)}

    def slowest(pairs):
        ratios = [ratio for ratio in (results.ratio(*pair) for pair in pairs) if ratio]
        return min(ratios, key=lambda ratio: ratio.median, default=None)

    for what, bound, scene, cores, other, code in RATIOS:
        scene, other = (f"cpe-{settings.reference:g}" if name == REFERENCE else name for name in (scene, other))
        for n in cores if other in at else ():
            pairs = [((name, "flying", "engine", n), (other, "flying", code, n)) for name in at if fnmatch(name, scene)]
            yield Target(f"{what}, {CORES[n]}", bound, slowest(pairs))
    reference = [(f"cpe-{settings.reference:g}", "flying", "engine", n) for n in (2, 1)]
    if reference[0][0] in at:
        yield Target("two cores / one core", 1.9, results.ratio(*reference))
    for what, bound, scene, cores, code in SLOWEST:
        for name, n in ((name, n) for name in at if fnmatch(name, scene) for n in cores):
            own = code == "engine"  # then divided by the flight, which is not compared with itself
            moments = at[name][1:] if own else at[name]
            pairs = [((name, m, "engine", n), (name, "flying" if own else m, code, n)) for m in moments]
            yield Target(f"{what}, {scenes[name].title}, {CORES[n]}", bound, slowest(pairs))
    sizes = [f"cpe-{radius:g}" for radius in settings.radii if radius >= settings.reference]
    bytes_each = (results.moments.bytes / results.moments.contacts)[results.moments.scene.isin(sizes)].dropna()
    if len(bytes_each):
        largest = Spread(bytes_each.max(), bytes_each.min(), bytes_each.max())
        yield Target("memory, bytes a contact (range: sizes from the reference up)", 1000, largest, at_least=False)
    whole = results.whole(scenes)
    for name, bound in ((name, bound) for name, bound in MINUTES if name in whole):
        each = [results.minutes(whole[name], "engine", 2, of) for of in (statistics.median, min, max)]
        yield Target(f"minutes for a run, {scenes[name].title}", bound, Spread(*each), at_least=False)
    for n, bound in RATES if "cpe" in at else ():
        rate = Spread.of(results.rates("cpe", "flying", "engine", n) / 1e6)
        yield Target(f"million contact updates a second, two CPE, R 40, {CORES[n]}", bound, rate)
