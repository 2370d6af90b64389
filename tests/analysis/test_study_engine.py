"""Tests of what every study does: the documented study of an own question, from run folders to pages, tables and figures."""

import base64
import io
import json
import re
import xml.etree.ElementTree as xml
from pathlib import Path

import numpy as np
import pandas
import pytest
from made_collisions import made_run
from PIL import Image
from study_answers import answered, rows
from written_runs import two_pairs

from analysis.__main__ import main
from analysis.report import pdf
from analysis.runs.folder import open_run
from analysis.studies import documents, find
from analysis.studies.analyse import analyse
from analysis.studies.collisions import outcome_quantities
from analysis.studies.page import screen
from analysis.studies.paper import read_paper
from analysis.studies.runs import Runs
from analysis.studies.snapshot_figure import SnapshotFigure, read_snapshots, write_snapshots

TOP = Path(__file__).resolve().parents[2]


def elements(text):
    """Those of a page, whose tags must all be closed but for the ones that hold nothing."""
    return xml.fromstring(re.sub(r"<(meta|img|br)([^>]*?)/?>", r"<\1\2/>", text))


def study(own, *arguments):
    """Exit status of the study of STUDIES.md, of these runs and with these options."""
    return main(["study", str(own / "sticking.py"), *map(str, arguments)])


def run(own, *options):
    return study(own, own / "runs", *options)


def test_the_documented_study_runs(own, capsys):
    assert run(own, "--figures", own / "out", "--json") == 0
    said = capsys.readouterr()
    answer = json.loads(said.out)
    sticking = {row["velocity"]: row for row in answer["quantities"]["sticking"]["rows"]}
    assert (sticking[3.0]["value"], sticking[3.0]["pairs"]) == (0.75, 4) and sticking[40.0]["value"] == 0.0
    assert sticking[40.0]["high"] > 0.9  # undecided: either way
    assert answer["provenance"]["runs"] == 5 and "late: has not ended, left out" in said.err
    names = {"README.md", "details.md", "comparison.json", "runs.csv", "sticking.png", "sticking.pdf"}
    assert {file.name for file in (own / "out").iterdir()} == names
    page, details = ((own / "out" / name).read_text() for name in ("README.md", "details.md"))
    assert "Undecided: 2 of 5 runs" in page and "3 of 4" in details and "(sticking.png)" in details


def test_a_paper_beside_ones_own_file_is_read(own, capsys):
    claim = "[[claim]]\nquantity = 'sticking'\nlabel = 'how many'\nprinted = ''\nsource = ''\nvalue = 0.75\nwhere = { velocity = 3.0 }\n"
    (own / "paper.toml").write_text(claim)
    assert run(own, "--json") == 0
    (judged,) = json.loads(capsys.readouterr().out)["claims"]
    assert judged["label"] == "how many" and judged["ours"]["value"] == 0.75
    (own / "paper.toml").write_text(claim.replace("velocity", "speed"))
    assert run(own) == 2
    says = "how many: where: sticking: no level speed; must be one of grains, velocity"
    assert capsys.readouterr().err.splitlines()[-1] == f"analysis: {own / 'paper.toml'}: {says}"


@pytest.mark.parametrize(
    "other, varied, status",
    [
        (dict(material="silicate"), "", 2),
        (dict(material="silicate"), '"material", ', 0),
        (dict(grains=None), "", 0),  # as the run derived it
        (dict(duration=9.0, endWhenApart=0), "", 0),
    ],
)
def test_runs_that_differ_are_refused_unless_the_study_names_it(own, capsys, other, varied, status):
    """The fixture's runs, as those of earlier versions, lack some parameters."""
    code = (own / "sticking.py").read_text().replace('varied=("', f'varied=({varied}"')
    (own / "sticking.py").write_text(code)
    for seed, parameters in ((6, other), (7, {})):
        usual = {"material": "ice", "duration": 1.0, "endWhenApart": 1}
        two_pairs(own / "runs" / f"s{seed}", 3.0, seed, derived={"grains": 2}, **{**usual, **parameters})
    if status:
        assert run(own) == status
        assert capsys.readouterr().err.splitlines()[-1] == (
            "analysis: the runs differ in material too: name them in varied, or give collision_study() one value of each "
            "(material is ice, silicate)"
        )
    else:
        found, _, _ = answered(capsys, own / "sticking.py", own / "runs")
        assert [row["pairs"] for row in rows(found["sticking"], velocity=3.0)] == [6]


