"""The HTML page of a study: everything inside, the text of the data escaped, and what it says of a difference."""

import base64
import io
import re
import shutil
import sys
from html.parser import HTMLParser

import pytest
from PIL import Image
from test_studies import tiny  # noqa: F401  (a fixture)

from analysis.__main__ import main
from analysis.report.page import gallery_reading as gallery
from analysis.report.page import pdf
from analysis.report.page.reading import DIFFERENCE, NO_DIFFERENCE, OPEN, count, reading
from analysis.report.page.render import page
from analysis.report.section import Column, Report, Section

VOID = {"meta", "img", "br", "hr", "link", "input"}


class Structure(HTMLParser):
    """Tags with attributes; fails on a tag that is not closed where it must be."""

    def __init__(self, text):
        super().__init__()
        self.found, self.open = [], []
        self.feed(text)
        assert not self.open

    def handle_starttag(self, tag, attributes):
        self.found.append((tag, dict(attributes)))
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def of(self, tag):
        return [attributes for name, attributes in self.found if name == tag]


@pytest.fixture
def written(tiny, monkeypatch, capsys):  # noqa: F811
    """Text of the page of a small study, made without a converter to PDF."""
    monkeypatch.setattr(pdf, "_CONVERTERS", ())
    assert main(["study", "tiny", str(tiny / "runs"), "--page", str(tiny / "out" / "tiny.html")]) == 0
    said = capsys.readouterr().err
    assert "tiny.pdf: not written: needs weasyprint or chromium" in said
    assert [file.name for file in (tiny / "out").iterdir()] == ["tiny.html"]
    return (tiny / "out" / "tiny.html").read_text()


def test_everything_is_inside_the_page(written, tiny):  # noqa: F811
    found = Structure(written)
    addresses = [a["src"] for a in found.of("img")] + [a["href"] for a in found.of("a")]
    assert addresses and all(address.startswith(("data:", "#")) for address in addresses)
    assert not found.of("script") and not found.of("link")
    (picture,) = found.of("img")
    assert Image.open(io.BytesIO(base64.b64decode(picture["src"].partition(",")[2]))).width > 100
    tables = {a["download"]: base64.b64decode(a["href"].partition(",")[2]) for a in found.of("a") if "download" in a}
    (tiny / "sent.csv").write_bytes(tables["tiny-runs.csv"])
    assert main(["study", "tiny", str(tiny / "sent.csv")]) == 0 and "tiny-comparison.json" in tables


def test_the_page_says_how_it_was_made_without_this_machines_folders(written, tiny):  # noqa: F811
    made = written[written.index('id="made"') :]
    assert "study tiny runs --page tiny.html" in made and "4 runs" in made and "commit: " in made
    assert str(tiny) not in re.sub(r"data:[^\"]*", "", written)


def test_the_study_that_asks_nothing_has_no_question(written):
    assert 'class="question"' not in written and "<h1>Sticking against velocity</h1>" in written


@pytest.mark.parametrize("name", ["elastoplastic", "viscous", "compression", "elastoplastic_variants"])
def test_studies_say_what_they_ask(name):
    from analysis.studies.find import find

    assert "?" in find(name).question


def record(**values):
    names = ("paper", "error", "difference", "combined_difference", "chance")
    return {**dict.fromkeys(names), **values}


@pytest.mark.parametrize(
    "values, seeds, verdict",
    [
        ({"paper": 1.0, "error": 0.1, "difference": 1.9}, 10, NO_DIFFERENCE),
        ({"paper": 1.0, "error": 0.1, "difference": -2.1}, 10, DIFFERENCE),
        ({"paper": 1.0, "error": 0.1, "difference": 3.0, "combined_difference": 1.5}, 10, NO_DIFFERENCE),
        ({"paper": 1.0, "error": 0.1, "difference": 3.0, "chance": 0.2}, 10, NO_DIFFERENCE),
        ({"paper": 1.0, "error": 0.1, "difference": 3.0, "chance": 0.01}, 10, DIFFERENCE),
        (
            {"paper": 1.0, "error": 0.1, "difference": 3.0, "combined_difference": 1.5, "chance": 0.01},
            10,
            NO_DIFFERENCE,
        ),
        ({"paper": 1.0, "error": 1e-6, "difference": 1e5, "chance": 1e-5}, 2, OPEN),
        ({"paper": 1.0, "error": 0.1, "difference": 30.0}, 2, OPEN),
        ({"paper": 1.0, "error": 0.9, "difference": 0.1}, 10, OPEN),
        ({"paper": 1.0}, 10, OPEN),
        ({"error": 0.1}, 10, ""),
    ],
)
def test_what_a_difference_tells(values, seeds, verdict):
    found, why = reading(record(**values), seeds)
    assert found == verdict and bool(why) == bool(verdict)


