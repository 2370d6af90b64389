"""What the engine is to reach, and whether it did."""

from dataclasses import dataclass

from ratios import Speeds, Spread, by_processor_time
from speed import UNLIKE


@dataclass(frozen=True)
class Target:
    """what is compared; the bound; Spread that was measured or None; whether more is better; the same by processor time, where that makes sense."""

    what: str
    bound: float
    found: Spread
    at_least: bool = True
    by_processor: Spread = None

    def line(self):
        bound = f"{'at least' if self.at_least else 'below'} {self.bound:g}"
        if self.found is None:
            return f"| {self.what} | {bound} | - | not measured |"
        reached = self.found.median >= self.bound if self.at_least else self.found.median < self.bound
        every = (self.found.least >= self.bound) if self.at_least else (self.found.most < self.bound)
        aside = f"; by processor time {self.by_processor.text(2)}" if self.by_processor else ""
        verdict = (
            "**reached**"
            if reached and every
            else "reached by the median, not in every round"
            if reached
            else "not reached"
        )
        return f"| {self.what} | {bound} | {self.found.text(0 if self.bound >= 100 else 2)}{aside} | {verdict} |"


def targets(how, found):
    """List of Target; those of parts that were not measured are left out."""
    result = []
    if "speed" in found:
        speeds = Speeds(found["speed"]["results"], how.reference)
        result += against_others(speeds) + over_sizes(how, speeds) + unlike(speeds)
        result += [memory(found["speed"]["memory"])]
    if "collision" in found:
        for collision in found["collision"]:
            result += through_collision(collision)
    return result


def engine(threads=1, **labels):
    return {"code": "engine", "threads": threads, **labels}


def compared(speeds, what, bound, first, second):
    """Target of the ratio of two codes, each a dict of labels; by processor time too where both used one core."""
    alone = first.get("threads", 1) == second.get("threads", 1) == 1
    return Target(
        what,
        bound,
        speeds.ratio(first, second),
        by_processor=speeds.ratio(first, second, by_processor_time) if alone else None,
    )


def against_others(speeds):
    bounds = {
        "stock": ("YADE's own loop with its stock cohesive law", 27),
        "lammps": ("LAMMPS", 10),
        "liggghts": ("LIGGGHTS", 5),
    }
    result = [
        compared(speeds, f"one core / {name}, one core", bound, engine(), {"code": code})
        for code, (name, bound) in bounds.items()
    ]
    return result + [compared(speeds, "two cores / one core", 1.9, engine(2), engine())]


def over_sizes(how, speeds):
    """The slowest size, for one and two cores."""
    found = []
    for threads in (1, 2):
        ratios = {radius: speeds.ratio(engine(threads, radius=radius), engine(threads)) for radius in how.radii}
        worst = min(ratios, key=lambda radius: ratios[radius].median)
        grains = round(0.8 * worst**3)
        what = f"slowest of all sizes (R = {worst:g}, {grains} grains) / R = {how.reference:g}, {cores(threads)}"
        found.append(compared(speeds, what, 0.75, engine(threads, radius=worst), engine(threads)))
    return found


def through_collision(collision):
    """The slowest part; one run, so that the spread is that of the parts: slowest to fastest."""
    found = []
    for threads in (1, 2):
        rates = [part[f"rate{threads}"] / collision["before"][threads] for part in collision["parts"]]
        found.append(
            Target(
                f"slowest part of a collision at {collision['speed']:g} m/s, R = {collision['radius']:g} (range: all parts) / the same grains at the usual speed, {cores(threads)}",
                0.75,
                Spread(min(rates), min(rates), max(rates)),
            )
        )
    return found


def unlike(speeds):
    names = {"materials": "two materials", "radii": "two sizes of grain"}
    return [
        compared(
            speeds, f"{names[kind]} / like grains, {cores(threads)}", 0.5, engine(threads, kind=kind), engine(threads)
        )
        for kind in UNLIKE
        for threads in (1, 2)
    ]


def memory(measured):
    """The largest over the sizes."""
    return Target(
        "memory, bytes a contact (range: all sizes from the reference up)",
        1000,
        most_of([m["bytes"] / m["contacts"] for m in measured.values()]),
        at_least=False,
    )


def most_of(values):
    return Spread(max(values), min(values), max(values))


def cores(threads):
    return "one core" if threads == 1 else "two cores"
