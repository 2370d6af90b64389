"""From a study and paths to its results, pages, table and figures."""

import errno
import json
import math
import re
from dataclasses import dataclass
from pathlib import Path

from ..progress import progress
from ..runs.files import UNSUMMED, read_summed, read_text, replacing, summed, write_file
from ..runs.table import NoRunFolder, table_text
from .columns import CLOSURE
from .definition import GALLERY, SNAPSHOTS, Results, Study
from .find import figures, own_errors
from .gather import Gathered, gather
from .html import html_page
from .page import DETAILS_FILE, PAGE_FILE, details, screen
from .paper import FILE as PAPER
from .paper import Page, PaperError, read_paper
from .predictions import predictions
from .runs import keyed
from .tables import quantity_table, tests_table, text_table
from .verdict import judge

TABLE_FILE, DATA_FILE = "runs.csv", "comparison.json"


class NothingToAnalyse(Exception):
    """No run that belongs to the study was found; `found` says what was."""

    def __init__(self, study, found):
        super().__init__(f"no run of {study.scene.name} to analyse")
        self.found = found


@dataclass(frozen=True)
class Analysis:
    """A study's results of a set of runs: found (gather.Gathered), results (definition.Results), words (paper.Page), judgements
    ([verdict.Judgement] of the paper's claims), predictions ([dict], as predictions.py has them)."""

    study: Study
    found: Gathered
    results: Results
    words: Page
    judgements: list
    predictions: list

    @property
    def closures(self):
        """How well the runs' energy ledgers close (lines, str)."""
        columns = [column for column in self.study.columns if column.name == CLOSURE.columns[0].name]
        return [f"{column.meaning}: {self.found.table[column.name].max():.2g} at most" for column in columns]

    @property
    def notes(self):
        """What the files say of runs left out, without this machine's paths."""
        found = self.found
        lines = list(dict.fromkeys(found.earlier))  # of one table gathered again and again
        if found.notes:
            lines.append(f"{len(found.notes)} runs left out (not ended, not of this study, or with nothing to measure)")
        if found.problems:
            lines.append(f"{len(found.problems)} runs not readable")
        return lines

    @property
    def listed(self):
        """Quantities that the details have tables of."""
        return [quantity for quantity in self.results.quantities.values() if quantity.listed]

    def csv(self):
        """The table of runs as a file (str)."""
        head = {"study": self.study.name, "provenance": self.found.provenance, "notes": self.notes}
        if self.study.alike:
            head["alike"] = self.found.alike
        return table_text(self.found.table, self.study.columns, head)

    def text(self):
        """For a terminal (str): every quantity, then the paper's numbers."""
        parts = []
        for quantity in self.listed:
            parts += [f"{quantity.name}{quantity.in_unit}: {quantity.meaning}", text_table(quantity_table(quantity))]
        if self.judgements:
            parts += [f"beside {self.words.paper}", text_table(tests_table(self.judgements))]
        return "\n".join((*parts, *self.closures))

    def markdown(self):
        """Both pages (str), without figures."""
        return screen(self, {}, self.is_gallerys()) + "\n" + details(self, {})

    def json(self):
        """Everything as a JSON file (str), in SI units but for the paper's claims, which are in the unit named."""
        content = {
            **UNSUMMED,
            "study": self.study.name,
            "provenance": self.found.provenance,
            "notes": self.notes,
            "claims": [j.record for j in self.judgements],
            "predictions": self.predictions,
            "quantities": {
                q.name: {"meaning": q.meaning, "unit": q.unit, "scale": q.scale, "rows": _rows(q)}
                for q in self.results.quantities.values()
            },
        }
        return summed(_json_text(_plain(content)) + "\n")

    def is_gallerys(self):
        """Whether the runs are those of the gallery, which the words of paper.toml are of; RunFolderError where its file is damaged."""
        file = GALLERY / self.study.name / DATA_FILE
        if not file.exists():
            return False
        try:
            kept = json.loads(read_summed(file))
            return kept["provenance"] == _plain(self.found.provenance)
        except (ValueError, KeyError, TypeError):
            return False

    def write(self, folder, table=True, commands=()):
        """Write pages, JSON, figures and, if wanted, the table into a folder (Path, made if it is missing): Written. commands: lines that
        say how to make all of it again."""
        folder.mkdir(parents=True, exist_ok=True)
        if table:
            write_file(folder / TABLE_FILE, self.csv())
        write_file(folder / DATA_FILE, self.json())
        drawn, undrawn = _draw(self.study, self.results, folder)
        prose = folder.resolve() == GALLERY / self.study.name or self.is_gallerys()
        texts = {PAGE_FILE: screen(self, drawn, prose), DETAILS_FILE: details(self, drawn, commands)}
        for name, text in texts.items():
            write_file(folder / name, text)
        return Written(folder, texts, tuple(undrawn))

    def page(self, written, view=None):
        """The HTML page (str) with what was written in it. view: (file beside it on which a run can be turned, the run's name), or None."""
        files = [written.folder / name for name in (TABLE_FILE, DATA_FILE)]
        return html_page(self.study.title, written.texts.values(), written.folder, files, view)


