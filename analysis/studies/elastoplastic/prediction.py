"""d_max predicted from packings alone, before the pairs are run, and compared with the runs when they are there.

The predictions stand in gallery/elastoplastic/predictions.csv, which was committed before the runs: what is compared is
that file, never a fit that has seen the new runs."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas

from ...statistics import CONFIDENCE, student
from . import paper
from .zone_fit import Slope, fit_slope

GALLERY = Path(__file__).resolve().parents[2] / "gallery" / "elastoplastic"
PREDICTIONS = GALLERY / "predictions.csv"
_HEAD = """\
# d_max predicted from the packings alone, before these pairs were run: d_max = mean + R b (zone_filling - mean zone_filling),
# mean and mean zone_filling of the runs of the same filling, radius and velocity, b the common slope of all sizes (zone_fit).
# d_max_plain: that mean, the prediction without the covariate. Errors: standard errors of prediction of one run (scatter of a
# run, of the mean, of the slope), Student's t with `freedom` degrees of freedom. Lengths in m, velocity in m/s.
# Made from {runs} runs by: python3 yade_scripts/studies/elastoplastic_packings.py predict runs.csv predictions.csv
# Mean of these pairs, with the standard error that the mean of their runs should have about it [grain radii]:
"""
_DIGITS = "%.7g"
COLUMNS = (
    "filling",
    "radius",
    "velocity",
    "seed",
    "zone_filling",
    "bond_direction",
    "loose_grains",
    "offset",
    "d_max",
    "d_max_error",
    "d_max_plain",
    "d_max_plain_error",
    "freedom",
)


@dataclass(frozen=True)
class Model:
    """What predictions of one filling and velocity [m/s] are made from: slope (zone_fit.Slope) and, by radius [grain
    radii], the number of runs and the means of zone_filling and d_max [grain radii]; grain_radius [m]."""

    velocity: float
    slope: Slope
    means: dict
    grain_radius: float


def fit(table, filling, velocity=paper.VELOCITY):
    """Model from a table of runs (DataFrame of measure.COLUMNS); ValueError where it does not have enough of them."""
    runs = table[(table.filling.round(6) == filling) & ((table.velocity / velocity - 1.0).abs() < 1e-3)]
    slope = fit_slope(runs)
    if slope is None:
        raise ValueError(f"too few runs at filling {filling:g} and {velocity:.4g} m/s to predict from")
    groups = runs.groupby((runs.radius / runs.grain_radius).round(3))
    means = {
        float(r): (len(g), float(g.zone_filling.mean()), float((g.d_max / g.grain_radius).mean())) for r, g in groups
    }
    return Model(float(runs.velocity.iloc[0]), slope, means, float(runs.grain_radius.iloc[0]))


def predict(model, radius, zone_filling):
    """{column: value} of the predicted d_max [m] of a pair of aggregates of a radius [grain radii] with this filling of its
    zones, and of the prediction without it. KeyError where the model has no runs of that radius."""
    n, x_mean, mean = model.means[radius]
    slope, away, unit = model.slope, radius * (zone_filling - x_mean), model.grain_radius
    error = np.sqrt(slope.scatter**2 * (1.0 + 1.0 / n) + (away * slope.slope_error) ** 2)
    return {
        "d_max": unit * (mean + slope.slope * away),
        "d_max_error": unit * float(error),
        "d_max_plain": unit * mean,
        "d_max_plain_error": unit * float(slope.total * np.sqrt(1.0 + 1.0 / n)),
        "freedom": slope.freedom,
    }


def predict_mean(model, radius, zone_fillings):
    """((mean, error) predicted, (mean, error) without the covariate) [grain radii] of the mean d_max of pairs of one radius
    [grain radii] with these fillings of their zones; errors of the difference between that and the mean of their runs."""
    n, x_mean, mean = model.means[radius]
    slope, new = model.slope, len(zone_fillings)
    away = radius * (float(np.mean(zone_fillings)) - x_mean)
    spread = np.sqrt(1.0 / new + 1.0 / n)
    error = np.hypot(slope.scatter * spread, away * slope.slope_error)
    return (mean + slope.slope * away, float(error)), (mean, float(slope.total * spread))


def write(file, rows, runs, means):
    """Write predictions ({column: value} of COLUMNS) made from so many runs as a CSV file; means: {filling: what predict_mean
    says of them}."""
    head = _HEAD.format(runs=runs)
    for filling, ((mean, error), (plain, plain_error)) in means.items():
        head += f"# filling {filling:g}: {mean:.3f} +- {error:.3f}; without the zones' filling {plain:.3f} +- {plain_error:.3f}\n"
    body = pandas.DataFrame(rows)[list(COLUMNS)].to_csv(index=False, lineterminator="\n", float_format=_DIGITS)
    Path(file).write_text(head + body, encoding="utf-8")


def read(file=PREDICTIONS):
    """DataFrame of a file of predictions; None where there is none."""
    return pandas.read_csv(file, comment="#", float_precision="round_trip") if Path(file).exists() else None


@dataclass(frozen=True)
class Comparison:
    """Predictions of one filling and radius [grain radii] beside the runs that are there: predicted and run (numbers of
    pairs), within: how many lie within the 95 % interval, gain: mean square error of the plain prediction over that of the
    one with the covariate, correlation of measured d_max with predicted, bias: mean of measured less predicted [grain
    radii]. Nones where too few have run."""

    filling: float
    radius: float
    predicted: int
    run: int
    within: int = None
    gain: float = None
    correlation: float = None
    bias: float = None


def compare(predictions, table):
    """[Comparison] of each filling and radius of the predictions (DataFrame) against a table of runs."""
    found = []
    grain = float(table.grain_radius.iloc[0])
    for (filling, radius), rows in predictions.groupby(["filling", "radius"], sort=False):
        measured = [_measured(table, row) for row in rows.itertuples()]
        there = np.array([value is not None for value in measured])
        common = {
            "filling": filling,
            "radius": round(radius / grain, 3),
            "predicted": len(rows),
            "run": int(there.sum()),
        }
        if not there.any():
            found.append(Comparison(**common))
            continue
        d, own = np.array([value for value in measured if value is not None]), rows[there]
        reach = student.ppf(0.5 + 0.5 * CONFIDENCE, own.freedom) * own.d_max_error
        off, plain = d - own.d_max.to_numpy(), d - own.d_max_plain.to_numpy()
        found.append(
            Comparison(
                **common,
                within=int(np.sum(np.abs(off) <= reach)),
                gain=float(np.mean(plain**2) / np.mean(off**2)),
                correlation=float(np.corrcoef(d, own.d_max)[0, 1]) if len(d) > 2 else None,
                bias=float(off.mean() / grain),
            )
        )
    return found


def _measured(table, row):
    """d_max [m] of the run of a row of predictions, None where there is none."""
    same = (table.seed == row.seed) & (table.filling.round(6) == round(row.filling, 6))
    for name in ("radius", "velocity"):
        same &= (table[name] / getattr(row, name) - 1.0).abs() < 1e-6
    return float(table[same].d_max.iloc[0]) if same.any() else None
