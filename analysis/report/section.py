"""One model of a section, which every format writes: a heading, a table, notes."""

from dataclasses import dataclass
from typing import Callable


@dataclass(frozen=True)
class Column:
    """A column of a table: its head, and cell: record -> str. long: the head where there is room for it. beside: a remark
    on the row, which a terminal shows after it in brackets."""

    head: str
    cell: Callable
    long: str = ""
    beside: bool = False


@dataclass(frozen=True)
class Section:
    """heading; intro (a sentence); columns; records (dicts, one a row: what JSON holds, in SI units unless the key or
    the record names another); notes (lines below)."""

    heading: str
    columns: tuple = ()
    records: tuple = ()
    intro: str = ""
    notes: tuple = ()

    def rows(self, long=False):
        """Cells (tuples of str), the first row the heads."""
        yield tuple((column.long if long else "") or column.head for column in self.columns)
        for record in self.records:
            yield tuple(column.cell(record) for column in self.columns)


@dataclass(frozen=True)
class Report:
    """study (its name), title, provenance (dict of runs.provenance), remarks (what could not be done, and why), notes
    (runs left out), sections, question (what the study asks; "" where it doesn't say), seeds (number of different seeds of
    all runs; None: unknown)."""

    study: str
    title: str
    provenance: dict
    remarks: tuple
    notes: tuple
    sections: tuple
    question: str = ""
    seeds: int | None = None
