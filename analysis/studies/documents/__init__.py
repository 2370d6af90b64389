"""The documents above the pages of the studies: gallery/README.md and gallery/paper.md, and a PDF of this.

    python3 -m analysis.studies.documents PDF

Each is a template of the same name beside this file. In it say("viscous", "drag_largest", grains = 50000) stands for '8600 ± 2100', a quantity of
a study of the gallery's runs; sentence(study) and judged(studies) for what its paper.toml says in one sentence and for verdicts, runs(studies) for their number; ratio(scene)
and errors(step) for what tests/benchmarks has measured, beside(distribution) for what tests/conformance has."""

import json
from functools import cache
from pathlib import Path

import numpy as np
import pandas

from ...report.pdf import write_pdf
from ...runs.write import write_text
from ..analyse import TABLE_FILE, analyse
from ..definition import GALLERY
from ..estimate import number_text
from ..find import find
from ..html import html_page
from ..page import counted, filled, number

HERE = Path(__file__).resolve().parent
OVERVIEW, PAPER = "README.md", "paper.md"
TESTS = HERE.parents[2] / "tests"
RESULTS = TESTS / "benchmarks" / "results"
ENSEMBLES = TESTS / "conformance" / "results" / "ensembles"


@cache
def _analysis(study):
    return analyse(find(study), [GALLERY / study / TABLE_FILE])


@cache
def _table(file):
    return pandas.read_csv(file)


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


def ratio(scene, code="lammps", threads=2):
    """'8.8 to 12': engine over another code, least and most over a scene's moments (medians of the rounds)."""
    rows = _table(RESULTS / "speed.csv").query("scene == @scene and threads == @threads")
    rates = rows.pivot_table(index="moment", columns="code", values="rate", aggfunc="median")
    of_moments = rates.engine / rates[code]
    return f"{of_moments.min():.2g} to {of_moments.max():.2g}"


def errors(step):
    """(ledger's error over K(0), d_max less that of the finest step [grain radii], seconds a run) at a step [t0] (str each): root mean squares
    of a few collisions, and the median."""
    rows = _table(RESULTS / "error.csv").query("scene == 'collision' and code == 'engine'")
    of_step = rows[rows.step == step].set_index("sample")
    change = of_step.d_max - rows[rows.step == rows.step.min()].set_index("sample").d_max
    squares = (f"{np.sqrt((values**2).mean()):.1e}" for values in (of_step.ledger, change))
    return *squares, f"{of_step.seconds.median():.1f}"


def beside(distribution, code="lammps-newest"):
    """'-0.091 ± 0.010': another code's mean of a distribution less the engine's, of the same aggregates, ± its standard error."""
    read = lambda name: json.loads((ENSEMBLES / f"{name}.json").read_text())["samples"][distribution]
    change = np.subtract(read(code), read("engine"))
    return number_text(change.mean(), change.std(ddof=1) / len(change) ** 0.5)


def texts():
    """{file name: text (str)} of both documents. jinja2's errors for a template that can't be filled in."""
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    environment = Environment(loader=FileSystemLoader(HERE), undefined=StrictUndefined, keep_trailing_newline=True)
    known = dict(say=say, sentence=sentence, judged=judged, runs=runs, ratio=ratio, errors=errors, beside=beside)
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
