"""Contact updates a second of every code at the moments of the scenes, in rounds: each measures all of them once, so that
ratios are taken between neighbours in time."""

from contextlib import ExitStack

import codes
import engine_parts
import moments
import numpy as np
import peers
import scene_file
from measured_on import fraction_of_others, machine

from analysis.measures.fragments import fragment_labels
from analysis.progress import progress

SUMMED = ("searches", "distanceChecks", "events", "formed", "broken", "contactUpdates", "energyChange", "boundaryWork")


def batches(scenes):
    """What is measured together, as lists of (name, Scene, moment): the scenes of one moment, so that sizes and kinds of
    grains are compared within a round; every other moment by itself, for its memory and so that it can be resumed."""
    every = [(name, scene, moment) for name, scene in scenes.items() for moment in scene.moments]
    single = [one for one in every if len(one[1].moments) == 1]
    return [single] * bool(single) + [[one] for one in every if len(one[1].moments) > 1]


class Place:
    """A moment of a scene, its file, and what is measured there; stack (an ExitStack) closes the codes."""

    def __init__(self, name, scene, moment, start, settings, folder, stack):
        self.name, self.scene, self.moment, self.start, self.settings = name, scene, moment, start, settings
        self.path = moments.path_of(name, moment, scene, folder)
        self.grains = scene_file.load(self.path)
        self.missing = {code: reason for code in scene.codes if (reason := codes.missing(code, self.grains))}
        there = [code for code in scene.codes if code not in self.missing]
        self.answers = {(code, threads): [] for code in there for threads in codes.threads_of(code)}
        self.open = {code: codes.open_code(code, self.path, start.together, settings) for code in there}
        for code in self.open.values():
            stack.callback(code.close)

    def most(self):
        """Small steps of one measurement: all of them together leave a flight in the air, and are a small part of another
        run."""
        flight = self.scene.apart / self.start.step / 1.2 if self.moment == next(iter(self.scene.moments)) else 0
        return int((flight or self.settings.stretch * self.start.steps) / self.settings.rounds / 2)

    def measure(self, code, threads):
        """Keep the answer to a measurement; a peer that fails is noted, and not tried again."""
        if code not in self.missing:
            try:
                answer = self.open[code].measure(threads, self.settings.seconds, self.most())
                self.answers[code, threads].append(answer)
            except peers.PeerFailed as error:
                self.missing[code] = f"failed: {' '.join(str(error).split())[:200]}"

    def rows(self):
        """Rows of speed.csv."""
        place = {"scene": self.name, "moment": self.moment}
        measured = [
            {**place, **answer, "code": code, "threads": threads, "round": turn, "rate": rate(answer)}
            for (code, threads), answers in self.answers.items()
            for turn, answer in enumerate(answers)
        ]
        return measured + [{**place, "code": code, "note": reason} for code, reason in self.missing.items()]

    def about(self, others):
        """Row of moments.csv; others: fraction of the machine that other programs took."""
        turns, start, about = self.answers["engine", 1] + self.answers["engine", 2], self.start, machine()
        fastest = min(turn["seconds"] / turn["steps"] for turn in turns)
        to_sample = max(start.together, min(int(self.settings.sampled / fastest), self.most()))
        pairs = np.column_stack([self.grains.contacts[name] for name in ("first", "second")])
        return {
            **{"scene": self.name, "moment": self.moment, "progress": start.progress[self.moment]},
            **{"runSteps": start.steps, "step": round(start.step / start.time_unit, 6), "grains": turns[0]["grains"]},
            **{"contacts": sum(turn["contacts"] for turn in turns) / len(turns), "kinetic": turns[0]["kinetic"]},
            **{"pieces": int(fragment_labels(turns[0]["grains"], pairs).max()) + 1 if len(pairs) else None},
            **{"time": float(self.grains.head["time"]), "measuredSteps": sum(turn["steps"] for turn in turns)},
            **{name: sum(turn[name] for turn in turns) for name in SUMMED},
            **engine_parts.fractions(self.path, start.together, to_sample),
            **{"cpu": about["cpu"], "cores": about["cores"], "settings": self.settings.text(), "others": others},
            **{"commit": turns[0]["commit"], "bytes": turns[0]["bytes"]},
        }


def rate(answer):
    """Contact updates a second of a measurement."""
    return answer["contacts"] * answer["steps"] / answer["seconds"]


def measure(batch, begun, settings, folder=moments.FOLDER):
    """{"speed": rows, "moments": rows} (results.py) of a batch whose files are there; begun: {scene's name: starts.Start}."""
    others = 0.0
    with ExitStack() as stack:
        places = [Place(*one, begun[one[0]], settings, folder, stack) for one in batch]
        each = [(place, code, n) for place in places for code in place.scene.codes for n in codes.threads_of(code)]
        for turn in range(settings.rounds):
            others = max(others, fraction_of_others())
            for place, code, threads in progress(each, f"round {turn + 1} of {settings.rounds}"):
                if codes.CODES[code].law or turn < settings.peer_rounds:
                    place.measure(code, threads)
        return {
            "speed": [row for place in places for row in place.rows()],
            "moments": [place.about(others) for place in places],
        }
