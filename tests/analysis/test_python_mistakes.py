"""What a call of a public function gets wrong, and the one line that says so (of the commands: tests/scripts/test_mistakes.py)."""

import warnings
from inspect import signature

import numpy as np
import pytest

import analysis

NAN, INF = float("nan"), float("inf")
# What is called, with run (a RunFolder), history (its), found (its table) and two grains P, R, C: the words of the line, which is all that
# is said.
MISTAKES = {
    "analysis.outcome(5, 200, 500, 2)": "filling = 2: must be a number > 0 and at most 1",
    "analysis.outcome(5, 200, 500, 0)": "filling = 0: must be a number > 0",
    "analysis.outcome(-5, 200, 500, .15)": "velocity = -5: must be a number >= 0",
    "analysis.outcome([1, NAN], 200, 500, .15)": "velocity = nan: must be a number >= 0",
    "analysis.outcome(5, 0, 500, .15)": "projectile = 0: must be a number >= 1",
    "analysis.outcome([1, 2], [200] * 3, 500, .15)": "have shapes (2,), (3,), (), (); must broadcast",
    "analysis.outcome(5, 200, 500, .15, material='rock')": "material = rock: must be ice or silicate",
    "analysis.outcome(5, 200, 500, .15, grain_radius=0.1)": "grain_radius = 0.1: must be a number of 1e-09 to 0.001 [m]",
    "analysis.outcome(5, 200, 500, .15, columns='largest')": "columns = largest: must be a list of names",
    "analysis.outcome(5, 200, 500, .15, columns=['larest'])": "no column larest (did you mean largest?)",
    "analysis.outcome(5, 200, 500, .15, maxwell='no')": "maxwell = no: must be True or False",
    "analysis.outcome(5, 200, 500, .15, file='nosuch')": "nosuch: No such file or directory; must be a table of outcomes",
    "analysis.open_run('')": "path = '': must be the path of a run folder",
    "analysis.open_run(run)": "path = a RunFolder: must be the path of a run folder",
    "run.parameters.velocity": 'velocity is no attribute; must be read as ["velocity"]',
    "run.parameters['velocty']": "no velocty (did you mean velocity?)",
    "run.history['kinetc']": "no kinetc (did you mean kinetic?)",
    "run.last.positions": "no positions (did you mean position?)",
    "run.states[100]": "no state 100: must be -12 to 11",
    "run.states['last']": "state last: must be a whole number, or a slice",
    "run.states.nearest('end')": "time = end: must be a finite number",
    "run.states.arrays(12, ['time'])": "no state 12: must be -12 to 11",
    "analysis.table(found)": "runs = a DataFrame: must be a path, a pattern,",
    "analysis.table({'a': 1})": "runs = {'a': 1}: must be a path, a pattern,",
    "analysis.table('')": "runs = '': must be a path, a pattern,",
    "analysis.table(run, structure='no')": "structure = no: must be True or False",
    "analysis.plot('stiking', found)": "no stiking (did you mean sticking?)",
    "analysis.plot('sticking', found, x='velocty')": "no velocty (did you mean velocity?)",
    "analysis.plot('largest', found, x='outcome')": "outcome: holds words, or nothing; must be a column of numbers",
    "analysis.plot('sticking', found, by='velocty')": "no velocty (did you mean velocity?)",
    "analysis.plot('sticking', found, where={'velocity': 'fast'})": "where velocity = fast: must be a number",
    "analysis.plot('sticking', found, where={'velocity': 1000})": "where velocity = 1000: no run is left; must be one of 1.0",
    "analysis.plot('sticking', found, logarithmic='z')": "logarithmic = z: must be x or y or xy or ''",
    "analysis.plot('sticking', found.drop(columns='ended'))": "lacks ended; must be as analysis.table() gives it",
    "analysis.plot('energy', found.drop(columns='drag_at_end'))": "lacks drag_at_end; must be as analysis.table()",
    "analysis.exact_interval(5, 3)": "successes = 5: must be at most trials, 3",
    "analysis.exact_interval(1.5, 3)": "successes = 1.5: must be a whole number >= 0",
    "analysis.exact_interval(0, 0)": "trials = 0: must be a whole number >= 1",
    "analysis.exact_interval(1, 3, 95)": "confidence = 95: must be a number between 0 and 1",
    "analysis.fragments(P, R, [[0, 2]])": "contact_pairs = 2: must be whole numbers >= 0 and < 2 (M,2)",
    "analysis.fragments(P, [1e-7], C)": "radius: has shape (1,); must be numbers > 0 (N,), N = 2",
    "analysis.fragments(P, [-1e-7, 1e-7], C)": "radius = -1e-07: must be numbers > 0 (N,), N = 2",
    "analysis.fragments([], [], [])": "position: has shape (0,); must be finite numbers (N,3), N >= 1",
    "analysis.fragments(P, R, C, aggregate=[0])": "aggregate: has shape (1,); must be whole numbers >= 0 (N,), N = 2",
    "analysis.fragment_labels(5, [[0, 1, 2], [1, 2, 3]])": "contact_pairs: has shape (2, 3); must be whole",
    "analysis.fragment_labels(5, [[0.5, 1]])": "contact_pairs = 0.5: must be whole numbers >= 0 and < 5 (M,2)",
    "analysis.fragment_labels(2.5, [])": "grains = 2.5: must be a whole number >= 0",
    "analysis.fragment_sizes([0.5])": "labels = 0.5: must be whole numbers >= 0 (N,)",
    "analysis.fragment_masses([0, 1], [1])": "mass: has shape (1,); must be numbers >= 0 (N,), N = 2",
    "analysis.growth_efficiency(30, 20, 0)": "projectile = 0: must be a number > 0",
    "analysis.cumulative_grains([5, NAN], [1])": "sizes = nan: must be numbers >= 0 (K,)",
    "analysis.cumulative_cross_section(5, [1])": "sizes: has shape (); must be numbers >= 0 (K,)",
    "analysis.correlation_dimension(P, [1e-7])": "radius: has shape (1,); must be numbers > 0 (N,), N = 2",
    "analysis.filling_factor(P, 1e-7)": "radius: has shape (); must be numbers > 0 (N,), N = 2",
    "analysis.gyration_radius([[NAN, 0, 0]])": "position = nan: must be finite numbers (N,3)",
    "analysis.gyration_radius([1, 2, 3])": "position: has shape (3,); must be finite numbers (N,3)",
    "analysis.grains_within(P, [-1])": "distance = -1: must be a number >= 0",
    "analysis.grains_within(P, [1e-7], cell_size=[1, 1])": "cell_size: has shape (2,); must be numbers > 0 (3)",
    "analysis.grains_within(P, [1e-7], origins=0)": "origins = 0: must be a whole number >= 1",
    "analysis.mean_coordination(0, C)": "grains = 0: must be a whole number >= 1",
    "analysis.mean_coordination(2, [0, 1, 2])": "contact_pairs: has shape (3,); must be whole numbers >= 0 (M,2)",
    "analysis.inner_coordination(P, C, [0, 0], 1)": "centre: has shape (2,); must be finite numbers (3 or N,3), N = 2",
    "analysis.inner_coordination(P, C, [0, 0, 0], -1)": "reach = -1: must be a number >= 0",
    "analysis.compression_length([-1, 1, NAN], 1)": "x = nan: must be finite numbers (K,)",
    "analysis.mutual_velocity([-1, 1], [1])": "x_velocity: has shape (1,); must be finite numbers (K,), K = 2",
    "analysis.maximum_compression([2, 1, 0], [0, 1, 0], [1, 0, -1])": "time: falls or stays after sample 0; must rise",
    "analysis.total_energy({})": "history: lacks 'kinetic'; must have kinetic, normal, ",
    "analysis.closure({**history, 'drag': history['drag'][:3]})": "history['drag']: has shape (3,); must be numbers or NaN",
    "analysis.fractions_at(history, 1)": "time = 1: must be within the record, 0 to ",
}  # fmt: skip
WRONG = (None, "x", b"x", NAN, INF, -1, -0.5, True, 1j, [], [None], [[1], [2, 3]], {}, object(), np.zeros((2, 2, 2)))


