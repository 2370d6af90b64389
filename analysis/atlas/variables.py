"""The coordinates without dimensions of a table of runs, and which of its rows count."""

import numpy as np
import pandas

from ..measures.outcome import NEVER_MET, UNDECIDED

FEATURES = ("velocity", "grains", "mass_ratio", "filling", "impact_square")
FIT, HELD_OUT = "fit", "held_out"  # of the column `split`
CHOSEN = range(3_000, 10_000)  # `number` of the rows that were chosen by a model
OFFSETS = (np.arange(8) + 0.5) / 8  # b^2 over its largest, of averages
FOLDS, SEED = 5, 1  # of cross-validation
LEFT = ("largest", "second", "fragment_index", "filling_after")
# Each has a model and tables of its own: of the same filling, close-packed aggregates bounce several times as often.
STRUCTURES = {"grown": ("bcca", "bpca", "compressed"), "close-packed": ("cpe",)}
GROWN, CLOSE_PACKED = STRUCTURES


def variables(table):
    """DataFrame (n rows) of FEATURES of a table of runs: velocity over v_break, grains of the larger aggregate, mass ratio, filling (mean by
    mass of both), square of the impact parameter."""
    share = 1 / (1 + table.mass_ratio)
    return pandas.DataFrame(
        {
            "velocity": table.velocity / table.v_break,
            "grains": table.grains_target,
            "mass_ratio": table.mass_ratio,
            "filling": share * table.filling_target + (1 - share) * table.filling_projectile,
            "impact_square": table.impact**2,
        }
    )


def scaled(points):
    """Coordinates (n, 5) of variables() in which the model works: logarithms of the first three."""
    points = points[list(FEATURES)].to_numpy(dtype=float)
    return np.column_stack([np.log(points[:, :3]), points[:, 3:]])


def offsets(coordinates, upto=None):
    """[coordinates (n, 5)] of scaled() at each impact parameter of an average uniform in b^2 up to `upto`; None: as they are."""
    if upto is None:
        return [coordinates]
    return [np.column_stack([coordinates[:, :-1], np.full(len(coordinates), square)]) for square in upto * OFFSETS]


def energy(points):
    """Kinetic energy of the impact over E_break (n,) of variables() points.

    >>> energy(pandas.DataFrame({"velocity": [2.0], "grains": [100], "mass_ratio": [1.0]})).tolist()
    [100.0]
    """
    return points.grains * points.mass_ratio / (1 + points.mass_ratio) * points.velocity**2 / 2


def folds(number):
    """[(rows of the others, rows)] of FOLDS parts of so many rows, drawn at random."""
    parts = np.array_split(np.random.default_rng(SEED).permutation(number), FOLDS)
    return [(np.concatenate([part for part in parts if part is not own]), own) for own in parts]


def drawn(table):
    """The rows that were drawn without regard to the model: their fractions are those of the space that they were drawn from. All others, the
    rows of CHOSEN that are not held out, are where a model was the least sure."""
    return table[~table.number.isin(CHOSEN) | (table.split == HELD_OUT)]


def of_structure(table, structure):
    """The rows of one of STRUCTURES."""
    return table[table.structure.isin(STRUCTURES[structure])]


def touching(table):
    """The rows whose aggregates touched."""
    return table[table.outcome != NEVER_MET]


def decided(table):
    """The rows that anything may be fitted to or judged by: aggregates that touched, with a decided outcome."""
    return table[~table.outcome.isin([NEVER_MET, UNDECIDED])]


def fit_and_held_out(table):
    """The decided() rows that a model may be fitted to, and those held out."""
    own = decided(table)
    return (own[(own.split == FIT) == is_fit].reset_index(drop=True) for is_fit in (True, False))


def left(table):
    """DataFrame of LEFT of a table of runs."""
    return table.rename(columns={"filling_largest": "filling_after"})[list(LEFT)]
