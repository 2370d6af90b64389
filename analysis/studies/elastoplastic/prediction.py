"""d_max predicted from packings alone, before the pairs are run, and compared with the runs when they are there.

The predictions stand in files of gallery/elastoplastic, which were committed before the runs: what is compared is these,
never a fit that has seen the new runs."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas

from ...runs.write import write_text
from ...statistics import CONFIDENCE, student
from . import paper
from .zone_fit import LENGTHS, Slope, fit_slope, in_grain_radii

GALLERY = Path(__file__).resolve().parents[2] / "gallery" / "elastoplastic"


@dataclass(frozen=True)
class Set:
    """Pairs that are predicted together: file (of GALLERY), covariate (a column of start.COLUMNS), velocity [m/s], radius [grain
    radii], seeds. In no table before, and not run before the predictions were committed."""

    file: str
    covariate: str
    velocity: float
    radius: int
    seeds: range

    @property
    def path(self):
        return GALLERY / self.file


SETS = (
    Set("predictions.csv", "zone_filling", paper.VELOCITY, 60, range(101, 109)),
    Set("predictions_slow.csv", "rigid_touch", 1.0, 40, range(201, 211)),
    Set("predictions_large.csv", "zone_filling", paper.VELOCITY, 80, range(4, 11)),
)
FILLINGS = (0.4, 0.3)
_HEAD = """\
# d_max predicted from the packings alone, before these pairs were run: d_max = mean + b (x - mean x), x = {covariate}{times},
# means of the runs of the same filling, radius and velocity, b the common slope of all sizes (zone_fit).
# d_max_plain: that mean, the prediction without the covariate. Errors: standard errors of prediction of one run (scatter of a
# run, of the mean, of the slope), Student's t with `freedom` degrees of freedom. Lengths in m, velocity in m/s.
# Made from {runs} runs by: python3 yade_scripts/studies/elastoplastic_packings.py predict runs.csv {file}
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
    "rigid_touch",
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
    """What predictions of one filling and velocity [m/s] are made from: the covariate, slope (zone_fit.Slope) and, by radius
    [grain radii], the number of runs and the means of the covariate and of d_max [grain radii]; grain_radius [m]."""

    covariate: str
    velocity: float
    slope: Slope
    means: dict
    grain_radius: float

    def away(self, radius, x):
        """How far values x of the covariate lie from its mean at a radius [grain radii], as the slope takes it: in grain radii."""
        difference, unit = x - self.means[radius][1], self.grain_radius
        return in_grain_radii(difference, self.covariate, radius * unit, unit)


def before(table, chosen):
    """Rows of a table of runs (DataFrame of measure.COLUMNS) without the pairs of a Set: what its predictions may know."""
    radius = (table.radius / table.grain_radius).round(3)
    return table[~(table.seed.isin(chosen.seeds) & (radius == chosen.radius))]


def fit(table, filling, velocity=paper.VELOCITY, covariate="zone_filling"):
    """Model from a table of runs (DataFrame of measure.COLUMNS); ValueError where it does not have enough of them."""
    runs = table[(table.filling.round(6) == filling) & ((table.velocity / velocity - 1.0).abs() < 1e-3)]
    slope = fit_slope(runs, covariate)
    if slope is None:
        raise ValueError(f"too few runs at filling {filling:g} and {velocity:.4g} m/s to predict from")
    groups = runs.groupby((runs.radius / runs.grain_radius).round(3))
    means = {
        float(r): (len(g), float(g[covariate].mean()), float((g.d_max / g.grain_radius).mean())) for r, g in groups
    }
    return Model(covariate, float(runs.velocity.iloc[0]), slope, means, float(runs.grain_radius.iloc[0]))


def predict(model, radius, x):
    """{column: value} of the predicted d_max [m] of a pair of aggregates of a radius [grain radii] with the value x of the
    covariate, and of the prediction without it. KeyError where the model has no runs of that radius."""
    n, _, mean = model.means[radius]
    slope, away, unit = model.slope, model.away(radius, x), model.grain_radius
    error = np.sqrt(slope.scatter**2 * (1.0 + 1.0 / n) + (away * slope.slope_error) ** 2)
    return {
        "d_max": unit * (mean + slope.slope * away),
        "d_max_error": unit * float(error),
        "d_max_plain": unit * mean,
        "d_max_plain_error": unit * float(slope.total * np.sqrt(1.0 + 1.0 / n)),
        "freedom": slope.freedom,
    }


def predict_mean(model, radius, x):
    """((mean, error) predicted, (mean, error) without the covariate) [grain radii] of the mean d_max of pairs of one radius
    [grain radii] with these values (n,) of the covariate; errors of the difference between that and the mean of their runs."""
    n, _, mean = model.means[radius]
    slope, new = model.slope, len(x)
    away = model.away(radius, float(np.mean(x)))
    spread = np.sqrt(1.0 / new + 1.0 / n)
    error = np.hypot(slope.scatter * spread, away * slope.slope_error)
    return (mean + slope.slope * away, float(error)), (mean, float(slope.total * spread))


def write(file, rows, runs, means, covariate):
    """Write predictions ({column: value} of COLUMNS) made from so many runs as a CSV file; means: {filling: what predict_mean
    says of them}."""
    times = "" if covariate in LENGTHS else " R"
    head = _HEAD.format(runs=runs, file=Path(file).name, covariate=covariate, times=times)
    for filling, ((mean, error), (plain, plain_error)) in means.items():
        head += f"# filling {filling:g}: {mean:.3f} +- {error:.3f}; without the covariate {plain:.3f} +- {plain_error:.3f}\n"
    body = pandas.DataFrame(rows)[list(COLUMNS)].to_csv(index=False, lineterminator="\n", float_format=_DIGITS)
    write_text(file, head + body)


def read(file):
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
