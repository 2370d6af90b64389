"""Tables, estimates and texts of a study, without running one."""

import io
import os

import pytest
from running import TOP

from yade_scripts import agreement, elastoplastic_tables, packings, study_cost, study_rows, study_view, table
from yade_scripts.materials import MATERIALS, equilibrium_overlap
from yade_scripts.parameters import parse
from yade_scripts.study_screen import Screen

STUDIES = os.path.join(TOP, "yade_scripts", "studies")
ICE = {"ice": 1.936e-10}


def test_tables_are_read_as_yade_reads_them(yade, tmp_path):
    (tmp_path / "marked.table").write_text(
        "# a comment\n\nradius! velocity material !THREADS # more\n" "4 10 'ice' 2\n\n= = * 1 # same\n5 = 'ice' =\n"
    )
    paths = [str(tmp_path / "marked.table")] + [os.path.join(STUDIES, name) for name in sorted(os.listdir(STUDIES))]
    found = yade(
        """
from yade.utils import TableParamReader
result.update({path: {str(line): row for line, row in TableParamReader(path).paramDict().items()} for path in parameters["paths"]})
""",
        {"paths": paths},
    )
    for path in paths:
        ours = {str(row.line): {"description": row.description, **row.cells} for row in table.read(path)}
        theirs = {line: {name: cell for name, cell in row.items() if cell != "*"} for line, row in found[path].items()}
        assert ours == theirs, path


def test_a_table_that_was_written_is_read_back(tmp_path):
    rows = [{"description": "a", "radius": 4, "!THREADS": 1}, {"description": "b", "velocity": "10**0.5"}]
    table.write(tmp_path / "rows.table", rows)
    back = table.read(tmp_path / "rows.table")
    assert [row.description for row in back] == ["a", "b"]
    assert [row.cells for row in back] == [{"radius": "4", "!THREADS": "1"}, {"velocity": "10**0.5"}]


def test_committed_tables_are_what_the_generator_writes(tmp_path):
    elastoplastic_tables.write_tables(tmp_path)
    assert sorted(os.listdir(tmp_path)) == ["elastoplastic-desk.table", "elastoplastic-full.table"]
    for name in os.listdir(tmp_path):
        with open(os.path.join(STUDIES, name)) as file:
            assert file.read() == (tmp_path / name).read_text(), f"{name}: run yade_scripts/elastoplastic_tables.py"


def test_the_tables_hold_the_papers_runs():
    """A24 section 3 and the captions of Figs 5 to 9; desk has some of each size, every velocity, both fillings."""
    full, desk = (study_rows.read(os.path.join(STUDIES, f"elastoplastic-{size}.table")) for size in ("full", "desk"))
    scenes = {(row.values["filling"], row.values["radius"], row.values["velocity"]) for row in full}
    assert len(scenes) == 2 * (5 + 2 * 7) and len(full) == 10 * len(scenes)
    assert {row.values["stepFraction"] for row in full} == {0.1} and not any(row.error for row in full + desk)
    assert {row.values["velocity"] for row in desk} == {10 ** (0.1 * i) for i in range(8)}
    assert {(row.values["filling"], row.values["radius"]) for row in desk} == {
        (filling, radius) for filling in (0.3, 0.4) for radius in (40, 50, 60, 80)
    }
    one = next(row for row in desk if row.name == "f0.4-R40-i5-s1")
    assert one.values["out"] == "runs/elastoplastic/f0.4-R40-i5-s1"
    assert one.values["velocity"] == 10**0.5 and one.values["seed"] == 1


def test_contact_updates_are_those_of_a_packing():
    """Contacts counted in a packing of A24's at R = 30, whose surface takes some away."""
    values = parse({"radius": 30, "filling": 0.4})
    overlap = equilibrium_overlap(MATERIALS["ice"])
    counted = len(packings.contacts(packings.cpe(0.4, 30e-7, 1e-7, overlap, seed=1)))
    steps = 64.6 * 30 / 0.1
    assert 0.9 < 2 * counted * steps / study_cost.Cost(ICE).contact_updates(values) < 1
    given = parse({"radius": 30, "filling": 0.4, "duration": 64.6 * 30 * ICE["ice"]})
    assert study_cost.Cost(ICE).contact_updates(given) == pytest.approx(study_cost.Cost(ICE).contact_updates(values))


def test_estimates_follow_ended_runs_and_otherwise_the_measured_piece():
    small, large = parse({"radius": 40}), parse({"radius": 80})
    fast = parse({"radius": 40, "stepFraction": 0.2})
    assert study_cost.Cost(ICE).seconds(small) is None
    cost = study_cost.Cost(ICE, ended=[(small, 80.0), (small, 100.0), (small, 300.0), (parse({"radius": 10}), 0.5)])
    assert cost.seconds(small) == pytest.approx(100)  # a median; what took half a second says nothing
    assert cost.seconds(fast) == pytest.approx(50)
    assert cost.seconds(large) == pytest.approx(1600 * 8**study_cost.CACHE_EXPONENT, rel=0.01)
    assert cost.seconds(parse({"radius": 40, "engine": "functors"})) is None
    measured = study_cost.Cost(ICE, measured=(small, 30e6, 2.0))
    assert measured.seconds(small) == pytest.approx(measured.contact_updates(small) / 30e6 + 2)


@pytest.mark.parametrize(
    "running, waiting, at_once, expected",
    [([], [], 2, 0), ([], [5, 1, 1], 2, 5), ([4], [1, 1, 1], 2, 4), ([4, 4], [1], 2, 5), ([], [3, 3], 1, 6)],
)
def test_makespan(running, waiting, at_once, expected):
    assert study_cost.makespan(running, waiting, at_once) == expected


def test_difference_names_the_first_parameter_that_disagrees():
    values = parse({"radius": 40, "velocity": "10**(0.1*5)"})
    run = {
        "parameters": dict(values, duration=40 * 64.6 * 2e-10, threads=2, out="elsewhere"),
        "derived": {"timeUnit": 2e-10},
    }
    assert agreement.difference(values, run) is None
    assert agreement.difference(dict(values, velocity=3.0), run) == "velocity = 3.16227766017, not 3"
    assert agreement.difference(dict(values, duration=1e-9), run) == "duration = 5.168e-07, not 1e-09"
    del run["parameters"]["impact"]  # written before there was such a parameter
    assert agreement.difference(values, run) is None
    assert agreement.difference(dict(values, impact=0.5), run) == "impact = 0, not 0.5"


class Terminal(io.StringIO):
    def isatty(self):
        return True


def test_a_live_table_is_drawn_over_itself_and_only_on_a_terminal():
    rows = [study_rows.StudyRow(name, {}, parse({"radius": 40})) for name in "abc"]
    states = [
        study_rows.State(study_rows.RUNNING, 0.43, 60, 25.0),
        study_rows.State(study_rows.DONE, 1.0, 44.0),
        study_rows.State(study_rows.FAILED, note="it broke"),
    ]
    text = study_view.live_table("tiny", rows, states, study_cost.Cost(ICE), 2)
    assert text.splitlines()[0] == "tiny: 1 done, 1 running, 0 waiting, 1 failed; 0:25 left"
    assert "[########............]  43.0 %     0:25 left" in text and "it broke" in text
    terminal, file = Terminal(), io.StringIO()
    for stream in (terminal, file):
        screen = Screen(stream)
        screen.draw(text)
        screen.draw(text)
        screen.close()
    assert terminal.getvalue().count("\033[3A\033[J") == 2 and terminal.getvalue().endswith("\033[J")
    assert file.getvalue() == ""
