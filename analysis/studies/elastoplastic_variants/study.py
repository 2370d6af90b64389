"""Does what A24's text leaves open explain a difference from it? Drag left on, grains outside the largest piece left out,
neighbours that start without overlap: the same pairs of aggregates with one of these changed and without, compared pair by
pair, so that what differs from pair to pair drops out."""

from dataclasses import dataclass

import numpy as np

from ...report.section import Column as Shown
from ...report.section import Section
from ...runs.arrays import RunFolderError
from ...runs.collect import Scene
from ...runs.table import Column, read_table
from ...statistics import mean_and_error, student_chance
from ..collision_points import HEAD_ON_ICE
from ..definition import Study
from ..elastoplastic import measure as unchanged
from ..elastoplastic.prediction import GALLERY

VARIANTS = (
    Column("viscoelasticTime", "s", "T_vis of the viscous drag"),
    Column("removeLooseGrains", "1", "1: grains outside the largest piece are left out"),
    Column("initialOverlap", "1", "overlap of neighbours at the start, of that at rest"),
)
NAMES = tuple(column.name for column in VARIANTS)
UNCHANGED = (0.0, 0.0, 1.0)  # of VARIANTS: the runs of the study elastoplastic
_SCENE = ("filling", "radius", "velocity")


@dataclass(frozen=True)
class Difference:
    """Runs of one variant less the same pairs unchanged: filling, radius [grain radii], velocity [m/s], variant (values of
    VARIANTS), runs of it, pairs (those with an unchanged twin); d_max [grain radii] and t_max [s]: (mean, standard error,
    chance by Student's t) of the paired differences; Nones without two pairs."""

    filling: float
    radius: float
    velocity: float
    variant: tuple
    runs: int
    pairs: int
    d_max: tuple
    t_max: tuple

    @property
    def record(self):
        """All of it as a dict, a key for each of VARIANTS."""
        values = dict(vars(self))
        return {**dict(zip(NAMES, values.pop("variant"))), **values}


def measure(run):
    """What the study elastoplastic measures of a RunFolder, and VARIANTS; runs of earlier versions have no key for what was
    not there to be changed."""
    values = {}
    for name, usual in zip(NAMES, UNCHANGED):
        try:
            values[name] = float(run.parameters.get(name, usual))
        except (TypeError, ValueError):
            raise RunFolderError(f"{run.path}: cannot be measured: {name} is no number") from None
    return {**unchanged.measure(run), **values}


def results(table):
    """[Difference] of a table of runs. An unchanged twin is taken from it, or else from the gallery's table of runs."""
    variant = [tuple(row) for row in table[list(NAMES)].to_numpy(dtype=float).round(15)]
    usual = np.array([row == UNCHANGED for row in variant], dtype=bool)
    twins = {_pair(row): row for row in _gallery()}
    twins.update({_pair(row): row for row in table[usual].itertuples()})
    found = []
    for _, runs in table[~usual].groupby([*_SCENE, *NAMES]):
        rows = list(runs.itertuples())
        both = [(row, twins[_pair(row)]) for row in rows if _pair(row) in twins]
        first = rows[0]
        found.append(
            Difference(
                round(first.filling, 6),
                round(first.radius / first.grain_radius, 3),
                first.velocity,
                tuple(float(getattr(first, name)) for name in NAMES),
                len(rows),
                len(both),
                _difference([(a.d_max - b.d_max) / a.grain_radius for a, b in both]),
                _difference([a.t_max - b.t_max for a, b in both]),
            )
        )
    return found


def _gallery():
    file = GALLERY / "runs.csv"
    return read_table(file, unchanged.COLUMNS)[0].itertuples() if file.exists() else ()


def _pair(row):
    return tuple(f"{getattr(row, name):.6g}" for name in (*_SCENE, "seed"))


def _difference(values):
    if len(values) < 2:
        return None, None, None
    mean, error = mean_and_error(np.array(values))
    return mean, error, student_chance(mean / error, len(values) - 1) if error else None


def _changed(record):
    """What differs from the unchanged runs, in words."""
    drag, remove, overlap = (record[name] for name in NAMES)
    parts = [f"T_vis = {1e12 * drag:g} ps"] if drag else []
    parts += ["loose grains left out"] if remove else []
    parts += [f"initial overlap {overlap:g}"] if overlap != 1 else []
    return ", ".join(parts)


def sections(differences):
    """The one Section."""
    columns = (
        Shown("filling", lambda b: f"{b['filling']:g}"),
        Shown("R [r]", lambda b: f"{b['radius']:g}"),
        Shown("v [m/s]", lambda b: f"{b['velocity']:.4g}"),
        Shown("changed", _changed),
        Shown("runs", lambda b: str(b["runs"])),
        Shown("pairs", lambda b: str(b["pairs"])),
        Shown("d_max [r]", lambda b: _shown(b["d_max"], 1.0, 3)),
        Shown("p", lambda b: _chance(b["d_max"])),
        Shown("t_max [ns]", lambda b: _shown(b["t_max"], 1e9, 2)),
        Shown("p", lambda b: _chance(b["t_max"])),
    )
    intro = (
        "Runs with a change less the same pairs without it: mean of the paired differences with its standard error, and the "
        "chance of as much by Student's t."
    )
    yield Section("changed less unchanged", columns, tuple(each.record for each in differences), intro=intro)


def _shown(values, scale, digits):
    mean, error, _ = values
    return "-" if mean is None else f"{scale * mean:+.{digits}f} +- {scale * error:.{digits}f}"


def _chance(values):
    return "-" if values[2] is None else f"{values[2]:.2g}"


STUDY = Study(
    question="Does what the text of Arakawa et al. (2024) leaves open explain where the collisions of the study elastoplastic differ "
    "from it: drag between grains, grains outside the largest piece, neighbours without overlap? The same pairs of aggregates, "
    "changed and unchanged.",
    title="Elastoplastic collisions with one thing changed beside the same without",
    scene=Scene(
        name="A24's scene and its variants",
        values={"packing": "cpe", **{name: value for name, value in HEAD_ON_ICE.items() if name not in NAMES}},
        numbers=("filling", "radius", "velocity", "seed"),
        measured=NAMES,
    ),
    columns=(*VARIANTS, *unchanged.COLUMNS),
    measure=measure,
    results=results,
    sections=sections,
)
