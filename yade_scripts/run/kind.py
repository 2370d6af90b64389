"""The interface of a kind of run, an instance of Kind for each file of experiments/, and when a run is sampled."""

from dataclasses import dataclass, field
from math import ceil
from typing import Any, Callable, Mapping, NamedTuple

import numpy as np

from analysis.runs.format import RunKind
from yade_scripts.materials import OF_BOND, derived_grains

INTERVAL = 200  # a sample of 200 to 1,000 grains takes as long as 30 to 60 steps
FEWEST_SAMPLES = 300
MOST_SAMPLES = 200_000  # that a history holds in memory: 30 MB


class Estimate(NamedTuple):
    """The size of a run before it begins: number of grains, mean number of contacts, small steps until its end."""

    grains: float
    contacts: float
    steps: float


class Ending(NamedTuple):
    """What became of a run that came to its end."""

    outcome: str  # in a word or two
    words: str = ""  # more about it
    why_undecided: str | None = None  # where longer runs may have another outcome


@dataclass(frozen=True)
class Scene:
    """A run that is ready to be built in YADE. States are those of contact_law.snapshot(), with `grains`.

    control(recorder, state) is called after each sample, may change the scene, and is true when the run is at its end
    before `duration` is over; it must follow from history, state and scene alone, so that a run resumes."""

    parameters: Any  # of the kind, complete, with a duration and a number as stepFraction
    constants: Mapping  # of a contact, as run.scene.pair_constants() gives them
    derived: Mapping  # what run.json has beside the grains and constants
    grains: Mapping  # arrays (N,) that every state has: aggregate, of several materials material and mass
    build: Callable[[], None]  # makes the bodies (and the cell)
    series: Callable[[Mapping], Mapping[str, Any]]  # state -> {name: value} of the kind's own series
    # Of a collision, for a device: packings and their velocities, and where it has them, when it is at rest
    # (collision.Rest) and a shorter step (collision.ShorterStep).
    placed: tuple | None = None
    rest: Any = None
    shorter: Any = None
    law: Mapping = field(default_factory=dict)  # attributes of the contact law, in the engine and in the functors
    energy_is_conserved: bool = True  # whether all channels together are constant
    control: Callable[[Any, Mapping], bool] = lambda recorder, state: False
    ended_by: Callable[[Any], str | None] = lambda recorder: None  # what brought a run to its end, in a few words
    interval: int = INTERVAL  # small steps between samples, at most
    step_choice: str = "as given"  # how stepFraction came about, in one line

    @property
    def time_step(self):
        """The small step [s]."""
        return self.parameters.stepFraction * self.constants["timeUnit"]


@dataclass(frozen=True)
class Kind:
    """A kind of run."""

    format: RunKind  # its name, series and states in run folders
    parameters: type  # of GrainParameters and RunParameters, with a field `duration` [s] and the method title()
    prepare: Callable[[Any, int], Scene]  # (parameters, threads of YADE), called within YADE
    estimate: Callable[[Any], Estimate]  # of parameters, without YADE
    # (parameters, run.json) -> {name: value} that a run should hold of parameters that are None and follow from the run
    expected: Callable[[Any, Mapping], Mapping] = lambda parameters, run: {}
    # run folder -> Ending, or None where there is nothing that becomes of such a run
    ending: Callable[[str], Ending | None] = lambda folder: None

    @property
    def name(self):
        return self.format.name

    def parse(self, texts, description=None):
        """Parameters from {name: text or number}; see yade_scripts.parameters.Parameters.parse."""
        return self.parameters.parse(texts, description)


@dataclass(frozen=True)
class Schedule:
    """Steps of the run; a sample every `interval` of them and at both ends; which samples become states."""

    steps: int
    interval: int
    states: frozenset

    @property
    def samples(self):
        """Number of intervals between samples."""
        return self.steps // self.interval

    @classmethod
    def of(cls, duration, time_step, interval=INTERVAL, states=22, kept=None):
        """At most `interval` steps between samples, at least FEWEST_SAMPLES and at most MOST_SAMPLES intervals if the
        steps suffice. kept: the interval of a run that is continued."""
        steps = max(1, ceil(duration / time_step * (1 - 1e-12)))
        interval = kept or max(1, min(interval, steps // FEWEST_SAMPLES), ceil(steps / MOST_SAMPLES))
        samples = ceil(steps / interval)
        chosen = np.linspace(0, samples, states).round().astype(int)
        return cls(samples * interval, interval, frozenset(int(number) for number in chosen))


def derived(scene, schedule):
    """The entry `derived` of run.json: the grains' material, what follows from it and the parameters (SI)."""
    constants = scene.constants
    return {
        **derived_grains(scene.parameters.of_each(), constants),
        **({name: constants["bond"][name] for name in OF_BOND} if constants.get("bond") else {}),
        "timeStep": scene.time_step,
        "steps": schedule.steps,
        **scene.derived,
        "stepChoice": scene.step_choice,
    }
