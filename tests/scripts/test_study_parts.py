"""Tables of a study, the times that it expects, and which run is a row's, without running one."""

import os

import pytest

from analysis.runs.status import DONE, RUNNING, WAITING, State
from yade_scripts import packings
from yade_scripts.experiments.collision import KIND
from yade_scripts.packings.packing import sum_of_file
from yade_scripts.run import checkpoint, table
from yade_scripts.runner import rows
from yade_scripts.runner.study import Study

parse = KIND.parse


def row(**cells):
    return rows.StudyRow("row", cells, "collide.py", KIND, parse(cells))


def test_a_table_that_was_written_is_read_back(tmp_path):
    """With a spreadsheet's byte order mark too."""
    path = tmp_path / "rows.table"
    written = [{"description": "a", "radius": 4, "!THREADS": 1}, {"description": "b", "velocity": "10**0.5"}]
    table.write(path, written, "what these are\nand their units")
    text = path.read_text()
    for encoding in ("utf-8", "utf-8-sig"):
        path.write_text(text, encoding=encoding)
        back = table.read(path)
        assert [row.description for row in back] == ["a", "b"]
        assert [row.cells for row in back] == [{"radius": "4", "!THREADS": "1"}, {"velocity": "10**0.5"}]


def study_of(*given):
    """A Study of these rows with two threads at once."""
    study = Study.__new__(Study)
    study.name, study.rows, study.jobs = "tiny", list(given), 2
    return study


def test_expected_times_follow_the_rows_that_have_ended():
    """Steps times contacts over the speed; threads at once share the work."""
    small, large = row(radius=40), row(radius=80)
    seconds, estimate = small.expected_seconds, KIND.estimate(small.parameters)
    assert seconds == pytest.approx(estimate.steps * (estimate.contacts + 150) / 80e6)
    assert 14 < large.expected_seconds / seconds < 17
    waiting, done = State(WAITING), State(DONE, 1.0, 2 * seconds)
    assert study_of(small, small).time_left([waiting] * 2) == pytest.approx(seconds)
    assert study_of(small, small, small).time_left([waiting] * 3) == pytest.approx(1.5 * seconds)
    assert study_of(small, large).time_left([done, waiting]) == pytest.approx(2 * large.expected_seconds)
    assert study_of(small, small).time_left([State(RUNNING, 0.5, left=7.0), done]) == 7.0
    of_own_kind = rows.StudyRow("own", {}, "own.py", None, parse({}))
    assert study_of(small, of_own_kind).time_left([waiting, waiting]) is None


def differences(wanted, run):
    """Of the wanted parameters, and of those with each of some changed, from a run."""
    return lambda **changed: checkpoint.difference(KIND, wanted.changed(**changed), run)


def test_difference_names_the_first_parameter_that_disagrees():
    """A run that went on for longer agrees."""
    wanted = parse({"radius": 40, "velocity": "10**(0.1*5)"})
    given = {**wanted.as_dict(), "duration": 40 * 64.6 * 2e-10 + 3e-8, "threads": 2, "out": "elsewhere"}
    run = {"format": 2, "kind": "collision", "parameters": given, "derived": {"timeUnit": 2e-10, "firstTouch": 3e-8}}
    difference = differences(wanted, run)
    assert difference() is None and difference(duration=1e-9) is None
    assert difference(velocity=3.0) == "velocity = 3.16227766017, not 3"
    assert difference(duration=1e-6) == "duration = 5.468e-07, not 1e-06"
    assert differences(wanted, {**run, "kind": "compression"})() == "kind = compression, not collision"


def test_runs_older_than_a_parameter_had_what_its_column_says():
    """Aggregates used to come as they were made; those of a lattice are at rest."""
    for packing, at_rest in (("bcca", 0), ("bcca", 1), ("cpe", 0)):
        wanted = parse({"packing": packing, "grains": 20, "duration": 1e-9, "atRest": at_rest})
        given = {name: value for name, value in wanted.as_dict().items() if name != "atRest"}
        difference = differences(wanted, {"format": 5, "parameters": given, "derived": {}})()
        assert difference == ("atRest = 0, not 1" if at_rest else None)


def test_a_packing_file_that_has_changed_since_makes_another_run(tmp_path):
    file = str(tmp_path / "a.npz")
    for seed in (1, 1, 2):
        packings.save(file, packings.bcca(20, 1e-7, 1e-9, seed))
        derived = {"targetPacking": {"sha256": sum_of_file(file)}} if seed == 1 else derived
        wanted = parse({"packing": "file", "file": file, "duration": 1e-9})
        difference = differences(wanted, {"format": 3, "parameters": wanted.as_dict(), "derived": derived})()
        assert difference == (None if seed == 1 else f"file = {file}, not {file} as it is now")
    os.remove(file)
    assert differences(wanted, {"format": 3, "parameters": wanted.as_dict(), "derived": derived})() is None


def test_runs_of_format_1_agree_with_rows_that_give_no_duration():
    """Their default didn't count the time until the first touch; properties of the material stand under derived."""
    wanted = parse({"radius": 40})
    properties = ("grainRadius", "young", "poisson", "density", "surfaceEnergy", "criticalRolling")
    given = {name: value for name, value in wanted.as_dict().items() if name not in (*properties, "impact")}
    given["duration"] = 40 * 64.6 * 2e-10
    derived = {"timeUnit": 2e-10, **{name: getattr(wanted, name) for name in properties}}
    difference = differences(wanted, {"format": 1, "parameters": given, "derived": derived})
    assert difference() is None
    assert difference(poisson=0.3) == "poisson = 0.25, not 0.3"
