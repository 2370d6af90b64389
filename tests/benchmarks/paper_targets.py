"""What the engine is to reach on the scenes of the papers, and whether it did."""

import statistics

from paper_moments import by_scene, minutes, title_of
from ratios import Spread
from targets import Target


def targets(moments):
    """Of what was measured."""
    scenes, found = by_scene(moments), []
    bounds = {"a22": 6, "a22-drag": 6, "k13": 40}  # minutes
    for scene, bound in bounds.items():
        if scene in scenes:
            each = [minutes(scenes[scene], lambda m, of=of: of(m.turns(2))) for of in (statistics.median, min, max)]
            spread = None if None in each else Spread(*each)
            found.append(Target(f"minutes for a run, {title_of(scene)}", bound, spread, at_least=False))
    for scene in ("a22", "a22-drag"):
        ratios = [moment.against_lammps(2) for moment in scenes.get(scene, [])]
        if ratios and None not in ratios:
            worst = min(ratios, key=lambda spread: spread.median)
            found.append(Target(f"slowest moment / LAMMPS on two cores, {title_of(scene)}", 8, worst))
    if "a22" in scenes and "a22-slow" in scenes:
        flying, slow = scenes["a22"][0].rate(2), scenes["a22-slow"][0].rate(2)
        ratio = Spread(flying.median / slow.median, flying.least / slow.most, flying.most / slow.least)
        found.append(Target("flying at 50.1 m/s / the same grains at 0.5 m/s", 0.9, ratio))
    for threads, bound in ((1, 100), (2, 190)) if "cpe" in scenes else ():
        words = f"million contact updates a second, two CPE, R 40, {'one thread' if threads == 1 else 'two threads'}"
        found.append(Target(words, bound, scenes["cpe"][0].rate(threads)))
    return found
