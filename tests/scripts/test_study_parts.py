"""Tables, estimates and texts of a study, without running one."""

import io
import os
import sys

import pytest
from running import TOP

from yade_scripts import packings
from yade_scripts.experiments.collision import KIND
from yade_scripts.materials import MATERIALS, equilibrium_overlap, pair_constants
from yade_scripts.run import agreement, table
from yade_scripts.runner import cost, rows, view
from yade_scripts.runner.screen import Screen
from yade_scripts.studies import elastoplastic, table_script, viscous

STUDIES = os.path.join(TOP, "yade_scripts", "studies")
TABLES = sorted(name for name in os.listdir(STUDIES) if name.endswith(".table"))
TIME_UNIT = pair_constants(MATERIALS["ice"])["timeUnit"]
parse = KIND.parse


def row(**cells):
    return rows.StudyRow("row", cells, "collide.py", KIND, parse(cells))


def test_tables_are_read_as_yade_reads_them(yade, tmp_path):
    (tmp_path / "marked.table").write_text(
        "# a comment\n\nradius! velocity material !THREADS # more\n" "4 10 'ice' 2\n\n= = * 1 # same\n5 = 'ice' =\n"
    )
    paths = [str(tmp_path / "marked.table")] + [os.path.join(STUDIES, name) for name in TABLES]
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
    written = [{"description": "a", "radius": 4, "!THREADS": 1}, {"description": "b", "velocity": "10**0.5"}]
    table.write(tmp_path / "rows.table", written, "what these are\nand their units")
    assert (tmp_path / "rows.table").read_text().startswith("# what these are\n# and their units\ndescription")
    back = table.read(tmp_path / "rows.table")
    assert [row.description for row in back] == ["a", "b"]
    assert [row.cells for row in back] == [{"radius": "4", "!THREADS": "1"}, {"velocity": "10**0.5"}]


def test_a_byte_order_mark_is_no_part_of_the_first_name(tmp_path):
    (tmp_path / "rows.table").write_text("radius velocity\n4 10\n", encoding="utf-8-sig")
    assert [found.cells for found in table.read(tmp_path / "rows.table")] == [{"radius": "4", "velocity": "10"}]


@pytest.mark.parametrize("names", ["radius velocity radius", "radius! velocity radius"])
def test_a_column_that_is_there_twice_is_refused(tmp_path, names):
    (tmp_path / "rows.table").write_text(f"{names}\n4 10 5\n")
    with pytest.raises(table.TableError, match="rows.table: has the column radius 2 times; must be once"):
        table.read(tmp_path / "rows.table")


def test_names_of_any_length_are_names_of_files(tmp_path):
    """Two descriptions of 400 characters that differ in the last one."""
    for letter in ("x", "\u00e9"):
        (tmp_path / "rows.table").write_text(
            "description radius velocity\n" + "".join(f"{letter * 400}{end} 4 10\n" for end in "ab")
        )
        found = rows.read(tmp_path / "rows.table")
        assert len({found_row.name for found_row in found}) == len({found_row.out for found_row in found}) == 2
        for found_row in found:
            assert not found_row.error
            (tmp_path / f"{found_row.name}.log").write_text("")
            os.makedirs(tmp_path / found_row.out)
    assert rows.file_name("f0.4-R40,i=5 s1") == "f0.4-R40,i=5_s1"


def test_an_ended_run_without_a_readable_record_is_not_done(tmp_path):
    given = row(out=str(tmp_path / "run"))
    (tmp_path / "run").mkdir()
    (tmp_path / "run" / "ended").write_text("")
    for text in (None, "", "{", "[" * 100_000):
        if text is not None:
            (tmp_path / "run" / "run.json").write_text(text)
        found = rows.state(given, str(tmp_path / "log"))
        assert found.kind == rows.FAILED and "without a readable run.json" in found.note


def test_pipes_in_a_run_folder_are_not_waited_for(tmp_path):
    given = row(out=str(tmp_path / "run"))
    (tmp_path / "run" / "checkpoint").mkdir(parents=True)
    os.mkfifo(tmp_path / "run" / "run.json")
    os.mkfifo(tmp_path / "run" / "checkpoint" / "recorder.npz")
    assert rows.state(given, str(tmp_path / "log")).kind == rows.WAITING
    os.unlink(tmp_path / "run" / "run.json")
    (tmp_path / "run" / "run.json").write_text('{"outcome": "running", "derived": {"steps": 1, "timeStep": 1}}')
    assert rows.state(given, str(tmp_path / "log")).kind == rows.WAITING


