"""Series that only some engines have, and runs that end before their time: the recorder on its own, within YADE."""

SCRIPT = """
import types
from analysis.runs.format import COLLISION
from yade_scripts.run import recorder as module
from yade_scripts.run.schedule import Schedule

class Folder:
    def __init__(self):
        self.states = []
    def write_state(self, number, state):
        self.states.append(number)
    def keep_states(self, number):
        pass
    def write_history(self, series):
        self.series = {name: list(map(float, values)) for name, values in series.items()}

ice = JKRMat(young=7e9, poisson=0.25, density=1000, surfaceEnergy=0.1, criticalRolling=0.8e-9)
O.materials.append(ice)
for x, v in ((0, 1), (2.1e-7, -1)):
    body = utils.sphere((x, 0, 0), 1e-7, material=ice)
    body.state.vel = (v, 0, 0)
    O.bodies.append(body)
O.trackEnergy = True
O.dt = 1e-10
O.engines = [JKRWadaEngine(subSteps=10, threads=1)]
own = {"d": 0.0, "v": 0.0, "contacts_between": 0}
counted = iter([{"formed": 0, "broken": 0}, {"formed": 3, "broken": 1}, {"formed": 4, "broken": 1}])

def recorded(counts, control=lambda recorder, state: False):
    if counts:
        module.engine_counts = lambda: next(counted)
    scene = types.SimpleNamespace(series=lambda state: own, aggregate=np.array([0, 1]), energy_is_conserved=True, control=control)
    folder = Folder()
    recorder = module.Recorder(folder, Schedule(200, 1, frozenset([0])), COLLISION, scene)
    return folder, recorder

folder, recorder = recorded(False)
O.step(); recorder.sample(); recorder.write_history()
result["plain"] = sorted(folder.series)
folder, recorder = recorded(True, lambda recorder, state: recorder.is_one_of(100) and state["time"] > 2.5e-10)
for _ in range(2):
    O.step(); recorder.sample()
result["unfinished"] = bool(recorder.finished)
O.step(); recorder.sample(); recorder.write_history()
result["counted"], result["error"] = folder.series, str(recorder.error)
result["finished"], result["states"], result["time"] = bool(recorder.finished), folder.states, recorder.time
again_folder, again = recorded(False)
again.resume(recorder.rows(), recorder.columns, recorder.states_written)
again.write_history()
result["resumed"] = again_folder.series == folder.series
"""


def test_counts_of_the_engine_and_an_early_end(yade):
    found = yade(SCRIPT)
    assert {"formed", "broken"} & set(found["plain"]) in (set(), {"formed", "broken"})
    assert found["error"] == "None"
    assert found["counted"]["formed"] == [0, 3, 4] and found["counted"]["broken"] == [0, 1, 1]
    # asked at every second of 200 samples: not at the first two
    assert not found["unfinished"] and found["finished"] and found["states"] == [0, 1]
    assert abs(found["time"] - 4e-10) < 1e-16 and found["resumed"]
