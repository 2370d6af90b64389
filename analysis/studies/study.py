"""A study: which runs count, what is measured of each, numbers beside a paper's, figures. One module here each, named
as the study, defines STUDY; so does a file of one's own."""

from dataclasses import dataclass, replace
from importlib import import_module
from pathlib import Path
from runpy import run_path
from typing import Callable

from ..printable import Refused, suggested
from ..runs.format import COLLISION, PARAMETER_WORDS, same
from .columns import LARGEST, OUTCOME, VELOCITY, NotMeasured, parameter, row_of

NAMES = tuple("atlas axes compaction compressed compression elastoplastic formulas sintered viscous".split())
GALLERY = Path(__file__).resolve().parents[1] / "gallery"


@dataclass(frozen=True)
class Study:
    """What a module defines as STUDY.

    Parameters
    ----------
    values : dict
        Parameters that every run has.
    key : tuple of str
        Columns that tell two runs apart.
    measured : tuple of columns.group()
        What is measured of a run: the columns of runs.csv.
    pair : tuple of str
        Columns that tell independent pairs of aggregates apart.
    rows : callable
        From the table of runs to the comparison.Rows of the page.
    figures : callable, optional
        From the same to (name, caption, matplotlib Figure or None) of each figure.
    prepared : callable, optional
        From the table of runs with the column `pair` to the one that rows and figures get.
    independent : str
        What counts as one in errors, in the plural.
    kind : str
        Of run.
    alike : bool
        Whether runs that differ in parameters beside the key's are refused together.
    """

    title: str
    question: str
    values: dict
    key: tuple
    measured: tuple
    pair: tuple
    rows: Callable
    figures: Callable = lambda runs: ()
    prepared: Callable = lambda runs: runs
    independent: str = "pairs"
    kind: str = COLLISION.name
    alike: bool = False
    name: str = ""

    @property
    def columns(self):
        """(runs.table.Column, ...) of the table."""
        return tuple(column for _, columns in self.measured for column in columns)

    def require(self, run):
        """NotMeasured for a RunFolder that is none of this study's."""
        if run.kind.name != self.kind:
            raise NotMeasured(f"{run.path}: it is a run of the kind {run.kind.name}, the study is of {self.kind}s")
        for name, wanted in self.values.items():
            found = run.parameters.get(name, wanted)
            if not same(found, wanted):
                raise NotMeasured(f"{run.path}: {name} = {found}, the study has {wanted}")

    def measure(self, run):
        """{column: value} of a RunFolder; NotMeasured or RunFolderError where a column can't be measured."""
        return row_of(self.measured, run)

    def runs(self, table):
        """The table that rows and figures get."""
        pair = table.groupby(list(self.pair), sort=False, dropna=False).ngroup()
        return self.prepared(table.assign(pair=pair))


def collision_study(title, question, varied, rows, figures=lambda runs: (), pair=None, **values):
    """Study of a question of one's own about collisions.

    Parameters
    ----------
    varied : tuple of str
        Parameters that differ from run to run, the seed among them. Runs that differ in others are refused together.
    rows, figures : callable
        As in Study; a row has the parameters varied, `velocity`, columns.OUTCOME and columns.LARGEST.
    pair : tuple of str, optional
        Columns that tell pairs of aggregates apart; without it all of varied but the velocity.
    **values
        Parameters that every run has.
    """
    kinds = {name: "O" if name in PARAMETER_WORDS else "f" for name in varied}
    parameters = [parameter(name, "", "as the table of runs has it", kind) for name, kind in kinds.items()]
    measured = (*parameters, *(() if "velocity" in varied else (VELOCITY,)), OUTCOME, LARGEST)
    pair = pair or tuple(name for name in varied if name != "velocity")
    return Study(title, question, values, tuple(varied), measured, pair, rows, figures, alike=True)


def find(name):
    """Study of that name, or of a file NAME.py that defines STUDY; Refused."""
    if name.endswith(".py"):
        file = Path(name)
        if not file.is_file():
            raise Refused(f"{file}: no such file")
        defined = run_path(str(file), run_name=f"own_study_{file.stem}")
        if "STUDY" not in defined:
            raise Refused(f"{file}: defines no STUDY; must be as analysis/STUDIES.md says")
        return replace(defined["STUDY"], name=file.stem)
    if name not in NAMES:
        raise Refused(f"no study {name}{suggested(name, NAMES)}, or a file NAME.py of one's own")
    return replace(import_module(f"..{name}", __name__).STUDY, name=name)
