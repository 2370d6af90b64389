"""What the engine is to reach, and whether it did: a list of what is compared, its bound and how it is found in the results."""

import statistics
from dataclasses import dataclass

from measured_scenes import all_scenes, bench, sized
from results import Spread

CORES = {1: "one core", 2: "two cores"}


@dataclass(frozen=True)
class Target:
    """what is compared; the bound; Spread that was measured or None; whether more is better; the same by processor time, where that makes sense."""

    what: str
    bound: float
    found: Spread
    at_least: bool = True
    by_processor: Spread = None

    def cells(self):
        """[what, wanted, measured, verdict]"""
        bound = f"{'at least' if self.at_least else 'below'} {self.bound:g}"
        if self.found is None:
            return [self.what, bound, "-", "not measured"]
        aside = f"; by processor time {self.by_processor.text(2)}" if self.by_processor else ""
        return [self.what, bound, self.found.text(0 if self.bound >= 100 else 2) + aside, self.verdict()]

    def verdict(self):
        worst = self.found.least if self.at_least else self.found.most
        reached, every = ((x >= self.bound if self.at_least else x < self.bound) for x in (self.found.median, worst))
        if reached:
            return "**reached**" if every else "reached by the median, not in every round"
        return "not reached"


def targets(results, settings):
    """List of Target, of what the results have anything to say about."""
    reference = (sized(settings.reference), "flying")
    engine = {n: (*reference, "engine", n) for n in CORES}
    found = []

    def compare(what, bound, first, second):
        alone = first[-1] == second[-1] == 1
        by_processor = results.ratio(first, second, by_processor=True) if alone else None
        found.append(Target(what, bound, results.ratio(first, second), by_processor=by_processor))

    if len(results.of(*engine[1])):
        others = {
            "stock": ("YADE's own loop with its stock cohesive law", 27),
            "lammps": ("LAMMPS", 10),
            "liggghts": ("LIGGGHTS", 5),
        }
        for code, (name, bound) in others.items():
            compare(f"one core / {name}, one core", bound, engine[1], (*reference, code, 1))
        compare("two cores / one core", 1.9, engine[2], engine[1])
        for n, cores in CORES.items():
            sizes = [(sized(radius), "flying", "engine", n) for radius in settings.radii]
            worst = min(
                (one for one in sizes if results.rate(*one)), key=lambda one: results.ratio(one, engine[n]).median
            )
            compare(
                f"slowest of all sizes ({worst[0].replace('cpe-', 'R = ')}) / R = {settings.reference:g}, {cores}",
                0.75,
                worst,
                engine[n],
            )
        for kind, name in (("materials", "two materials"), ("radii", "two sizes of grain")):
            for n, cores in CORES.items():
                compare(f"{name} / like grains, {cores}", 0.5, (kind, "flying", "engine", n), engine[n])
        found.append(memory(results, settings))
    found += [
        target for name, scene in bench(settings).items() if scene.through for target in through(results, name, scene)
    ]
    return found + of_papers(results, settings)


def memory(results, settings):
    """The largest over the sizes from the reference up."""
    table = results.moments.set_index("scene")
    names = [sized(radius) for radius in settings.radii if radius >= settings.reference]
    each = [table.bytes[name] / table.contacts[name] for name in names if name in table.index]
    what = "memory, bytes a contact (range: all sizes from the reference up)"
    return Target(what, 1000, Spread(max(each), min(each), max(each)) if each else None, at_least=False)


def through(results, name, scene):
    """The slowest part of a collision; one run, so that the spread is that of the parts: slowest to fastest."""
    for n, cores in CORES.items():
        flying, *parts = (results.rate(name, moment, "engine", n) for moment in scene.moments)
        if flying and all(parts):
            rates = [part.median / flying.median for part in parts]
            what = f"slowest part of {scene.title} (range: all parts) / flying, {cores}"
            yield Target(what, 0.75, Spread(min(rates), min(rates), max(rates)))


def of_papers(results, settings):
    """On the scenes of the papers, on two threads unless said."""
    found, scenes = [], all_scenes(settings)
    whole = results.whole(scenes)
    for name, bound in (("a22", 6), ("a22-drag", 6), ("k13", 40)):
        if name in whole:
            each = [results.minutes(whole[name], "engine", 2, of) for of in (statistics.median, min, max)]
            found.append(Target(f"minutes for a run, {scenes[name].title}", bound, Spread(*each), at_least=False))
    for name in ("a22", "a22-drag"):
        moments = whole[name].moment if name in whole else []
        ratios = [results.ratio((name, moment, "engine", 2), (name, moment, "lammps", 2)) for moment in moments]
        if ratios and None not in ratios:
            worst = min(ratios, key=lambda spread: spread.median)
            found.append(Target(f"slowest moment / LAMMPS on two cores, {scenes[name].title}", 8, worst))
    flying, slow = (results.rate(name, "flying", "engine", 2) for name in ("a22", "a22-slow"))
    if flying and slow:  # not measured in the same rounds
        ratio = Spread(flying.median / slow.median, flying.least / slow.most, flying.most / slow.least)
        found.append(Target("flying at 50.1 m/s / the same grains at 0.5 m/s", 0.9, ratio))
    for n, bound in ((1, 100), (2, 190)):
        if rate := results.rate("cpe", "flying", "engine", n):
            million = Spread(*(x / 1e6 for x in (rate.median, rate.least, rate.most)))
            found.append(Target(f"million contact updates a second, two CPE, R 40, {CORES[n]}", bound, million))
    return found