def test_readings_are_counted_over_all_tables():
    lines = [record(paper=1.0, error=0.1, difference=d) for d in (0.5, 1.0, 4.0)] + [{"velocity": 3.0}, record()]
    assert count(lines, 10) == {NO_DIFFERENCE: 2, DIFFERENCE: 1, OPEN: 0}


def report(**changes):
    column = Column("a|b", lambda r: r["text"])
    origin = {"runs": 1, "steps": 2, "hours": 0.5, "commits": {"c<1>": 1}, "machines": {}, "versions": {}}
    sections = (Section("<b>head</b>", (column,), ({"text": "<script>alert(1)</script>"},), notes=("a & b",)),)
    values = {
        "study": "s",
        "title": "T<",
        "provenance": {**origin, "stepFractions": {}},
        "remarks": ("x",),
        "notes": (),
    }
    return Report(**{**values, "sections": sections, **changes})


def test_text_of_the_data_is_no_html():
    text = page(report(), (), (), ("make",))
    assert "<script>" not in text and "&lt;script&gt;alert(1)" in text and "c&lt;1&gt;" in text
    Structure(text)


def test_the_gallerys_reading_is_told_to_be_of_other_runs(tmp_path):
    (tmp_path / "README.md").write_text("# Title\n\n## Found\n\n| a | b |\n|---|---|\n| <i>1</i> | [c](c.md) |\n")
    (tmp_path / "comparison.json").write_text('{"provenance": {"runs": 1}}')
    html, same = gallery.gallery_reading(tmp_path, {"runs": 1})
    assert same and "<h3>Found</h3>" in html and "<td>c</td>" in html and "<i>" not in html and "Title" not in html
    assert not gallery.gallery_reading(tmp_path, {"runs": 2})[1]
    assert gallery.gallery_reading(tmp_path / "none", {}) is None
    text = page(report(), (), (), (), (html, False))
    assert "its numbers are not this page's" in text and "<td>c</td>" in text
    Structure(text)


def test_a_page_must_be_html(tiny, capsys):  # noqa: F811
    with pytest.raises(SystemExit) as stop:
        main(["study", "tiny", str(tiny / "runs"), "--page", "page.pdf"])
    assert stop.value.code == 2 and "page.pdf: must end in .html" in capsys.readouterr().err


def test_a_page_that_cannot_be_written_is_one_line(tiny, capsys):  # noqa: F811
    (tiny / "taken").write_text("")
    assert main(["study", "tiny", str(tiny / "runs"), "--page", str(tiny / "taken" / "p.html")]) == 2
    assert capsys.readouterr().err.splitlines()[-1].startswith("analysis: ")


def converter(tmp_path, monkeypatch, code):
    """A program that stands for weasyprint."""
    program = tmp_path / "bin" / "weasyprint"
    program.parent.mkdir()
    program.write_text(f"#!{sys.executable}\nimport sys\n{code}\n")
    program.chmod(0o755)
    monkeypatch.setenv("PATH", str(program.parent))
    (tmp_path / "p.html").write_text("<p>")
    return tmp_path / "p.html", tmp_path / "p.pdf"


def test_a_converter_that_fails_leaves_no_pdf(tmp_path, monkeypatch):
    html, file = converter(tmp_path, monkeypatch, "sys.exit('no font')")
    with pytest.raises(pdf.NoPdf, match="weasyprint: no font"):
        pdf.write_pdf(html, file)
    assert not file.exists()


@pytest.mark.skipif(
    not any(shutil.which(name) for name, _ in pdf._CONVERTERS), reason="no converter to PDF is installed"
)
def test_a_pdf_is_written_where_a_converter_is(tmp_path):
    (tmp_path / "p.html").write_text(page(report(), (), (), ("make",)))
    assert pdf.write_pdf(tmp_path / "p.html", tmp_path / "p.pdf").read_bytes().startswith(b"%PDF-")