@pytest.mark.parametrize(
    "old, new, says",
    [
        ('varied=("', 'pakcing="bpca", varied=("', "pakcing: no run has this parameter (did you mean packing?)"),
        ('"sticking", x', '"stiking", x', "KeyError: no quantity stiking (did you mean sticking?)"),
        ('x="velocity"', 'x="speed"', "Level speed not found; must be as analysis/STUDIES.md says"),
    ],
)
def test_wrong_names_in_ones_own_file_get_one_line(own, capsys, old, new, says):
    code = (own / "sticking.py").read_text()
    assert old in code
    (own / "sticking.py").write_text(code.replace(old, new))
    two_pairs(own / "runs" / "s6", 3.0, 6, derived={"grains": 2}, material="ice", packing="bpca")
    assert run(own, "--figures", own / "out") == 2
    assert says in capsys.readouterr().err.splitlines()[-1]


def test_tables_of_unlike_runs_are_refused_together(own, capsys):
    """Each of them is read, and as one of two with like runs."""
    made = {}
    for material, seed in (("ice", 6), ("silicate", 7)):
        two_pairs(own / material / "run", 3.0, seed, derived={"grains": 2}, material=material)
        assert study(own, own / material, "--format", "csv") == 0
        made[material] = own / f"{material}.csv"
        made[material].write_text(capsys.readouterr().out)
    for first, second in (made.values(), (made["silicate"], own / "ice")):
        assert study(own, first, second, "--json") == 2
        assert "the runs differ in material too: name them in varied" in capsys.readouterr().err.splitlines()[-1]
    assert study(own, made["ice"], own / "ice", "--json") == 0
    assert json.loads(capsys.readouterr().out)["provenance"]["runs"] == 1
    (own / "nothing").mkdir()
    assert study(own, own / "nothing") == 2
    assert "nothing: no run folder" in capsys.readouterr().err


def test_pairs_of_files_are_told_by_the_files(tmp_path, capsys):
    """Aggregates from files have one seed; a table of such runs is read again."""
    code = """
from analysis.studies.collisions import collision_study, outcome_quantities
from analysis.studies.runs import Runs
of = lambda table: outcome_quantities(Runs(table, "file", ("projectileFile",)), ("velocity",))
STUDY = collision_study("T", "Q?", ("velocity", "file", "projectileFile"), of, packing="file")
"""
    (tmp_path / "files.py").write_text(code)
    for first, second in (("a1", "b1"), ("a2", "b1"), ("a1", None)):
        files = dict(packing="file", file=first, projectileFile=second)
        two_pairs(tmp_path / "runs" / f"{first}-{second}", 3.0, 1, **files)
    assert main(["study", str(tmp_path / "files.py"), str(tmp_path / "runs"), "--format", "csv"]) == 0
    (tmp_path / "runs.csv").write_text(capsys.readouterr().out)
    for runs in ("runs", "runs.csv"):
        (sticking,) = answered(capsys, tmp_path / "files.py", tmp_path / runs)[0]["sticking"]
        assert (sticking["value"], sticking["pairs"]) == (1.0, 3)


