"""How long the rows of a study take: a model of a run's time, times the pace of runs that have ended and of a
measured piece.

    yade -n -x yade_scripts/runner/cost.py SCRIPT radius=40 filling=0.3

measures a piece of a run of a script in rows.KINDS, and prints one line of JSON. setup: seconds of building the run;
step: seconds of a small step of the fused engine, among its first `steps`. Both of the clock, as the runs will take
them: on a machine that is busy with other work, more than of processor time."""

import heapq
import json
import os
import sys
import time
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

if __name__ == "__main__":
    sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(sys.argv[0])))))
from yade_scripts.run.kind import Schedule

# Seconds of a usual processor (a core of an AMD EPYC of 2024), of runs of 60 to 51,200 grains, by processor time;
# linear in the
# grains: what is there of any run, and what a grain adds.
STEP, CONTACT = (0.8e-6, 5e-9), 14e-9  # a small step of the fused engine: also of each contact
CACHE_EXPONENT = 0.07  # grains and contacts of large scenes take longer: with this power of their number
SAMPLE = 0.15e-3, 0.15e-6  # of the history
LOOK, LOOKS = (1e-3, 2e-6), 100  # whether pieces are apart, states: so often in the duration of any run
SETUP = 0.01, 2e-4  # packings and the scene
BETWEEN = 0.04  # from a run's end to the next one's beginning
FUNCTORS = 37  # a step of YADE's own loop over one of the engine

ALIKE = np.log(
    2
)  # logarithm of the ratio of two runs' times at which one weighs half as much for the other as an equal
RECENT = 10  # runs that ended later halve the weight of one: a machine is busier at times
MOST = 20 * RECENT  # of a kind and engine, the latest: earlier ones weigh less than a millionth
MEASURED, AT_ONCE = (
    1.0,
    20,
)  # s of processor time of a measured piece, so that what else runs has its turns; steps between looks


@dataclass(frozen=True)
class Piece:
    """A measured piece of a row's run: pace and setup are the seconds of its steps and of setting it up, over those
    of a usual processor; start: seconds in which YADE starts."""

    pace: float
    setup: float
    start: float


@dataclass
class Cost:
    """seconds(row) that the run of a runner.rows.StudyRow takes.

    ended: [(row, wall time [s])] of runs that came to their end, in the order in which they did; piece: Piece, or None.
    """

    piece: Piece = None
    ended: list = field(default_factory=list)
    _known: dict = field(default_factory=dict, init=False, repr=False, compare=False)

    @cached_property
    def _ended(self):
        """{(name of the kind, engine): (logarithms of the model's times, ratios of the times to these, weights)}."""
        by_kind = {}
        for later, (row, taken) in enumerate(reversed(self.ended)):
            found = by_kind.setdefault((row.kind.name, row.parameters.engine), [])
            if len(found) < MOST:
                model = self._model(row)
                found.append((np.log(model), taken / model, 0.5 ** (later / RECENT)))
        return {key: np.array(found).T for key, found in by_kind.items()}

    def seconds(self, wanted):
        """Estimated wall time [s] of a row's run, or None when too little is known."""
        if wanted.estimate is None:
            return None
        key = wanted.kind.name, wanted.parameters.engine, self._model(wanted)
        if key not in self._known:  # the rows of a table differ in their seeds, as a rule
            self._known[key] = self._seconds(key[:2], key[2])
        return self._known[key]

    def _seconds(self, of, model):
        sizes, ratios, weights = self._ended.get(of, np.empty((3, 0)))
        weights = weights / (1 + ((sizes - np.log(model)) / ALIKE) ** 2)
        of_piece = float(self.piece is not None)  # as much as one run
        known = weights.sum() + of_piece
        return (model + self._piece.pace * BETWEEN) * float(weights @ ratios + of_piece) / known if known else None

    def _model(self, row):
        setup, stepping = row.typical
        return self._piece.setup * setup + self._piece.pace * stepping

    @property
    def _piece(self):
        return self.piece or Piece(1.0, 1.0, 0.0)


def typical_seconds(row):
    """Seconds that the run of a row takes on a usual processor, by the row alone; infinity for a kind of a user's
    own."""
    return np.inf if row.estimate is None else setup_seconds(row) + stepping_seconds(row)


def setup_seconds(row):
    """Seconds of a usual processor in which a row's run is set up."""
    return _linear(SETUP, row.estimate.grains)


def stepping_seconds(row):
    """The same of all that follows."""
    grains, _, steps, share = row.estimate
    samples = Schedule.of(steps / share, 1.0).samples
    looking = share * (samples * _linear(SAMPLE, grains) + LOOKS * _linear(LOOK, grains))
    slower = FUNCTORS if row.parameters.engine == "functors" else 1
    return slower * steps * step_seconds(row) + looking


def step_seconds(row):
    """The same of a small step, of the fused engine."""
    grains, contacts, _, _ = row.estimate
    crowd = max(1.0, (grains / 1000) ** CACHE_EXPONENT)
    return (_linear(STEP, grains) + CONTACT * contacts) * crowd


def _linear(numbers, grains):
    constant, of_grain = numbers
    return constant + of_grain * grains


def makespan(running, waiting, at_once):
    """Seconds until all is done: [(time left [s], threads)] of what runs, the same of what waits in its order,
    threads at once."""
    ends = [0.0] * at_once
    for left, threads in [*running, *waiting]:
        taken = [heapq.heappop(ends) for _ in range(min(threads, at_once))]
        for _ in taken:
            heapq.heappush(ends, max(taken) + left)
    return max(ends)


def measure(script, arguments):
    """Print what the head of this file says. Called within YADE."""
    from yade_scripts.parameters.errors import one_line_errors
    from yade_scripts.run.parameters import from_arguments
    from yade_scripts.runner.rows import kind_of

    with one_line_errors("cost.py"):
        kind = kind_of(script)
        parameters = kind.parse(from_arguments(arguments))
        import contact_law  # noqa: F401  (puts the plugin's classes into yade.wrapper)
    from yade.wrapper import JKRWadaEngine, Omega

    with one_line_errors("cost.py"):
        omega, start = Omega(), time.monotonic()
        scene = kind.prepare(parameters, omega.numThreads)
    scene.build()
    threads = scene.parameters.threads
    fused = JKRWadaEngine(subSteps=AT_ONCE, threads=threads, **scene.law)
    omega.dt = AT_ONCE * scene.time_step
    omega.engines = [fused]
    fused.prepare()
    ready, end = time.monotonic(), time.process_time() + MEASURED * threads
    while time.process_time() < end:
        omega.step()
    steps = AT_ONCE * omega.iter
    print(json.dumps({"setup": ready - start, "step": (time.monotonic() - ready) / steps, "steps": steps}))


if __name__ == "__main__":
    measure(sys.argv[1], sys.argv[2:])
    sys.exit(0)
