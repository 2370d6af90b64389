"""Columns of a table of runs with how a run folder fills them, and those that several studies have."""

from dataclasses import dataclass
from typing import Callable

from ..measures.ledger import closure
from ..measures.of_run import derived_constants, met
from ..runs.arrays import RunFolderError
from ..runs.table import Column

_TYPES = {"f": float, "i": int, "O": str}


@dataclass(frozen=True)
class Columns:
    """columns (runs.table.Column) that are measured together; of(run (RunFolder), row ({column: value} of those before)) -> their values, in
    the same order; definition.NotMeasured or RunFolderError where it can't."""

    of: Callable
    columns: tuple


def group(of, *columns):
    """Columns of several."""
    return Columns(of, columns)


def one(name, unit, meaning, of, **more):
    """Columns of one: of(run) is its value; more: runs.table.Column's."""
    return group(lambda run, row: (of(run),), Column(name, unit, meaning, **more))


def parameter(name, unit, meaning, kind="f", usual=None, shown=lambda value: value):
    """A parameter of the run; usual: its value in runs of earlier versions, which lack it; shown(value): what the column has."""

    def of(run):
        try:
            return shown(_TYPES[kind](run.settled[name] if usual is None else run.settled.get(name, usual)))
        except (KeyError, TypeError, ValueError) as error:
            raise RunFolderError(f"{run.path}: cannot be measured: {error}") from None

    return one(name, unit, meaning, of, kind=kind)


def constant(name, unit, meaning, source=""):
    """A constant that the run derived from its parameters: `source`, or the column's name, in run.json."""
    return one(name, unit, meaning, lambda run: derived_constants(run, source or name)[0])


def flat(measured):
    """(runs.table.Column, ...) of all Columns."""
    return tuple(column for own in measured for column in own.columns)


def row_of(measured, run):
    """{column: value} of a RunFolder, as Columns measure it one after the other."""
    row = {}
    for own in measured:
        row.update(zip((column.name for column in own.columns), own.of(run, row), strict=True))
    return row


VELOCITY = parameter("velocity", "m/s", "collision velocity")
SEED = parameter("seed", "", "random seed of the pair of aggregates", "i")
VISCOUS_TIME = parameter("viscoelasticTime", "s", "T_vis of the viscous drag")
MATERIAL = parameter("material", "", "material of the grains", "O", "")
GRAIN_RADIUS = constant("grain_radius", "m", "radius of a grain", "grainRadius")
MET = one("met", "", "whether the aggregates touched", met, kind="b")
CLOSURE = one("closure", "", "largest error of the energy ledger over K(0)", lambda run: closure(run.history))
END = one("time", "s", "time at the end", lambda run: float(run.history["time"][-1]))
