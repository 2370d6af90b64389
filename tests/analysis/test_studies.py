"""A study is a folder: one made on the spot is found, run and drawn, with nothing else touched."""

import json
import sys

import pytest
from made_collisions import made_run

from analysis import studies
from analysis.__main__ import main

STUDY = '''
"""Sticking against velocity."""

from analysis.measures.of_run import met, outcome_of_run
from analysis.report.section import Column as Shown
from analysis.report.section import Section
from analysis.runs.collect import Scene
from analysis.runs.table import Column
from analysis.studies.definition import NotMeasured, Study


def measure(run):
    if not met(run):
        raise NotMeasured(f"{run.path}: never met")
    parameters = run.parameters
    return {"velocity": parameters["velocity"], "seed": parameters["seed"], "outcome": outcome_of_run(run).kind}


def sections(table):
    sticking = table.groupby("velocity").outcome.apply(lambda kinds: float((kinds == "sticking").mean()))
    columns = (Shown("v [m/s]", lambda r: f"{r['velocity']:g}"), Shown("sticking", lambda r: f"{r['sticking']:.2f}"))
    yield Section("sticking", columns, tuple({"velocity": v, "sticking": s} for v, s in sticking.items()))


STUDY = Study(
    title="Sticking against velocity",
    scene=Scene("the tiny scene", {"packing": "cpe"}, ("velocity", "seed")),
    columns=(
        Column("velocity", "m/s", "collision velocity"),
        Column("seed", "", "random seed", kind="i"),
        Column("outcome", "", "how it ends", kind="O"),
    ),
    measure=measure,
    results=lambda table: table,
    sections=sections,
)
'''

FIGURES = """
from analysis.figures.panels import panels
from analysis.studies.definition import StudyFigure


def sticking(table):
    figure, axes = panels(1, 1)
    axes[0, 0].plot(table.velocity, table.outcome == "sticking", "o")
    return figure


FIGURES = (StudyFigure("sticking", "Who sticks.", sticking), StudyFigure("none", "Nothing.", lambda table: None))
"""


@pytest.fixture
def tiny(tmp_path, monkeypatch):
    """A study "tiny" in a folder of its own, beside those of the package."""
    folder = tmp_path / "studies" / "tiny"
    folder.mkdir(parents=True)
    (folder / "__init__.py").write_text("")
    (folder / "study.py").write_text(STUDY)
    (folder / "figures.py").write_text(FIGURES)
    monkeypatch.setattr(studies, "__path__", [*studies.__path__, str(folder.parent)])
    for seed, sticks in ((1, True), (2, False), (3, True), (4, True)):
        made_run(tmp_path / "runs" / f"s{seed}", 40.0, 3.0, seed, 0.0, sticks=sticks)
    made_run(tmp_path / "runs" / "late", 40.0, 3.0, 5, 0.0, ended=False)
    yield tmp_path
    for name in [name for name in sys.modules if name.startswith("analysis.studies.tiny")]:
        del sys.modules[name]


def test_studies_are_listed(tiny, capsys):
    assert main(["study"]) == 0
    listed = dict(line.split(maxsplit=1) for line in capsys.readouterr().out.splitlines())
    assert listed["tiny"] == "Sticking against velocity" and "elastoplastic" in listed


def test_a_study_of_its_own_folder_is_run(tiny, capsys):
    assert main(["study", "tiny", str(tiny / "runs"), "--figures", str(tiny / "out"), "--json"]) == 0
    said = capsys.readouterr()
    answer = json.loads(said.out)
    assert answer["sections"] == [{"heading": "sticking", "rows": [{"velocity": 3.0, "sticking": 0.75}]}]
    assert answer["provenance"]["runs"] == 4 and "late: has not ended, left out" in said.err
    names = {"comparison.md", "comparison.json", "runs.csv", "sticking.png", "sticking.pdf"}
    assert {file.name for file in (tiny / "out").iterdir()} == names
    page = (tiny / "out" / "comparison.md").read_text()
    assert page.startswith("# Sticking against velocity\n") and "| 3 | 0.75 |" in page and "(sticking.png)" in page


def test_its_table_is_read_again(tiny, capsys):
    main(["study", "tiny", str(tiny / "runs"), "--format", "csv"])
    (tiny / "runs.csv").write_text(capsys.readouterr().out)
    assert main(["study", "tiny", str(tiny / "runs.csv")]) == 0
    text = capsys.readouterr().out
    assert "0.75" in text and text.startswith("4 runs")
    assert main(["study", "elastoplastic", str(tiny / "runs.csv")]) == 2
    assert capsys.readouterr().err.count("\n") == 1


def test_a_run_in_which_nothing_is_measured_is_left_out(tiny, capsys):
    assert main(["study", "tiny", str(tiny / "runs" / "late")]) == 2
    assert capsys.readouterr().err.splitlines()[-1] == "analysis: no run of the tiny scene to analyse"


def test_an_unknown_study_names_those_there_are(tiny, capsys):
    with pytest.raises(SystemExit) as stop:
        main(["study", "none", "runs"])
    assert stop.value.code == 2 and "elastoplastic" in capsys.readouterr().err
