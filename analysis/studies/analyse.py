"""From a study and paths to its results, report, table and figures."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..progress import progress
from ..report.data import json_text
from ..report.markdown import markdown
from ..report.section import Report
from ..runs.table import NoRunFolder, table_text
from ..runs.write import write_text
from .definition import Study
from .find import figures
from .gather import Gathered, gather

GALLERY = Path(__file__).resolve().parents[1] / "gallery"
TABLE_FILE, PAGE_FILE, DATA_FILE = "runs.csv", "comparison.md", "comparison.json"


class NothingToAnalyse(Exception):
    """No run of the study's scene was found; `found` says what was."""

    def __init__(self, study, found):
        super().__init__(f"no run of {study.scene.name} to analyse")
        self.found = found


@dataclass(frozen=True)
class Analysis:
    """A study's results of a set of runs: found (gather.Gathered), results (of study.results), report."""

    study: Study
    found: Gathered
    results: Any
    report: Report

    def csv(self):
        """The table of runs as a file (str)."""
        head = {"study": self.study.name, "provenance": self.report.provenance, "notes": list(self.report.notes)}
        return table_text(self.found.table, self.study.columns, head)

    def write(self, folder, table=True):
        """Write comparison, JSON, figures and, if wanted, the table into a folder (Path, made if it is missing): Written."""
        folder.mkdir(parents=True, exist_ok=True)
        if table:
            write_text(folder / TABLE_FILE, self.csv())
        write_text(folder / DATA_FILE, json_text(self.report))
        drawn, undrawn = _draw(self.study, self.results, folder)
        write_text(folder / PAGE_FILE, markdown(self.report, drawn))
        return Written(folder, tuple(drawn), tuple(undrawn))

    def page(self, written, commands):
        """The HTML page (str) with what was written in it. commands: lines that say how to make it again."""
        from ..report.page.gallery_reading import gallery_reading
        from ..report.page.render import page

        pictures = [(written.folder / name, caption) for name, caption in written.figures]
        files = [written.folder / name for name in (TABLE_FILE, DATA_FILE)]
        reading = gallery_reading(GALLERY / self.study.name, self.report.provenance)
        return page(self.report, pictures, files, commands, reading)


@dataclass(frozen=True)
class Written:
    """What Analysis.write() left: folder (Path), figures ((file name, caption) of each that is there), undrawn (names of
    those that could not be drawn because they need run folders)."""

    folder: Path
    figures: tuple
    undrawn: tuple


def analyse(study, paths):
    """Analysis of a definition.Study from run folders, folders that hold them and tables of earlier analyses (paths).

    NothingToAnalyse where no run of its scene is among them; what is wrong with others is in .found."""
    found = gather(study, paths)
    if found.table is None:
        raise NothingToAnalyse(study, found)
    results = study.results(found.table)
    sections, remarks = tuple(study.sections(results)), tuple(study.remarks(results))
    report = Report(
        study.name,
        study.title,
        found.provenance,
        remarks,
        tuple(_kept(found)),
        sections,
        question=study.question,
        seeds=int(found.table["seed"].nunique()) if "seed" in found.table else None,
    )
    return Analysis(study, found, results, report)


def _kept(found):
    """What the files say of runs left out, without this machine's paths."""
    yield from found.earlier
    if found.notes:
        yield f"{len(found.notes)} runs left out (not ended, of another scene, or with nothing to measure)"
    if found.problems:
        yield f"{len(found.problems)} runs not readable"


def _draw(study, results, folder):
    """([(file name, caption)] of the figures that are there, [name] of those that need run folders)."""
    # matplotlib is slow to load, and the numbers do without it.
    from ..figures.save import save_small, save_vector

    there, undrawn = [], []
    for figure in progress(figures(study.name), "drawing"):
        file = folder / f"{figure.name}.png"
        try:
            drawn = figure.draw(results)
            if drawn is None:
                file.unlink(missing_ok=True)
                file.with_suffix(".pdf").unlink(missing_ok=True)
            else:
                save_small(drawn, file)
                if figure.vector:
                    save_vector(drawn, file.with_suffix(".pdf"))
        except NoRunFolder:
            # One of an earlier analysis stays.
            undrawn.append(figure.name)
        if file.exists():
            there.append((file.name, figure.caption))
    return there, undrawn
