"""What the engine is to reach, and whether it did."""
from dataclasses import dataclass

from ratios import Spread, Speeds
from speed import UNLIKE


@dataclass(frozen=True)
class Target:
    """what is compared; the bound; Spread that was measured or None; whether more is better."""
    what: str
    bound: float
    found: Spread
    at_least: bool = True

    def line(self):
        bound = f"{'at least' if self.at_least else 'below'} {self.bound:g}"
        if self.found is None:
            return f"| {self.what} | {bound} | - | not measured |"
        reached = self.found.median >= self.bound if self.at_least else self.found.median < self.bound
        every = (self.found.least >= self.bound) if self.at_least else (self.found.most < self.bound)
        verdict = "**reached**" if reached and every else "reached by the median, not in every round" if reached else "not reached"
        return f"| {self.what} | {bound} | {self.found.text(0 if self.bound >= 100 else 2)} | {verdict} |"


def targets(how, found):
    """List of Target; those of parts that were not measured are left out."""
    result = []
    if "speed" in found:
        speeds = Speeds(found["speed"]["results"], how.reference)
        result += against_others(speeds) + over_sizes(how, speeds) + unlike(speeds)
        result += [memory(found["speed"]["memory"])]
    if "collision" in found:
        result += through_collision(found["collision"])
    return result


def engine(threads=1, **labels):
    return {"code": "engine", "threads": threads, **labels}


def against_others(speeds):
    ratio = speeds.ratio
    return [Target("one core / YADE's own loop with its stock cohesive law, one core", 27, ratio(engine(), {"code": "stock"})),
            Target("one core / LAMMPS, one core", 10, ratio(engine(), {"code": "lammps"})),
            Target("one core / LIGGGHTS, one core", 5, ratio(engine(), {"code": "liggghts"})),
            Target("two cores / one core", 1.9, ratio(engine(2), engine()))]


def over_sizes(how, speeds):
    """The slowest size, for one and two cores."""
    found = []
    for threads in (1, 2):
        ratios = {radius: speeds.ratio(engine(threads, radius=radius), engine(threads)) for radius in how.radii}
        worst = min(ratios, key=lambda radius: ratios[radius].median)
        grains = round(0.8 * worst**3)
        found.append(Target(f"slowest of all sizes (R = {worst:g}, {grains} grains) / R = {how.reference:g}, {cores(threads)}", 0.75, ratios[worst]))
    return found


def through_collision(collision):
    """The slowest part; one run, so that the spread is that of the parts: slowest to fastest."""
    found = []
    for threads in (1, 2):
        rates = [part[f"rate{threads}"] / collision["before"][threads] for part in collision["parts"]]
        found.append(Target(f"slowest part of a collision (range: all parts) / before it, {cores(threads)}", 0.75, Spread(min(rates), min(rates), max(rates))))
    return found


def unlike(speeds):
    names = {"materials": "two materials", "radii": "two sizes of grain"}
    return [Target(f"{names[kind]} / like grains, {cores(threads)}", 0.5, speeds.ratio(engine(threads, kind=kind), engine(threads))) for kind in UNLIKE for threads in (1, 2)]


def memory(measured):
    """The largest over the sizes."""
    return Target("memory, bytes a contact (range: all sizes from the reference up)", 1000, most_of([m["bytes"] / m["contacts"] for m in measured.values()]), at_least=False)


def most_of(values):
    return Spread(max(values), min(values), max(values))


def cores(threads):
    return "one core" if threads == 1 else "two cores"