@pytest.mark.parametrize("short, long", ["ab", "ba"])
def test_of_two_runs_of_a_collision_the_longer_one_counts(own, capsys, short, long):
    for name, more in ((short, {}), (long, dict(duration=1.0))):
        made_run(own / "both" / name, 20, 3.0, 1, grains=2, **more)
    assert study(own, own / "both", "--format", "csv") == 0
    said = capsys.readouterr()
    assert [row.split(",")[0] for row in said.out.splitlines() if row[0] != "#"] == ["run", long]
    assert (
        f"both/{short}: the same grains, velocity and seed as {own}/both/{long}, which is longer, left out" in said.err
    )


@pytest.mark.parametrize("column", ["population=", "by="])
def test_a_column_that_the_runs_lack_is_one_line(own, capsys, column):
    code = (own / "sticking.py").read_text()
    (own / "sticking.py").write_text(code.replace(f'{column}("grains"', f'{column}("grain"'))
    assert run(own) == 2
    last = capsys.readouterr().err.splitlines()[-1]
    assert last.startswith("analysis: table of runs: no grain (did you mean grains?); must be one of")


def test_runs_that_never_met_are_in_no_fraction():
    table = pandas.DataFrame({"seed": [1, 2, 3], "velocity": 1.0, "outcome": ["sticking", "never met", "bouncing"]})
    sticking, bouncing, *_ = outcome_quantities(Runs(table.assign(restitution=0.5)), ("velocity",))
    assert repr(sticking.at(velocity=1.0)) == repr(bouncing.at(velocity=1.0)) == "1 of 2"


def test_of_a_run_in_two_tables_the_first_counts(own, capsys):
    """A run that was continued replaces the one that was undecided."""
    two_pairs(own / "longer" / "open", 40.0, 1)
    tables = [str(own / f"{name}.csv") for name in ("longer", "runs")]
    for table in tables:
        study(own, table.removesuffix(".csv"), "--format", "csv")
        Path(table).write_text(capsys.readouterr().out)
    assert study(own, *tables, "--format", "csv") == 0
    both = capsys.readouterr().out
    (own / "both.csv").write_text(both)
    assert "runs of runs.csv that are in a table before it, which counts: 1" in both.splitlines()[0]
    found, runs, _ = answered(capsys, own / "sticking.py", own / "both.csv")
    assert runs == 5 and [(row["value"], row["low"] > 0) for row in found["sticking"]] == [(0.75, True), (1.0, True)]
    assert main(["study", "elastoplastic", tables[0]]) == 2 and capsys.readouterr().err.count("\n") == 1


def test_everything_is_inside_the_page_and_text_of_the_data_is_no_html(own, capsys, monkeypatch):
    monkeypatch.setattr(pdf, "_CONVERTERS", ())
    code = (own / "sticking.py").read_text().replace("Fraction of pairs", "<script>alert(1)</script>")
    (own / "sticking.py").write_text(code.replace('title="', 'title="<script>alert(2)</script>'))
    assert run(own, "--page", own / "out" / "page.html") == 0
    said = capsys.readouterr()
    assert "page.pdf: not written" in said.err and said.out.splitlines()[-1].endswith("out/page.html")
    assert sorted(file.name for file in (own / "out").iterdir()) == ["page-view.html", "page.html"]
    text = (own / "out" / "page.html").read_text()
    page = elements(text)
    addresses = [image.get("src") for image in page.iter("img")] + [link.get("href") for link in page.iter("a")]
    assert [address for address in addresses if not address.startswith("data:")] == ["page-view.html"]
    assert all(f"alert({k})" in text for k in (1, 2)) and "<script>" not in text
    assert {"script", "link"}.isdisjoint(element.tag for element in page.iter())
    picture = addresses[0].partition(",")[2]
    assert Image.open(io.BytesIO(base64.b64decode(picture))).width > 100
    sent = {a.get("download"): base64.b64decode(a.get("href").partition(",")[2]) for a in page.iter("a")}
    (own / "sent.csv").write_bytes(sent["runs.csv"])
    assert study(own, own / "sent.csv") == 0
    assert str(own) not in re.sub(r"data:[^\"]*", "", text)