@pytest.fixture(scope="module")
def given(cluster_folder):
    """The names that MISTAKES use."""
    run = analysis.open_run(cluster_folder)
    names = {"analysis": analysis, "run": run, "history": dict(run.history), "found": analysis.table(run)}
    return names | {"P": [[0.0, 0, 0], [2e-7, 0, 0]], "R": [1e-7, 1e-7], "C": [[0, 1]], "NAN": NAN}


@pytest.mark.parametrize("typed", MISTAKES)
def test_mistakes_get_one_line(given, typed):
    with pytest.raises(Exception) as wrong:
        eval(typed, given)
    said = str(wrong.value)
    ours = wrong.type.__module__.startswith("analysis.") or wrong.type is IndexError  # which a sequence must raise
    assert isinstance(wrong.value, KeyError) or "did you mean" not in said or "columns" in typed
    assert (ours or wrong.type is ValueError) and MISTAKES[typed] in said and "\n" not in said, said


def right_arguments(given, function):
    """Right ones of a public function, {name: value}."""
    run = given["run"]
    by_name = {
        **dict(
            position=given["P"], radius=given["R"], contact_pairs=given["C"], aggregate=[0, 1], cell_size=[1e-6] * 3
        ),
        **dict(distance=[1e-7], origins=1, centre=[0.0] * 3, reach=1.0),
        **dict(grains=2, labels=[0, 1], mass=[1.0, 2.0], sizes=[5, 1], numbers=[1, 2]),
        **dict(largest=3, target=2, projectile=1, successes=1, trials=2, confidence=0.9),
        **dict(x=[-1.0, 1.0], x_velocity=[1.0, -1.0], aggregate_radius=2.0),
        **dict(time=[0.0, 1.0, 2.0], d=[0.0, 1.0, 0.0], v=[2.0, 0.0, -2.0], history=given["history"]),
        **dict(velocity=5, filling=0.1, material="ice", grain_radius=1e-7, columns=["largest"]),
        **dict(path=run.path, run=run, runs=run, structure=True, what="largest", by="", where={}, logarithmic=""),
    }
    own = {analysis.fractions_at: {"time": 0.0}, analysis.outcome: {"structure": "grown"}}
    own |= {analysis.plot: {"runs": given["found"], "x": "velocity"}}
    right = {**by_name, **own.get(function, {})}
    return {name: right[name] for name in signature(function).parameters if name in right}


FUNCTIONS = [name for name in analysis.__all__ if not isinstance(getattr(analysis, name), type)]


@pytest.mark.parametrize("name", FUNCTIONS)
def test_nothing_wrong_comes_from_the_depths(given, name):
    """Each argument replaced by each of WRONG: what isn't taken is refused by us, in one line that names the argument."""
    function = getattr(analysis, name)
    right = right_arguments(given, function)
    function(**right)
    refused = 0
    for argument in right:
        for value in WRONG:
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                try:
                    function(**{**right, argument: value})
                except Exception as error:
                    said, kind = str(error), type(error)
                    ours = kind.__module__.startswith("analysis.") and "\n" not in said
                    named = argument in said or str(value) in said or "no runs given" in said
                    assert ours and named, (argument, value, error)
                    refused += 1
    assert refused >= 5
