"""Columns of a table of runs with how a run folder fills them, and those that several studies have."""

from dataclasses import astuple
from functools import lru_cache

import numpy as np

from ..runs.files import RunFolderError
from ..runs.format import same
from ..runs.ledger import closure
from ..runs.measured import derived_constants, met, outcome_of_run
from ..runs.table import Column
from ..theory import GRAIN_RADIUS as RADII
from ..theory import MATERIALS

_TYPES = {"f": float, "i": int, "O": str}


class NotMeasured(Exception):
    """A sound run in which there is nothing to measure; the message is one line that says why."""


def group(of, *columns):
    """Columns (runs.table.Column) that are measured together: of(run, row) gives their values in the same order, of a
    RunFolder and the {column: value} before; NotMeasured or RunFolderError where it can't."""
    return of, columns


def one(name, unit, meaning, of, **more):
    """A group of one column: of(run) is its value; more: runs.table.Column's."""
    return group(lambda run, row: (of(run),), Column(name, unit, meaning, **more))


def parameter(name, unit, meaning, kind="f", usual=None, shown=lambda value: value):
    """A parameter of the run; usual: its value in runs of earlier versions, which lack it; shown(value): what the
    column has."""

    def of(run):
        try:
            return shown(_TYPES[kind](run.settled[name] if usual is None else run.settled.get(name, usual)))
        except (KeyError, TypeError, ValueError) as error:
            raise RunFolderError(f"{run.path}: cannot be measured: {error}") from None

    return one(name, unit, meaning, of, kind=kind)


def constant(name, unit, meaning, source=""):
    """A constant that the run derived from its parameters: `source`, or the column's name, in run.json."""
    return one(name, unit, meaning, lambda run: derived_constants(run, source or name)[0])


def row_of(groups, run):
    """{column: value} of a RunFolder, measured group by group."""
    row = {}
    for of, columns in groups:
        row.update(zip((column.name for column in columns), of(run, row), strict=True))
    return row


VELOCITY = parameter("velocity", "m/s", "collision velocity")
SEED = parameter("seed", "", "random seed of the pair of aggregates", "i")
MATERIAL = parameter("material", "", "material of the grains", "O", "")
GRAIN_RADIUS = constant("grain_radius", "m", "radius of a grain", "grainRadius")
MET = one("met", "", "whether the aggregates touched", met, kind="b")
CLOSURE = one("closure", "", "largest error of the energy ledger over K(0)", lambda run: closure(run.history))
END = one("time", "s", "time at the end", lambda run: float(run.history["time"][-1]))

# The constants that tell grains apart.
GRAINS = (
    constant("grainRadius", "m", "radius of a grain"),
    constant("young", "Pa", "Young's modulus"),
    constant("poisson", "", "Poisson's ratio"),
    constant("density", "kg/m^3", "density of a grain"),
    constant("surfaceEnergy", "J/m^2", "gamma"),
    constant("criticalRolling", "m", "xi_crit"),
    parameter("slidingStiffnessFactor", "", "k_s over Wada's", usual=1.0),
)
OF_GRAINS = tuple(column.name for _, columns in GRAINS for column in columns)
# Kataoka et al. (2013), Table 1 and section 2.1; its ice is that of Arakawa et al. (2022, 2024) too.
PAPERS = {name: dict(zip(OF_GRAINS, (RADII[name], *astuple(own)[:5], 1.0))) for name, own in MATERIALS.items()}


def other_grains(parameters, but=()):
    """['young = 5.4e+10', ...] of what differs from the papers' grains of a material, parameters: a mapping with
    material and OF_GRAINS, but for the names `but`; all of a material that they do not have."""
    theirs = PAPERS.get(parameters["material"], {})
    names = [n for n in OF_GRAINS if n not in but and not (n in theirs and same(parameters[n], theirs[n]))]
    return [f"{name} = {parameters[name]:g}" for name in names]


def require_papers_grains(run, but=()):
    """NotMeasured for a RunFolder of other grains: a study without grains in its key would take them for the
    paper's."""
    others = other_grains({"material": run.parameters["material"], **row_of(GRAINS, run)}, but)
    if others:
        raise NotMeasured(f"{run.path}: other grains than the paper's ({', '.join(others)})")


def grains_text(parameters, but=()):
    """The material, and in brackets what differs from the papers' grains of it."""
    others = other_grains(parameters, but)
    return parameters["material"] + (f" ({', '.join(others)})" if others else "")


outcome_of = lru_cache(maxsize=1)(outcome_of_run)  # several columns need that of the same run


def _outcome(run, row):
    outcome, v = outcome_of(run), run.history["v"]
    return outcome.kind, outcome.restitution, float(np.nan_to_num(v[-1] / row["velocity"]) ** 2)


OUTCOME = group(
    _outcome,
    Column("outcome", "", "as measures.outcome has it", kind="O"),
    Column("restitution", "", "none for fragmentation and for pieces that passed each other", gaps=True),
    Column("bulk", "", "(v/v_col)^2 at the end: the fraction of K(0) in the motion of the halves"),
)
_largest = lambda run: float(outcome_of(run).mass_fractions[0])
LARGEST = one("largest_fraction", "", "fraction of the mass in the largest piece", _largest)