@pytest.mark.parametrize(
    "study, sizes",
    [(elastoplastic, ("desk", "first", "full")), (viscous, ("desk", "full", "own", "prediction"))],
    ids=["elastoplastic", "viscous"],
)
def test_committed_tables_are_what_the_generator_writes(tmp_path, study, sizes):
    study.write_tables(tmp_path)
    own = study.__name__.rpartition(".")[2]
    assert sorted(os.listdir(tmp_path)) == [f"{own}-{size}.table" for size in sizes]
    for name in os.listdir(tmp_path):
        with open(os.path.join(STUDIES, name)) as file:
            assert file.read() == (tmp_path / name).read_text(), f"{name}: run yade_scripts/studies/{own}.py"


def test_scripts_that_write_tables_say_what_they_do_and_refuse_arguments(tmp_path, monkeypatch, capsys):
    """Asked for help, or given what they don't take, they write nothing."""
    calls = []
    for arguments, written in (("--help", 0), ("desk", 0), (None, 1)):
        monkeypatch.setattr(sys, "argv", ["study.py"] + ([arguments] if arguments else []))
        if arguments == "desk":
            with pytest.raises(SystemExit) as ended:
                table_script.main(calls.append, tmp_path, "Writes tables.")
            assert ended.value.code == 2 and capsys.readouterr().err == "desk: takes no arguments but --help\n"
        else:
            table_script.main(calls.append, tmp_path, "Writes tables.")
        assert len(calls) == written
        assert capsys.readouterr().out == ("Writes tables.\n" if arguments == "--help" else "")


def test_the_viscous_tables_hold_the_papers_runs():
    """A22 section 2.4: 13 B_off^2, 8 velocities, 4 T_vis; desk has that grid with several seeds of smaller aggregates."""
    full, desk = (rows.read(os.path.join(STUDIES, f"viscous-{size}.table")) for size in ("full", "desk"))
    assert not any(row.error for row in full + desk)
    full, desk = ([row.parameters for row in table_rows] for table_rows in (full, desk))
    scenes = {(round(p.impact**2 * 12, 9), p.velocity, p.viscoelasticTime) for p in full}
    assert len(full) == len(scenes) == 416 == 13 * 8 * 4
    assert {p.grains for p in full} == {50_000} and {p.stepFraction for p in full} == {0.1}
    assert {t for *_, t in scenes} == {0.0, 1e-12, 3e-12, 6e-12} and {b for b, *_ in scenes} == set(range(13))
    assert {v for _, v, _ in scenes} == {10 ** (0.1 * i) for i in range(13, 21)}
    for p in full + desk:
        assert p.packing == "bpca" and p.duration == 6.34e-6 and p.endWhenApart == 1
    of_size = lambda grains: [p for p in desk if p.grains == grains]
    assert {(p.viscoelasticTime, p.velocity) for p in of_size(50_000)} == {(t, 10 ** (0.1 * 17)) for t in (0.0, 6e-12)}
    assert {round(p.impact**2 * 12, 9) for p in of_size(50_000)} == {3}
    small = {(round(p.impact**2 * 12, 9), p.velocity, p.viscoelasticTime, p.seed) for p in of_size(500)}
    assert small == {(*scene, seed) for scene in scenes for seed in (1, 2, 3, 4)}
    # What was predicted before it ran is in no other table, and spans B_off at every velocity and T_vis.
    predicted = [row.parameters for row in rows.read(os.path.join(STUDIES, "viscous-prediction.table"))]
    assert not {p.out for p in predicted} & {p.out for p in full + desk}
    of_size = [p for p in predicted if p.grains == 10_000]
    assert {round(p.impact**2 * 12, 9) for p in of_size} == set(range(13)) and len(of_size) == 2 * 2 * 4 * 13
    # Every second offset stands before the others, which are the last block.
    odd = [round(p.impact**2 * 12) % 2 for p in of_size]
    assert odd == sorted(odd) and sum(odd) == 2 * 2 * 4 * 6 and len(predicted) == len(of_size) + 1


