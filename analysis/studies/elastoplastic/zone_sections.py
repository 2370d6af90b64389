"""What the packings explain of d_max, and what they predicted of it: sections of the report."""

from ...report.section import Column, Section
from ...statistics import student_chance
from . import paper, prediction
from .beside_model import papers_model
from .lines import paper_line_at
from .zone_fit import COVARIATES, fit_slope

ZONE, RIGID = (name for name, column in COVARIATES.items() if column in ("zone_filling", "rigid_touch"))


def zone_sections(results):
    """Sections: what each covariate explains, the means of d_max and t_max adjusted for the filling of the zones, predictions
    beside runs."""
    rows = tuple(_explained(results))
    if rows:
        yield Section("what explains the scatter of d_max", _EXPLAINED, rows, intro=_EXPLAINED_INTRO)
        yield Section(
            "largest compression adjusted for the filling of the zones",
            _ADJUSTED,
            tuple(_adjusted(results)),
            intro=_ADJUSTED_INTRO,
        )
    times = tuple(_adjusted_times(results))
    if times:
        yield Section(
            "time of the largest compression adjusted for the filling of the zones", _TIMES, times, intro=_TIMES_INTRO
        )
    rows = tuple(_at_velocities(results))
    if rows:
        yield Section("what explains d_max at other velocities", _AT_VELOCITIES, rows, intro=_AT_VELOCITIES_INTRO)
    compared = tuple(_predicted(results))
    if compared:
        yield Section("largest compression predicted beforehand", _PREDICTED, compared, intro=_PREDICTED_INTRO)


_EXPLAINED_INTRO = (
    "At the velocity of the size fit, about the means of each size; errors by resampling pairs. explained: fraction of the "
    "variance of d_max, less what a covariate of no use would take (it can be negative). worth: how many seeds without the "
    "covariate one with it is worth. slope: of d_max on R times the covariate (on the offset itself). The zone was chosen on "
    "these pairs: what it explains of them flatters it."
)
_ADJUSTED_INTRO = (
    "Lengths in grain radii. zone: mean filling of the two zones that meet, less that of the aggregates. adjusted: read off "
    "where both are equal, with the common slope and the common scatter about it."
)
_TIMES_INTRO = (
    "At the velocity of the size fit, less A24's fitted model, with A24's delta_offset. correlation, explained: of t_max and the "
    "filling of the zones about the means of each size, as for d_max. p: Student's t with the degrees of freedom of the scatter "
    "about the slope; A24's errors not counted."
)
_AT_VELOCITIES_INTRO = (
    "Correlation with d_max about the means of each size, errors by resampling pairs. The rows of one filling are the same pairs: one "
    "statement, not several."
)
_PREDICTED_INTRO = (
    "Files of predictions, written before these pairs were run, beside their runs as far as they are in the table. within: in the "
    "95 % interval; gain: mean square error without the covariate over that with it; bias: measured less predicted."
)
_EXPLAINED = (
    Column("filling", lambda b: f"{b['filling']:g}"),
    Column("covariate", lambda b: b["covariate"]),
    Column("runs", lambda b: str(b["runs"])),
    Column("correlation", lambda b: f"{b['correlation'][0]:.2f} +- {b['correlation'][1]:.2f}"),
    Column("by size", lambda b: b["by_size"]),
    Column("explained", lambda b: f"{100 * b['explained']:.0f} %"),
    Column("slope", lambda b: f"{b['slope'][0]:.3f} +- {b['slope'][1]:.3f}"),
    Column("scatter [r]", lambda b: f"{b['scatter']:.3f} of {b['total']:.3f}"),
    Column("worth", lambda b: f"{b['worth']:.1f}"),
)
_ADJUSTED = (
    Column("filling", lambda b: f"{b['filling']:g}"),
    Column("R [r]", lambda b: f"{b['radius']:g}"),
    Column("seeds", lambda b: str(b["seeds"])),
    Column(
        "zone [%]",
        lambda b: f"{100 * b['zone']:+.1f}" + (f" +- {100 * b['zone_error']:.1f}" if b["zone_error"] else ""),
    ),
    Column("d_max", lambda b: f"{b['mean']:.3f} +- {b['error']:.3f}"),
    Column("adjusted", lambda b: f"{b['adjusted']:.3f} +- {b['adjusted_error']:.3f}"),
    Column("paper's line", lambda b: "-" if b["paper"] is None else f"{b['paper']:.3f} +- {b['paper_error']:.3f}"),
    Column("diff*", lambda b: _both(b, "mean", "error")),
    Column("adjusted diff*", lambda b: _both(b, "adjusted", "adjusted_error")),
)
_TIMES = (
    Column("filling", lambda b: f"{b['filling']:g}"),
    Column("R [r]", lambda b: f"{b['radius']:g}"),
    Column("seeds", lambda b: str(b["seeds"])),
    Column("correlation", lambda b: f"{b['of_all'][0]:.2f} +- {b['of_all'][1]:.2f}"),
    Column("explained", lambda b: f"{100 * b['explained']:.0f} %"),
    Column("t_max less A24's model [ns]", lambda b: f"{b['mean'] - b['model']:+.1f} +- {b['error']:.1f}"),
    Column("adjusted", lambda b: f"{b['adjusted'] - b['model']:+.1f} +- {b['adjusted_error']:.1f}"),
    Column("p", lambda b: f"{b['chance']:.2g}"),
)
_AT_VELOCITIES = (
    Column("filling", lambda b: f"{b['filling']:g}"),
    Column("velocity [m/s]", lambda b: f"{b['velocity']:.3g}"),
    Column("runs", lambda b: str(b["runs"])),
    *(
        Column(name, lambda b, name=name: "-" if b[name] is None else f"{b[name][0]:.2f} +- {b[name][1]:.2f}")
        for name in (ZONE, RIGID)
    ),
)
_PREDICTED = (
    Column("file", lambda b: b["file"]),
    Column("filling", lambda b: f"{b['filling']:g}"),
    Column("R [r]", lambda b: f"{b['radius']:g}"),
    Column("predicted", lambda b: str(b["predicted"])),
    Column("run", lambda b: str(b["run"])),
    Column("within", lambda b: "-" if b["within"] is None else str(b["within"])),
    Column("gain", lambda b: "-" if b["gain"] is None else f"{b['gain']:.2f}"),
    Column("correlation", lambda b: "-" if b["correlation"] is None else f"{b['correlation']:.2f}"),
    Column("bias [r]", lambda b: "-" if b["bias"] is None else f"{b['bias']:+.3f}"),
)


