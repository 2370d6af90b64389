"""Series that only some engines have, and runs that end before their time: the recorder on its own, within YADE."""

import types

import pytest
from scenes import *

from analysis.runs.format import COLLISION
from yade_scripts.run.schedule import Schedule

OWN = {"d": 0.0, "v": 0.0, "contacts_between": 0}


class Folder:
    """Keeps what is written in memory."""

    def __init__(self):
        self.states = []

    def write_state(self, number, state):
        self.states.append(number)

    def keep_states(self, number):
        pass

    def write_history(self, series):
        self.series = {name: list(values) for name, values in series.items()}


def recorder_of(control=lambda recorder, state: False):
    """A recorder of 200 samples; control: whether the run has come to its end."""
    from yade_scripts.run.recorder import Recorder

    scene = types.SimpleNamespace(
        series=lambda state: OWN, aggregate=np.array([0, 1]), energy_is_conserved=True, control=control
    )
    return Recorder(Folder(), Schedule(200, 1, frozenset([0])), COLLISION, scene)


@pytest.mark.in_yade
def test_counts_of_the_engine_and_an_early_end():
    from yade_scripts.run import recorder as module

    new_scene(1e-10)
    for x, v in ((0, 1), (2.1e-7, -1)):
        grain((x, 0, 0), 1e-7, ice(), (v, 0, 0))
    fused_engine(subSteps=10)
    plain = recorder_of()
    O.step()
    plain.sample()
    plain.write_history()
    assert {"formed", "broken"} & set(plain.folder.series) in (set(), {"formed", "broken"})

    counts = iter([{"formed": 0, "broken": 0}, {"formed": 3, "broken": 1}, {"formed": 4, "broken": 1}])
    module.engine_counts = lambda: next(counts)
    counted = recorder_of(lambda recorder, state: recorder.is_one_of(100) and state["time"] > 2.5e-10)
    for number in range(3):
        assert not counted.finished  # asked at every second of 200 samples: not at the first two
        O.step()
        counted.sample()
    counted.write_history()
    series = counted.folder.series
    assert counted.error is None and counted.finished and counted.folder.states == [0, 1]
    assert series["formed"] == [0, 3, 4] and series["broken"] == [0, 1, 1]
    assert counted.time == pytest.approx(4e-10, rel=1e-6)
    again = recorder_of()
    again.resume(counted.rows(), counted.columns, counted.states_written)
    again.write_history()
    assert again.folder.series == series
