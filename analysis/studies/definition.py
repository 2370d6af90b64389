"""What a study is made of."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Callable

import pandas

from ..printable import suggested
from ..runs.collect import Scene
from .columns import NotMeasured, flat, row_of  # noqa: F401
from .estimate import Fraction
from .levels import SI
from .runs import at, select

GALLERY, SNAPSHOTS = Path(__file__).resolve().parents[1] / "gallery", "snapshots"


class WrongUnit(ValueError):
    """A unit in which a quantity can't be shown; the message is one line."""


@dataclass(frozen=True)
class Quantity:
    """What a study tells: name (a word: what paper.toml and figures call it), meaning (the sentence a table is headed with), values
    (Series of Estimate or Fraction in SI units, indexed by what it depends on), unit in which it is shown (of levels.SI, or one of SI's).
    listed: whether the details have a table of it; curves of many points are for figures and comparison.json."""

    name: str
    meaning: str
    values: pandas.Series
    unit: str = ""
    listed: bool = True

    def __post_init__(self):
        if self.scale != 1.0 and any(isinstance(each, Fraction) for each in self.values):
            raise WrongUnit(f"quantity {self.name}: fractions are counts of runs; must be without the unit {self.unit}")

    @property
    def scale(self):
        """That unit in SI."""
        return SI.get(self.unit, 1.0)

    @property
    def in_unit(self):
        """' [m/s]'; '' without a unit."""
        return f" [{self.unit}]" if self.unit else ""

    def at(self, **where):
        """The Estimate or Fraction, in SI units, there; None where it is not known (runs.at)."""
        try:
            return at(self.values, **where)
        except (KeyError, ValueError) as error:
            raise type(error)(f"{self.name}: {error.args[0]}") from None

    def shown(self, estimate):
        """An estimate in the unit in which it is shown."""
        return estimate if self.scale == 1.0 else estimate / self.scale


@dataclass(frozen=True)
class Results:
    """table (DataFrame, a row a run); quantities {name: Quantity}; unknown names raise KeyError. independent: as Study has it. kept: folder (Path;
    None: there is none) of the states that the gallery keeps of the study's runs; snapshots {run: [snapshot_figure.Snapshot]}: those that were
    read from run folders."""

    table: pandas.DataFrame
    quantities: dict
    independent: str = "pairs"
    kept: object = None
    snapshots: dict = field(default_factory=dict)

    def __getitem__(self, name):
        if name not in self.quantities:
            raise KeyError(f"no quantity {name}{suggested(name, self.quantities)}")
        return self.quantities[name]

    def series(self, name, **where):
        """Series of the estimates of a quantity at these values of some of its levels."""
        return select(self[name].values, **where)


@dataclass(frozen=True)
class Study:
    """title; question (what it asks, and of which paper); scene (which runs belong to it);

    measured    (columns.Columns, ...): a row of the table, with the numbers that tell runs apart
    quantities  table (DataFrame, a row a run, at least one) -> iterable of Quantity
    independent what counts as one in errors, in the plural: pairs (of aggregates), clusters
    alike       whether runs that differ in parameters beside scene.key are refused together
    open_runs   how undecided runs count, for its page
    folder (Path; find() fills it in): the study's, or the file of one's own. name: the folder's, or the file's."""

    title: str
    question: str
    scene: Scene
    measured: tuple
    quantities: Callable
    independent: str = "pairs"
    alike: bool = False
    open_runs: str = "fractions count them apart, means take them as they ended"
    name: str = ""
    folder: object = field(default=None, compare=False)

    @property
    def columns(self):
        """(runs.table.Column, ...) of the table."""
        return flat(self.measured)

    @property
    def beside(self):
        """Folder (Path; None: there is none) in which paper.toml is, if there is one."""
        return self.folder.parent if self.folder and self.folder.suffix == ".py" else self.folder

    def measure(self, run):
        """{column: value} of a RunFolder; NotMeasured or RunFolderError where a column can't be measured."""
        return row_of(self.measured, run)

    def results(self, table):
        """Results of a table of runs."""
        found = {quantity.name: quantity for quantity in self.quantities(table)}
        return Results(table, found, self.independent, GALLERY / self.name / SNAPSHOTS)


@dataclass(frozen=True)
class StudyFigure:
    """A figure: file name without ending, caption, and draw: Results -> matplotlib Figure, or None where the runs don't suffice."""

    vector = True  # also saved as PDF; not where tens of thousands of lines or pixels would make that large

    name: str
    caption: str
    draw: Callable
