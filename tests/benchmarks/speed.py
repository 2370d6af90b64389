"""Contact updates a second of every code at the moments of the scenes, in rounds: each measures all of them once, so that ratios are taken between neighbours in time."""

from contextlib import ExitStack

import codes
import engine_parts
import moments
import peers
import scene_file
from measured_on import fraction_of_others, machine

SUMMED = ("searches", "looks", "events", "formed", "broken", "contactUpdates", "energyChange", "boundaryWork")


def batches(scenes):
    """What is measured together, as lists of (name, Scene, moment): the bench's scenes of one moment, so that sizes and kinds of grains are compared within a round;
    every other moment by itself, for its memory and so that it can be resumed."""
    single = [
        (name, scene, moment) for name, scene in scenes.items() for moment in scene.moments if len(scene.moments) == 1
    ]
    alone = [
        [(name, scene, moment)]
        for name, scene in scenes.items()
        if len(scene.moments) > 1 and not scene.through
        for moment in scene.moments
    ]
    return [single] * bool(single) + alone


class Place:
    """A moment of a scene, its file, and the codes that are open on it: {(code, threads): what measures it}."""

    def __init__(self, name, scene, moment, start, settings, folder):
        self.name, self.scene, self.moment, self.start, self.settings = name, scene, moment, start, settings
        self.path = moments.path_of(name, moment, scene, folder)
        grains = scene_file.load(self.path)
        self.missing = {code: reason for code in scene.codes if (reason := codes.missing(code, grains))}
        self.open, self.answers = {}, {}

    def tasks(self):
        """[(code, threads)], in the order of a round."""
        return [(code, n) for code in self.scene.codes if code not in self.missing for n in codes.threads_of(code)]

    def open_codes(self, stack):
        """Start what measures, all at once; YADE's own loops have a YADE for each number of threads."""
        shared = {}
        for code, threads in self.tasks():
            own = threads if code in ("functors", "stock") else 1
            if (code, own) not in shared:
                shared[code, own] = codes.open_code(code, self.path, self.start.together, own, self.settings)
                stack.callback(shared[code, own].close)
            self.open[code, threads] = shared[code, own]

    def most(self):
        """Small steps of one measurement: all of them together leave a flight in the air, and are a small part of another run."""
        flight = self.scene.apart / self.start.step / 1.2 if self.moment == next(iter(self.scene.moments)) else 0
        return int((flight or self.settings.stretch * self.start.steps) / self.settings.rounds / 2)

    def measure(self, code, threads):
        """Keep the answer to a measurement; a peer that fails is noted, and not tried again."""
        if code in self.missing:
            return
        try:
            answer = self.open[code, threads].measure(threads, self.settings.seconds, self.most())
        except peers.PeerFailed as error:
            self.missing[code] = f"failed: {' '.join(str(error).split())[:200]}"
            return
        self.answers.setdefault((code, threads), []).append(answer)

    def rows(self):
        """Rows of speed.csv."""
        place = {"scene": self.name, "moment": self.moment}
        measured = [
            {
                **place,
                **answer,
                "code": code,
                "threads": threads,
                "round": turn,
                "rate": answer["contacts"] * answer["steps"] / answer["seconds"],
            }
            for (code, threads), answers in self.answers.items()
            for turn, answer in enumerate(answers)
        ]
        return measured + [{**place, "code": code, "note": reason} for code, reason in self.missing.items()]

    def about(self, others):
        """Row of moments.csv; others: fraction of the machine that other programs took."""
        turns = [answer for n in (1, 2) for answer in self.answers["engine", n]]
        steps = sum(turn["steps"] for turn in turns)
        parts = engine_parts.fractions(self.path, self.start.together, self._steps_to_sample(turns))
        about = self.open["engine", 1].wait()
        return {
            **of_run(self.name, self.moment, self.start, self.settings),
            **{"grains": turns[0]["grains"], "contacts": sum(turn["contacts"] for turn in turns) / len(turns)},
            **{"measuredSteps": steps, "kinetic": self.answers["engine", 1][0]["kinetic"]},
            **{name: sum(turn[name] for turn in turns) for name in SUMMED},
            **{{"events": "eventHandling"}.get(part, part): value for part, value in parts.items()},
            **{"bytes": about["bytes"], "commit": about["commit"], "others": others},
        }

    def _steps_to_sample(self, turns):
        fastest = min(turn["seconds"] / turn["steps"] for turn in turns)
        return max(self.start.together, min(int(self.settings.sampled / fastest), self.most()))


def of_run(name, moment, start, settings):
    """What a row of moments.csv says of the run and of how it was measured."""
    about = machine()
    return {
        **{"scene": name, "moment": moment, "progress": start.progress[moment]},
        **{"runSteps": start.steps, "step": round(start.step / start.time_unit, 6)},
        **{"cpu": about["cpu"], "cores": about["cores"], "settings": settings.text()},
    }


def measure(batch, begun, settings, done, folder=moments.FOLDER):
    """{"speed": rows, "moments": rows} (results.py) of a batch whose files are there.

    begun: {name of the scene: its starts.Start}; done() is called after each of count_of(batch, settings) measurements.
    """
    places = [Place(name, scene, moment, begun[name], settings, folder) for name, scene, moment in batch]
    others = 0.0
    with ExitStack() as stack:
        for place in places:
            place.open_codes(stack)
        for code in {code for place in places for code in place.open.values()}:
            code.wait()
        for turn in range(settings.rounds):
            others = max(others, fraction_of_others())
            for place in places:
                for code, threads in place.tasks():
                    if codes.CODES[code].law or turn < settings.peer_rounds:
                        place.measure(code, threads)
                    done()
        return {
            "speed": [row for place in places for row in place.rows()],
            "moments": [place.about(others) for place in places],
        }


def count_of(batch, settings):
    """Measurements of a batch; peers that are missing counted."""
    return settings.rounds * sum(len(codes.threads_of(code)) for _, scene, _ in batch for code in scene.codes)


def measure_through(name, scene, start, settings, folder=moments.FOLDER):
    """The same tables of a collision that is measured on its way: its flight, and its parts."""
    path = moments.path_of(name, next(iter(scene.moments)), scene, folder)
    together = start.together
    each = max(2, round(start.duration / start.step / together / settings.parts))
    flight = max(2, round(scene.apart / start.step / together))
    code = codes.open_code("engine", path, together, 1, settings)
    try:
        answers = code.through(flight, [each] * settings.parts)
        commit = code.wait()["commit"]
    finally:
        code.close()
    speed, about = [], []
    for moment, answer in zip(scene.moments, answers):
        place = {"scene": name, "moment": moment}
        for threads, rate in answer["rates"].items():
            measured = {
                "code": "engine",
                "threads": int(threads),
                "round": 0,
                "contacts": answer["contacts"],
                "rate": rate,
            }
            speed.append({**place, **measured})
        counted = {key: answer[key] for key in ("until", "contacts", "pieces", "events")}
        about.append({**of_run(name, moment, start, settings), **counted, "commit": commit})
    return {"speed": speed, "moments": about}
