"""Does drag explain a difference from A24? The same pairs of aggregates with and without it, compared pair by pair, so that
what differs from pair to pair drops out."""

from dataclasses import dataclass

import numpy as np

from ...report.section import Column as Shown
from ...report.section import Section
from ...runs.arrays import RunFolderError
from ...runs.collect import Scene
from ...runs.table import Column, read_table
from ...statistics import mean_and_error, student_chance
from ..definition import Study
from ..elastoplastic import measure as without_drag
from ..elastoplastic.prediction import GALLERY

_DRAG = Column("viscoelasticTime", "s", "T_vis of the viscous drag")
_PAIR = ("filling", "radius", "velocity", "seed")


@dataclass(frozen=True)
class Difference:
    """Runs with one T_vis [s] less the same pairs without drag: filling, radius [grain radii], velocity [m/s], runs with this
    drag, pairs (those with a twin without); d_max [grain radii] and t_max [s]: (mean, standard error, chance by Student's t) of
    the paired differences; Nones without two pairs."""

    filling: float
    radius: float
    velocity: float
    viscoelasticTime: float
    runs: int
    pairs: int
    d_max: tuple
    t_max: tuple


def measure(run):
    """What the study of collisions without drag measures of a RunFolder, and T_vis."""
    try:
        drag = float(run.parameters.get("viscoelasticTime", 0.0))
    except (TypeError, ValueError):
        raise RunFolderError(f"{run.path}: cannot be measured: viscoelasticTime is no number") from None
    return {**without_drag.measure(run), "viscoelasticTime": drag}


def results(table):
    """[Difference] of a table of runs. A twin without drag is taken from it, or else from the gallery's table of runs."""
    twins = {_pair(row): row for row in _gallery()}
    twins.update({_pair(row): row for row in table[table.viscoelasticTime == 0].itertuples()})
    found, scenes = [], ["filling", "radius", "velocity", "viscoelasticTime"]
    for _, runs in table[table.viscoelasticTime > 0].groupby(scenes):
        rows = list(runs.itertuples())
        both = [(row, twins[_pair(row)]) for row in rows if _pair(row) in twins]
        first = rows[0]
        found.append(
            Difference(
                round(first.filling, 6),
                round(first.radius / first.grain_radius, 3),
                first.velocity,
                first.viscoelasticTime,
                len(rows),
                len(both),
                _difference([(a.d_max - b.d_max) / a.grain_radius for a, b in both]),
                _difference([a.t_max - b.t_max for a, b in both]),
            )
        )
    return found


def _gallery():
    return (
        read_table(GALLERY / "runs.csv", without_drag.COLUMNS)[0].itertuples()
        if (GALLERY / "runs.csv").exists()
        else ()
    )


def _pair(row):
    return tuple(f"{getattr(row, name):.6g}" for name in _PAIR)


def _difference(values):
    if len(values) < 2:
        return None, None, None
    mean, error = mean_and_error(np.array(values))
    return mean, error, student_chance(mean / error, len(values) - 1) if error else None


def sections(differences):
    """The one Section."""
    columns = (
        Shown("filling", lambda b: f"{b['filling']:g}"),
        Shown("R [r]", lambda b: f"{b['radius']:g}"),
        Shown("v [m/s]", lambda b: f"{b['velocity']:.4g}"),
        Shown("T_vis [ps]", lambda b: f"{1e12 * b['viscoelasticTime']:g}"),
        Shown("runs", lambda b: str(b["runs"])),
        Shown("pairs", lambda b: str(b["pairs"])),
        Shown("d_max [r]", lambda b: _shown(b["d_max"], 1.0, 3)),
        Shown("p", lambda b: _chance(b["d_max"])),
        Shown("t_max [ns]", lambda b: _shown(b["t_max"], 1e9, 2)),
        Shown("p", lambda b: _chance(b["t_max"])),
    )
    intro = (
        "Runs with drag less the same pairs without it: mean of the paired differences with its standard error, and the chance "
        "of as much by Student's t."
    )
    yield Section("with drag less without", columns, tuple(vars(each) for each in differences), intro=intro)


def _shown(values, scale, digits):
    mean, error, _ = values
    return "-" if mean is None else f"{scale * mean:+.{digits}f} +- {scale * error:.{digits}f}"


def _chance(values):
    return "-" if values[2] is None else f"{values[2]:.2g}"


STUDY = Study(
    question="Does viscous drag between grains explain where the collisions of the study elastoplastic differ from Arakawa et al. (2024)? "
    "The same pairs of aggregates with and without it.",
    title="Elastoplastic collisions with drag beside the same without",
    scene=Scene(
        name="A24's scene with drag",
        values={"packing": "cpe", "impact": 0.0, "neck": 0.0, "planar": 0, "material": "ice"},
        numbers=("filling", "radius", "velocity", "seed", "viscoelasticTime"),
    ),
    columns=(_DRAG, *without_drag.COLUMNS),
    measure=measure,
    results=results,
    sections=sections,
)