def test_the_tables_hold_the_papers_runs():
    """A24 section 3 and the captions of Figs 5 to 9; desk has some of each size, every velocity, both fillings."""
    full, desk = (rows.read(os.path.join(STUDIES, f"elastoplastic-{size}.table")) for size in ("full", "desk"))
    assert not any(row.error for row in full + desk)
    names = {row.name: row.parameters for row in desk}
    full, desk = ([row.parameters for row in table_rows] for table_rows in (full, desk))
    scenes = {(p.filling, p.radius, p.velocity) for p in full}
    assert len(scenes) == 2 * (5 + 2 * 7) and len(full) == 10 * len(scenes)
    assert {p.stepFraction for p in full} == {0.1}
    assert {p.velocity for p in desk} == {10 ** (0.1 * i) for i in range(8)}
    assert {(p.filling, p.radius) for p in desk} == {
        (filling, radius) for filling in (0.3, 0.4) for radius in (40, 50, 60, 80)
    }
    one = names["f0.4-R40-i5-s1"]
    assert one.out == "runs/elastoplastic/f0.4-R40-i5-s1"
    assert one.velocity == 10**0.5 and one.seed == 1


def test_the_tables_give_the_papers_duration():
    """12.5 ns per grain radius from the start, as older run folders of these rows have it; the slowest 1000 ns."""
    for size in ("full", "desk"):
        for found in (row.parameters for row in rows.read(os.path.join(STUDIES, f"elastoplastic-{size}.table"))):
            slow = size == "desk" and found.radius == 40 and found.velocity < 1.6
            expected = 1e-6 if slow else 64.6 * found.radius * TIME_UNIT
            assert found.duration == pytest.approx(expected, rel=1e-13)


def test_contact_updates_are_those_of_a_packing():
    """Contacts counted in a packing of A24's at R = 30, whose surface has fewer."""
    overlap = equilibrium_overlap(MATERIALS["ice"])
    counted = len(packings.contacts(packings.cpe(0.4, 30e-7, 1e-7, overlap, seed=1)))
    given = row(radius=30, filling=0.4, duration=64.6 * 30 * TIME_UNIT)
    assert 0.9 < 2 * counted * 64.6 * 30 / 0.1 / cost.contact_updates(given) < 1


@pytest.mark.parametrize("cells", [{"radius": 25, "impact": 0.5}, {"packing": "bcca", "grains": 300}], ids=str)
def test_the_default_duration_is_estimated_without_packings(cells):
    """Of ten seeds those that meet, on average, to a fifth."""
    from yade_scripts.experiments.collision import default_duration, place
    from yade_scripts.packings.approach import first_touch

    durations = []
    for seed in range(10):
        placed, pair, velocities = place(parse({**cells, "seed": seed}), equilibrium_overlap(MATERIALS["ice"]))
        touch = first_touch(*pair, velocities[1] - velocities[0])
        if touch is not None:
            durations.append(default_duration(placed.radius, TIME_UNIT, touch))
    assert len(durations) >= 8
    steps = sum(durations) / len(durations) / TIME_UNIT / 0.1
    assert row(**cells).estimate.steps == pytest.approx(steps, rel=0.2)


def test_estimates_follow_ended_runs_and_otherwise_the_measured_piece():
    of = lambda radius, **cells: row(radius=radius, duration=64.6 * radius * TIME_UNIT, **cells)
    small, large, fast = of(40), of(80), of(40, stepFraction=0.2)
    assert cost.Cost().seconds(small) is None
    known = cost.Cost(ended=[(small, 80.0), (small, 100.0), (small, 300.0), (of(10), 0.5)])
    assert known.seconds(small) == pytest.approx(100)  # a median; what took half a second says nothing
    assert known.seconds(fast) == pytest.approx(50)
    assert known.seconds(large) == pytest.approx(1600 * 8**cost.CACHE_EXPONENT, rel=0.01)
    assert known.seconds(of(40, engine="functors")) is None
    measured = cost.Cost(measured=(small, 30e6, 2.0))
    assert measured.seconds(small) == pytest.approx(cost.contact_updates(small) / 30e6 + 2)


@pytest.mark.parametrize(
    "running, waiting, at_once, expected",
    [([], [], 2, 0), ([], [5, 1, 1], 2, 5), ([4], [1, 1, 1], 2, 4), ([4, 4], [1], 2, 5), ([], [3, 3], 1, 6)],
)
def test_makespan(running, waiting, at_once, expected):
    assert cost.makespan(running, waiting, at_once) == expected