def require_own(folder, study):
    """Raise OSError where a folder (Path) holds a page or table that no analysis of a study of this name has written."""
    files = [folder / name for name in (PAGE_FILE, DETAILS_FILE, DATA_FILE, TABLE_FILE)]
    there = [file for file in files if file.is_file() and not file.is_symlink()]  # the writer refuses all else
    head = re.compile(r'(?:# )?\{\s*(?:"sha256": "\w+",\s*)?"study": ' + re.escape(json.dumps(study)))
    if there and not any(head.match(read_text(file)) for file in there if file.name in (DATA_FILE, TABLE_FILE)):
        reason = f"no analysis of {study} has written it; must be another folder"
        raise OSError(errno.EEXIST, reason, str(there[0]))


@dataclass(frozen=True)
class Written:
    """What Analysis.write() left: folder (Path), texts ({file name: Markdown}), undrawn (names of figures that could not be drawn because they
    need run folders)."""

    folder: Path
    texts: dict
    undrawn: tuple


def analyse(study, paths):
    """Analysis of a definition.Study from run folders, folders that hold them and tables of earlier analyses (paths).

    NothingToAnalyse where no run that belongs to it is among them, paper.PaperError where its paper.toml or predictions.csv can't be used;
    what is wrong with runs is in .found."""
    words, claims = read_paper(study.beside)
    found = gather(study, paths)
    if found.table is None:
        raise NothingToAnalyse(study, found)
    with own_errors(study):
        results = study.results(found.table)
    try:
        judged = judge(claims, results)
    except ValueError as error:
        raise PaperError(f"{study.beside / PAPER}: {error}") from None
    return Analysis(study, found, results, words, judged, predictions(study.folder, results))


def _rows(quantity):
    """Records of a quantity's estimates."""
    names = [name for name in quantity.values.index.names if name is not None]
    return ({**dict(zip(names, key)), **own.record} for key, own in keyed(quantity.values))


def _json_text(value, margin=" "):
    """JSON with one line for each record that holds no other."""
    parts = value.values() if isinstance(value, dict) else value if isinstance(value, list) else ()
    if not any(isinstance(part, (dict, list)) for part in parts):
        return json.dumps(value, ensure_ascii=False, allow_nan=False)
    own = [f"{json.dumps(key)}: " for key in value] if isinstance(value, dict) else [""] * len(value)
    lines = (f"{margin}{head}{_json_text(part, margin + ' ')}" for head, part in zip(own, parts))
    start, end = "{}" if isinstance(value, dict) else "[]"
    return start + "\n" + ",\n".join(lines) + f"\n{margin[:-1]}{end}"


def _plain(value):
    """The value as JSON can hold it: numpy's numbers as Python's, null for NaN and infinity."""
    if isinstance(value, dict):
        return {str(key): _plain(item) for key, item in value.items()}
    if not isinstance(value, str) and hasattr(value, "__iter__"):
        return [_plain(item) for item in value]
    if hasattr(value, "item"):
        value = value.item()
    if isinstance(value, float):
        return float(f"{value:.10g}") if math.isfinite(value) else None
    return value


def _draw(study, results, folder):
    """({name: (file name, caption)} of the figures that are there, [name] of those that need run folders)."""
    # matplotlib is slow to load, and the numbers do without it.
    from ..figures.style import save_small

    there, undrawn = {}, []
    for figure in progress(figures(study), "drawing"):
        file = folder / f"{figure.name}.png"
        try:
            with own_errors(study):
                drawn = figure.draw(results)
            if drawn is None:
                file.unlink(missing_ok=True)
                file.with_suffix(".pdf").unlink(missing_ok=True)
            else:
                save_small(drawn, file)
                if figure.vector:
                    with replacing(file.with_suffix(".pdf")) as out:
                        drawn.savefig(out, format="pdf", metadata={"CreationDate": None})
        except NoRunFolder:
            # One of an earlier analysis stays.
            undrawn.append(figure.name)
        if file.exists():
            there[figure.name] = (file.name, figure.caption)
    _keep(results.snapshots, folder / SNAPSHOTS)
    return there, undrawn


def _keep(snapshots, folder):
    """Write the states of which snapshots were drawn, so that they can be drawn again without run folders."""
    from .snapshot_figure import write_snapshots

    for run, states in snapshots.items():
        folder.mkdir(exist_ok=True)
        with replacing(folder / f"{run}.npz") as file:
            write_snapshots(file, states)
