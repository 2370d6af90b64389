"""What a study is made of."""

from dataclasses import dataclass
from typing import Callable

from ..runs.collect import Scene


class NotMeasured(Exception):
    """A sound run in which there is nothing to measure; the message is one line that says why."""


def _nothing(results):
    return ()


@dataclass(frozen=True)
class Study:
    """title; scene (which runs); columns (runs.table.Column: what `measure` returns; the scene's numbers are among them);

    measure   RunFolder -> {column: value}, one row of the table; NotMeasured or RunFolderError where it can't
    results   table (pandas.DataFrame, a row a run, at least one) -> whatever sections and figures need
    sections  results -> report.section.Section of the comparison, in order
    remarks   results -> lines (str) that say what could not be done, and why

    question  what the study asks, and of which paper: the first lines of its page
    name: that of the study's folder, filled in by find()."""

    title: str
    scene: Scene
    columns: tuple
    measure: Callable
    results: Callable
    sections: Callable
    remarks: Callable = _nothing
    question: str = ""
    name: str = ""


@dataclass(frozen=True)
class StudyFigure:
    """A figure: file name without ending, caption, and draw: results -> matplotlib Figure, or None where the runs don't
    suffice. A figure that needs run folders takes them by runs.table.run_folder. vector: whether it is also saved as PDF;
    not where tens of thousands of lines or pixels would make that large."""

    name: str
    caption: str
    draw: Callable
    vector: bool = True