def _explained(results):
    for factor, filling in results.by_filling.items():
        sizes = ", ".join(f"{a.correlation:.2f}" if a.correlation is not None else "-" for a in filling.adjusted)
        for number, (name, slope) in enumerate(filling.covariates.items()):
            if slope is None:
                continue
            yield {
                "filling": factor,
                "covariate": name,
                "runs": slope.runs,
                "correlation": (slope.correlation, slope.correlation_error),
                "by_size": "" if number else sizes,
                "explained": slope.explained,
                "slope": (slope.slope, slope.slope_error),
                "scatter": slope.scatter,
                "total": slope.total,
                "worth": slope.worth,
            }


def _at_velocities(results):
    """Correlations at each velocity but that of the size fit, where enough pairs have run."""
    runs = results.table.assign(at=results.table.velocity.map(lambda v: float(f"{v:.6g}")))
    for (factor, velocity), own in runs.groupby([runs["filling"].round(6), "at"]):
        if abs(velocity / paper.VELOCITY - 1.0) < 1e-3:
            continue
        slopes = {name: fit_slope(own, COVARIATES[name]) for name in (ZONE, RIGID)}
        found = {n: (s.correlation, s.correlation_error) if s else None for n, s in slopes.items()}
        if any(found.values()):
            yield {"filling": factor, "velocity": velocity, "runs": len(own), **found}


def _predicted(results):
    """Records of prediction.Comparison of each set's file, of the fillings that have run."""
    for each in prediction.SETS:
        predictions = prediction.read(each.path)
        if predictions is not None:
            predictions = predictions[predictions.filling.round(6).isin(list(results.by_filling))]
            for compared in prediction.compare(predictions, results.table) if len(predictions) else ():
                yield {"file": each.file, **vars(compared)}


def _adjusted(results):
    for factor, filling in results.by_filling.items():
        for each in filling.adjusted:
            theirs, error = paper_line_at(filling, each.radius)
            yield {"filling": factor, **vars(each), "paper": theirs, "paper_error": error}


def _adjusted_times(results):
    for factor, filling in results.by_filling.items():
        slope, sizes = filling.zone_times
        for each in sizes if factor in paper.YOUNG else ():
            model = 1e9 * papers_model(results, filling, each.radius, filling.size_fit.velocity)[1]
            chance = student_chance((each.adjusted - model) / each.adjusted_error, slope.freedom)
            own = {
                "of_all": (slope.correlation, slope.correlation_error),
                "explained": slope.explained,
                "chance": chance,
            }
            yield {"filling": factor, **vars(each), **own, "model": float(model), "units": "grain radii, ns"}


def _both(row, mean, error):
    if row["paper"] is None:
        return "-"
    both = (row[error] ** 2 + (row["paper_error"] or 0.0) ** 2) ** 0.5
    return f"{(row[mean] - row['paper']) / both:+.1f}"