def test_a_page_must_be_html_that_can_be_written(own, capsys):
    with pytest.raises(SystemExit) as stop:
        run(own, "--page", "page.pdf")
    assert stop.value.code == 2 and "page.pdf: must end in .html" in capsys.readouterr().err
    (own / "taken").write_text("")
    assert run(own, "--page", own / "taken" / "p.html") == 2
    assert capsys.readouterr().err.splitlines()[-1].startswith("analysis: ")


def test_a_converter_that_fails_leaves_no_pdf(tmp_path, program):
    program("weasyprint", "echo no font >&2; exit 1")
    (tmp_path / "p.html").write_text("<p>")
    with pytest.raises(pdf.NoPdf, match="weasyprint: no font"):
        pdf.write_pdf(tmp_path / "p.html", tmp_path / "p.pdf")
    assert not (tmp_path / "p.pdf").exists()


def test_snapshots_are_drawn_from_run_folders_and_from_what_is_kept(own, capsys):
    study = find.find(str(own / "sticking.py"))
    results = analyse(study, [own / "runs"]).results
    row = next(results.table.assign(grain_radius=1e-7).itertuples())
    run_ = open_run(row.folder)
    figure = SnapshotFigure("shots", "", lambda _: [(row, "one", [0.0, 1.0])])
    assert figure.draw(results) is not None and list(results.snapshots) == [row.run]
    write_snapshots(own / "kept.npz", results.snapshots[row.run])
    kept = read_snapshots(own / "kept.npz")
    assert [state.time for state in kept] == [run_.states.times[0], run_.states.times[-1]]
    assert kept[1].position == pytest.approx(run_.last.position, abs=1e-4 * np.abs(run_.last.position).max())
    assert kept[1].aggregate.tolist() == run_.last.aggregate.tolist()


@pytest.mark.parametrize("name", find.names())
def test_every_gallery_is_one_screen_and_follows_from_its_runs(name):
    """The page has at most 700 words, and its text, its tests and every number come out of runs.csv and paper.toml."""
    folder = TOP / "analysis" / "gallery" / name
    page = (folder / "README.md").read_text()
    assert len(page.split()) <= 700
    again = analyse(find.find(name), sorted(map(str, folder.glob("runs*.csv"))))
    drawn = ((figure, folder / f"{figure.name}.png") for figure in find.figures(again.study))
    assert page == screen(
        again, {figure.name: (file.name, figure.caption) for figure, file in drawn if file.exists()}, prose=True
    )
    found, kept = json.loads(again.json()), json.loads((folder / "comparison.json").read_text())
    assert [(c["label"], c["verdict"]) for c in found["claims"]] == [(c["label"], c["verdict"]) for c in kept["claims"]]
    assert len(found["claims"]) == len(read_paper(TOP / "analysis" / "studies" / name)[1])
    assert not again.found.problems and found["quantities"].keys() == kept["quantities"].keys()
    for quantity in kept["quantities"]:
        both = (own["quantities"][quantity]["rows"] for own in (found, kept))
        told = ([(row["value"], row["error"] or 0.0) for row in own] for own in both)
        ours, theirs = (np.array(own, dtype=float).reshape(-1, 2).T for own in told)
        # a difference of large numbers that is almost 0 is known to a part of its error, on another processor too
        near = 1e-6 * (np.abs(theirs[0]) + theirs[1]) + 1e-12
        same = (ours[0] == theirs[0]) | (np.isnan(ours[0]) & np.isnan(theirs[0]))
        assert np.all(same | (np.abs(ours[0] - theirs[0]) <= near)), quantity


def test_the_documents_above_the_studies_follow_from_the_runs():
    """gallery/README.md and paper.md are what `make gallery` writes."""
    for name, text in documents.texts().items():
        assert (TOP / "analysis" / "gallery" / name).read_text() == text
