"""What every study does: the documented study of one's own, from run folders to numbers, tables, figures and pages."""

import base64
import re

import numpy as np
import pandas
import pytest
from written_runs import answered, two_pairs

from analysis.__main__ import main
from analysis.studies import comparison
from analysis.studies.comparison import AGREES, DIFFERS, NOT_RUN, UNCLEAR
from analysis.studies.study import GALLERY, NAMES

STICKS = "fraction that sticks, 2 grains, {} m/s"


def study(own, *arguments):
    """Exit status of the study of STUDIES.md, of these runs and with these options."""
    return main(["study", str(own / "sticking.py"), *map(str, arguments)])


def test_the_documented_study_runs(own, capsys):
    found, runs, err = answered(capsys, own / "sticking.py", own / "runs", "--figures", str(own / "out"))
    assert (found[STICKS.format(3)]["ours"], found[STICKS.format(3)]["counted"]) == (0.8, "3 of 3, 1 undecided")
    assert STICKS.format(40) not in found  # undecided
    assert runs == 5 and "late: has not ended, left out" in err
    assert {file.name for file in (own / "out").iterdir()} == {"comparison.csv", "runs.csv", "sticking.png"}
    table = pandas.read_csv(own / "out" / "comparison.csv").set_index("quantity")
    assert table.ours[STICKS.format(3)] == 0.8 and len(table) == len(found)
    assert study(own, own / "runs" / "open", "--figures", own / "out") == 0
    assert "sticking.png: is of other runs" in capsys.readouterr().err


def test_runs_that_differ_are_refused_unless_the_study_names_it(own, capsys):
    """The fixture's runs, as those of earlier versions, lack some parameters."""
    two_pairs(own / "runs" / "s6", 3.0, 6, derived={"grains": 2}, grains=None, duration=9.0, endWhenApart=0)
    two_pairs(own / "runs" / "s7", 3.0, 7, duration=1.0, endWhenApart=1)
    assert study(own, own / "runs") == 0 and "(5 of 5, 1 undecided)" in capsys.readouterr().out
    two_pairs(own / "runs" / "s8", 3.0, 8, material="silicate")
    assert study(own, own / "runs") == 2
    assert "the runs differ in material too" in capsys.readouterr().err.splitlines()[-1]
    code = (own / "sticking.py").read_text()
    (own / "sticking.py").write_text(code.replace('varied=("', 'varied=("material", "'))
    assert study(own, own / "runs") == 0 and "(6 of 6, 1 undecided)" in capsys.readouterr().out


def test_of_two_runs_of_a_collision_the_longer_one_counts(own, capsys):
    for short, long in ("ab", "ba"):
        for name, lasts in ((short, 4e-7), (long, 8e-7)):
            two_pairs(own / short / name, 3.0, 1, how={"lasts": lasts})
        assert study(own, own / short, "--format", "csv") == 0
        out, err = capsys.readouterr()
        assert [row.split(",")[0] for row in out.splitlines() if row[0] != "#"] == ["run", long]
        assert f"{short}/{short}: the same grains, velocity, seed" in err


def test_of_a_run_in_two_tables_the_first_counts(own, capsys):
    """A run that was continued replaces the one that was undecided."""
    two_pairs(own / "longer" / "open", 40.0, 1)
    tables = [own / f"{name}.csv" for name in ("longer", "runs")]
    for table in tables:
        study(own, table.with_suffix(""), "--format", "csv")
        table.write_text(capsys.readouterr().out)
    found, runs, err = answered(capsys, own / "sticking.py", *tables)
    assert runs == 5 and found[STICKS.format(40)]["counted"] == "1 of 1" and "1 runs are in a table before it" in err
    assert main(["study", "viscous", str(tables[0])]) == 2 and capsys.readouterr().err.count("\n") == 1


def test_the_page_holds_everything_and_text_of_the_data_is_no_html(own):
    code = (own / "sticking.py").read_text().replace("Fraction of pairs", "<script>alert(1)</script>")
    (own / "sticking.py").write_text(code.replace('title="', 'title="<script>alert(2)</script>'))
    assert study(own, own / "runs", "--page", own / "out" / "page.html") == 0
    text = (own / "out" / "page.html").read_text()
    assert [file.name for file in (own / "out").iterdir()] == ["page.html"]
    pictures = re.findall(r'src="data:image/png;base64,([^"]+)"', text)
    assert len(pictures) == text.count("<img") == 1 and base64.b64decode(pictures[0]).startswith(b"\x89PNG")
    assert "<script>" not in text and text.count("&lt;script&gt;") >= 2 and "3 of 3" in text and str(own) not in text


@pytest.mark.parametrize("name", NAMES)
def test_every_gallery_is_one_screen_and_follows_from_its_runs(name, capsys, tmp_path):
    """Every number of comparison.csv comes out of runs.csv, and README's table and words are of these numbers."""
    folder = GALLERY / name
    page = (folder / "README.md").read_text()
    assert len(page.replace("|", " ").split()) <= 700
    found, _, err = answered(capsys, name, folder / "runs.csv")
    assert not err
    kept = pandas.read_csv(folder / "comparison.csv").set_index("quantity")
    assert list(found) == list(kept.index)
    error = 1e-9 + 1e-3 * kept.error.fillna(0.0)  # fits end a little elsewhere with another scipy
    for column in ("ours", "error"):
        made = np.array([row[column] for row in found.values()], dtype=float)
        away = np.abs(made - kept[column]) - 1e-6 * np.abs(kept[column])
        assert np.array_equal(np.isnan(made), kept[column].isna()) and not (away > error).any()
    words = [row["word"] for row in found.values()]
    assert words == kept.word.astype(object).fillna("").tolist()
    table = page.split(comparison.START)[1].split(comparison.END)[0]
    shown = [line.split(" | ") for line in table.splitlines() if line.startswith("| ")][1:]
    assert len(shown) <= 8
    for quantity, _, ours, *_ in shown:
        assert ours in (found[quantity[2:]]["text"], "not run")


def test_the_pages_above_all_studies_have_their_numbers():
    made = [text for file in GALLERY.glob("*/comparison.csv") for text in pandas.read_csv(file).text]
    for name in ("README.md", "paper.md"):
        comparison.require_numbers(name, (GALLERY / name).read_text(), made)
    text = (GALLERY / "README.md").read_text()
    for name, *numbers in re.findall(r"\((\w+)/README.md\) \|" + r" (\d+) \|" * 5, text):
        words = pandas.read_csv(GALLERY / name / "comparison.csv").query("paper.notna()").word
        counted = [len(words), *((words == word).sum() for word in (AGREES, DIFFERS, UNCLEAR, NOT_RUN))]
        assert [int(number) for number in numbers] == counted, name
