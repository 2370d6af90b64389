"""What was measured at the moments of the papers' runs (papers.json), and what follows from it for a whole run."""

import json
import statistics
from dataclasses import dataclass

from paper_scenes import SCENES
from ratios import Spread

RESULT = "papers.json"


def read(folder):
    """What papers.json of a folder holds, or nothing yet."""
    path = folder / RESULT
    return json.loads(path.read_text()) if path.exists() else {"scenes": {}}


@dataclass(frozen=True)
class Moment:
    """A scene at a moment: what was measured there."""

    scene: str
    name: str
    found: dict

    @property
    def contacts(self):
        return self.found["engine"]["contacts"]

    @property
    def grains(self):
        return self.found["engine"]["grains"]

    def turns(self, threads):
        """ms a small step of each measurement with so many threads."""
        turns = self.found["engine"]["turns"]
        return [1e3 * turn["seconds"] / turn["steps"] for turn in turns if turn["threads"] == threads]

    def best(self, threads):
        """ms a small step."""
        return min(self.turns(threads))

    def median(self, threads):
        return statistics.median(self.turns(threads))

    def rate(self, threads):
        """Spread of the million contact updates a second."""
        return Spread.of([self.contacts / ms / 1e3 for ms in self.turns(threads)])

    def lammps(self, cores):
        """ms a step, or None."""
        run = self.found["lammps"].get(str(cores))
        return run["msPerStep"] if run else None

    def against_lammps(self, cores):
        """Spread of LAMMPS's ms a step over the engine's; a contact counts as much in either. None where LAMMPS was not measured."""
        run = self.found["lammps"].get(str(cores))
        if not run:
            return None
        theirs = run["msPerStep"] / run["contacts"]
        return Spread.of([theirs / (ms / self.contacts) for ms in self.turns(cores)])

    def steps(self):
        """Small steps of all measurements."""
        return sum(turn["steps"] for turn in self.found["engine"]["turns"])


def moments_of(found):
    """[Moment], in the order of the scenes and of time."""
    return [
        Moment(name, moment, found["scenes"][name][moment])
        for name in [*SCENES, *(name for name in found["scenes"] if name not in SCENES)]
        if name in found["scenes"]
        for moment in sorted(found["scenes"][name], key=lambda one: found["scenes"][name][one]["run"]["progress"])
    ]


def by_scene(moments):
    """{scene: its Moments}"""
    found = {}
    for moment in moments:
        found.setdefault(moment.scene, []).append(moment)
    return found


def title_of(scene):
    return SCENES[scene].title if scene in SCENES else scene


def weights(moments):
    """Fraction of the run's steps that each of a scene's moments stands for: those nearer to it than to another (of a compression in the logarithm of the
    filling, in which its time is even)."""
    at = [moment.found["run"]["progress"] for moment in moments]
    ends = [0.0, *((a + b) / 2 for a, b in zip(at, at[1:])), 1.0]
    return [end - begin for begin, end in zip(ends, ends[1:])]


def is_whole(moments):
    """Whether these are all of a scene's moments."""
    scene = SCENES.get(moments[0].scene)
    return scene is None or {moment.name for moment in moments} == set(scene.moments)


def minutes(moments, ms):
    """Of the whole run; ms: function of a Moment. None where it is not known of all of the scene's moments."""
    each = [ms(moment) for moment in moments]
    if None in each or not is_whole(moments):
        return None
    mean = sum(weight * one for weight, one in zip(weights(moments), each))
    return mean * moments[0].found["run"]["steps"] / 60e3