def test_difference_names_the_first_parameter_that_disagrees():
    wanted = parse({"radius": 40, "velocity": "10**(0.1*5)"})
    difference = lambda given, run: agreement.difference(KIND, given, run)
    run = {
        "format": 2,
        "kind": "collision",
        "parameters": {**wanted.as_dict(), "duration": 40 * 64.6 * 2e-10 + 3e-8, "threads": 2, "out": "elsewhere"},
        "derived": {"timeUnit": 2e-10, "firstTouch": 3e-8},
    }
    assert difference(wanted, run) is None
    assert difference(wanted.changed(velocity=3.0), run) == "velocity = 3.16227766017, not 3"
    assert difference(wanted.changed(duration=1e-9), run) == "duration = 5.468e-07, not 1e-09"
    assert difference(wanted.changed(young=6e9), run) == "young = 7000000000, not 6000000000"
    assert difference(wanted, {**run, "kind": "compression"}) == "kind = compression, not collision"
    del run["derived"]["firstTouch"]  # never met, with a duration that was given
    assert difference(wanted, run) == "duration = 5.468e-07, not the default"


def test_runs_of_format_1_agree_with_rows_that_give_no_duration():
    """Their default didn't count the time until the first touch; properties of the material stand under derived."""
    wanted = parse({"radius": 40})
    properties = ("grainRadius", "young", "poisson", "density", "surfaceEnergy", "criticalRolling")
    parameters = {**wanted.as_dict(), "duration": 40 * 64.6 * 2e-10}
    run = {
        "format": 1,
        "parameters": {name: value for name, value in parameters.items() if name not in (*properties, "impact")},
        "derived": {"timeUnit": 2e-10, **{name: getattr(wanted, name) for name in properties}},
    }
    assert agreement.difference(KIND, wanted, run) is None
    assert agreement.difference(KIND, wanted.changed(impact=0.5), run) == "impact = 0, not 0.5"
    assert agreement.difference(KIND, wanted.changed(poisson=0.3), run) == "poisson = 0.25, not 0.3"
    assert agreement.difference(KIND, wanted.changed(duration=1e-9), run) == "duration = 5.168e-07, not 1e-09"
    run["parameters"]["duration"] *= 1.1
    assert agreement.difference(KIND, wanted, run) == "duration = 5.6848e-07, not 5.168e-07"


def test_a_bcca_row_agrees_with_its_run_whatever_the_radius_became():
    wanted = parse({"packing": "bcca", "grains": 64})
    run = {"format": 1, "parameters": wanted.changed(radius=17.3, filling=0.0124, duration=64.6 * 17.3e-10).as_dict()}
    run["derived"] = {"timeUnit": 1e-10}
    assert agreement.difference(KIND, wanted, run) is None
    assert agreement.difference(KIND, wanted.changed(grains=65), run) == "grains = 64, not 65"


class Terminal(io.StringIO):
    def isatty(self):
        return True


def test_a_live_table_is_drawn_over_itself_and_only_on_a_terminal():
    three = [rows.StudyRow(name, {}, "collide.py", KIND, parse({"radius": 40})) for name in "abc"]
    states = [
        rows.State(rows.RUNNING, 0.43, 60, 25.0),
        rows.State(rows.DONE, 1.0, 44.0),
        rows.State(rows.FAILED, note="it broke"),
    ]
    text = view.live_table("tiny", three, states, cost.Cost(), 2)
    assert text.splitlines()[0] == "tiny: 1 done, 1 running, 0 waiting, 1 failed; 00:25 left"
    assert "[########............]  43.0 %    00:25 left" in text and "it broke" in text
    terminal, file = Terminal(), io.StringIO()
    for stream in (terminal, file):
        screen = Screen(stream)
        screen.draw(text)
        screen.draw(text)
        screen.close()
    assert terminal.getvalue().count("\033[3A\033[J") == 2 and terminal.getvalue().endswith("\033[J")
    assert file.getvalue() == ""


def test_the_step_of_every_row_is_stable(yade):
    """Rows of the study tables would start: what their runs refuse of grains, necks and steps before packings are made."""
    found = yade(
        """
from yade_scripts.experiments import collision, compression
from yade_scripts.parameters import ParameterError
from yade_scripts.run.scene import pair_constants
from yade_scripts.runner import rows
refused, seen = [], set()
for path in parameters["paths"]:
    for row in rows.read(path):
        p = row.parameters
        alike = repr(p.changed(seed=1, out="", **({"file": None, "projectileFile": None} if hasattr(p, "file") else {})))
        if alike in seen:
            continue
        seen.add(alike)
        experiment = collision if row.kind is collision.KIND else compression
        own = {"neck": p.neck} if experiment is collision else {"linearDamping": p.linearDamping}
        try:
            experiment.complete(p, pair_constants(p, **own), 1)
        except ParameterError as error:
            refused.append(f"{row.name}: {error}")
result.update(refused=refused, seen=len(seen))
""",
        {"paths": [os.path.join(STUDIES, name) for name in TABLES]},
    )
    assert found["refused"] == [] and found["seen"] > 300
