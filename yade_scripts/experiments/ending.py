"""When a collision is at its end, and whether its outcome is decided there."""

import numpy as np

from analysis.measures.decided import RECENT, has_come_to_rest
from analysis.measures.of_run import outcome_of_run
from analysis.measures.plate import with_plate
from analysis.runs.folder import open_run
from analysis.runs.format import RESTING

CHECKS = 100  # times in a run that it is looked whether pieces are apart


def when_apart(parameters, constants, aggregate_radius, touch):
    """Scene.control of endWhenApart."""
    known = {**constants, **(constants["bond"] or {}), "aggregateRadius": aggregate_radius}
    known.update(grainRadius=parameters.grainRadius, density=parameters.density)

    begin = -np.inf if touch is None else touch

    def control(recorder, state):
        if not recorder.is_one_of(CHECKS):
            return False
        recorder.note(RESTING, float(has_come_to_rest(with_plate(state), known, begin, parameters.duration)))
        recent = recorder.recent(RESTING, RECENT * (state["time"] - (touch or 0.0)))
        return bool(np.all(recent[np.isfinite(recent)]))

    return control


def why_undecided(folder):
    """Why the outcome of the run in a folder is not decided (analysis.measures.decided), or None."""
    return outcome_of_run(open_run(folder)).why_undecided
