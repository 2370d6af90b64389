"""Our numbers beside a paper's: lines of a table, with differences in units of the errors."""

import math
from dataclasses import dataclass

import numpy as np

from ..statistics import student_chance
from .section import Column, Section


@dataclass(frozen=True)
class Line:
    """quantity, unit ('' for numbers), ours with its standard error (None: no error), paper (None: it gives none),
    paper_error (None: it gives none, and there is no estimate), note, freedom (degrees of freedom of the error, where it is
    from so many runs less one; None: of more, or unknown), shared (whether the paper's error is of our own scatter, as if its run were
    one of ours)."""

    quantity: str
    unit: str
    ours: float
    error: float = None
    paper: float = None
    paper_error: float = None
    note: str = ""
    freedom: int = None
    shared: bool = False

    @property
    def chance(self):
        """Chance of such a difference from our scatter, by Student's t: of our mean alone, or of the paper's run too where it
        is taken to scatter as ours (shared); None without freedom."""
        difference = self.combined_difference if self.shared else self.difference
        return student_chance(difference, self.freedom) if difference is not None and self.freedom else None

    @property
    def difference(self):
        """(ours - paper)/error, in our standard errors; None where one of them is missing, or the error is 0."""
        if self.ours is None or self.paper is None or not self.error:
            return None
        return (self.ours - self.paper) / self.error

    @property
    def combined_difference(self):
        """The same in units of both errors together; None without paper_error."""
        if self.difference is None or self.paper_error is None:
            return None
        return (self.ours - self.paper) / np.hypot(self.error, self.paper_error)

    @property
    def record(self):
        """All of it as a dict."""
        names = (
            "quantity",
            "unit",
            "ours",
            "error",
            "paper",
            "paper_error",
            "difference",
            "combined_difference",
            "chance",
            "note",
        )
        return {name: getattr(self, name) for name in names}


def error_of_theirs(error, runs, theirs):
    """Standard error of a paper's mean of `theirs` runs, if they scatter as our `runs` whose mean has this error; None where
    ours has none."""
    return None if error is None else error * (runs / theirs) ** 0.5


def line_of_runs(quantity, unit, ours, runs, paper, theirs, note=""):
    """Line of our (mean, standard error or None) of `runs` independent runs beside a paper's mean of `theirs` runs (paper;
    None: it gives none), which it prints without error: its runs are taken to scatter as ours, so that p is of both."""
    mean, error = ours
    scatter = None if paper is None else error_of_theirs(error, runs, theirs)
    return Line(quantity, unit, mean, error, paper, scatter, note, runs - 1, shared=True)


def section_of_lines(heading, lines, notes=()):
    """Section of a list of Line."""
    return Section(heading, _COLUMNS, tuple(line.record for line in lines), notes=tuple(notes))


def number(value, error=None):
    """As many digits as the error has use for (two of its own), or four.

    >>> number(1.23456), number(1.23456, 0.019), number(float("inf")), number(None)
    ('1.235', '1.235', 'inf', '-')
    """
    if value is None or not math.isfinite(value):
        return "inf" if value == math.inf else "-"
    if not error:
        return f"{value:.4g}"
    return f"{value:.{max(0, 1 - math.floor(math.log10(error)))}f}"


def _error(error):
    return "-" if error is None else f"{error:.2g}"


def _sigma(value):
    return "-" if value is None else f"{value:+.1f}"


_COLUMNS = (
    Column("quantity", lambda r: r["quantity"] + (f" [{r['unit']}]" if r["unit"] else "")),
    Column("ours", lambda r: number(r["ours"], r["error"])),
    Column("error", lambda r: _error(r["error"])),
    Column("paper", lambda r: number(r["paper"])),
    Column("diff", lambda r: _sigma(r["difference"])),
    Column("diff*", lambda r: _sigma(r["combined_difference"])),
    Column("p", lambda r: "-" if r["chance"] is None else f"{r['chance']:.2g}"),
    Column("note", lambda r: r["note"], beside=True),
)
