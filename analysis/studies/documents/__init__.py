"""The documents above the pages of the studies: gallery/README.md and gallery/paper.md, and a PDF of this.

    python3 -m analysis.studies.documents PDF

Each is a template of the same name beside this file. In it say("viscous", "drag_largest", grains = 50000) stands for '8600 ± 2100', a quantity of
a study of the gallery's runs; sentence(study) and judged(studies) for what its paper.toml says in one sentence and for verdicts, runs(studies) for their number."""

from functools import cache
from pathlib import Path

from ...report.pdf import write_pdf
from ...runs.write import write_text
from ..analyse import TABLE_FILE, analyse
from ..definition import GALLERY
from ..find import find
from ..html import html_page
from ..page import counted, filled, number

HERE = Path(__file__).resolve().parent
OVERVIEW, PAPER = "README.md", "paper.md"


@cache
def _analysis(study):
    return analyse(find(study), [GALLERY / study / TABLE_FILE])


def say(study, name, **where):
    """A number of a study, as page.number() writes it."""
    return number(_analysis(study).results, name, **where)


def sentence(study):
    """What a study found (str)."""
    return filled(_analysis(study).words.sentence, _analysis(study))


def judged(*studies):
    """How many statements of their papers these studies reproduce, contradict and leave untested (str)."""
    return counted([j for study in studies for j in _analysis(study).judgements])


def runs(*studies):
    """Number of runs of these studies, with a comma at the thousands (str)."""
    return f"{sum(len(_analysis(study).found.table) for study in studies):,}"


def texts():
    """{file name: text (str)} of both documents. jinja2's errors for a template that can't be filled in."""
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    environment = Environment(loader=FileSystemLoader(HERE), undefined=StrictUndefined, keep_trailing_newline=True)
    known = dict(say=say, sentence=sentence, judged=judged, runs=runs)
    return {name: environment.get_template(name).render(known) for name in (OVERVIEW, PAPER)}


def write(pdf):
    """Write both documents into the gallery, and the paper as a PDF (Path) with its page (.html) beside it; report.pdf.NoPdf where no program
    makes one."""
    written = texts()
    for name, text in written.items():
        write_text(GALLERY / name, text)
    page = pdf.with_suffix(".html")
    write_text(page, html_page("Cohesive dust aggregates in YADE", [written[PAPER]], GALLERY, []))
    write_pdf(page, pdf)
