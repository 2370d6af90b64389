"""The comparison as text, as Markdown and as JSON."""

import math

from ..channels import CHANNELS, LABELS
from .comparison import compare
from .measure import STILL_PARTING, UNDECIDED
from .points import RESAMPLES
from .provenance import provenance_lines

HEADS = ("quantity", "ours", "error", "paper", "diff", "diff*")
# A terminal is no wider than 160.
_SHORT = {
    **{c: c for c in CHANNELS},
    "slidingDissipation": "slid. diss.",
    "rollingDissipation": "roll. diss.",
    "twistingDissipation": "twist. diss.",
    "disconnection": "disconn.",
    "bondBreaking": "bonds",
}
LEGEND = (
    f"error: standard error from the scatter of the seeds (bootstrap, {RESAMPLES} resamples of the pairs of "
    "aggregates).",
    "diff: (ours - paper)/error. The paper gives no errors; its points scatter as ours, over ten seeds each.",
    "diff*: in units of both errors, the paper's estimated from our scatter (ten seeds at R = 40, 50, 60, 70, 80; for "
    "the moduli at R = 40, 80 and eight velocities).",
    "sigma_plastic and E*: least squares over delta_max and tau_max at all velocities, weight 1/s^2 of a run, s the "
    "standard deviation over the seeds of its point, smoothed over velocity.",
)
UNDECIDED_MEANS = (
    f"{UNDECIDED}: in one piece at the end, but parting at more than {STILL_PARTING:g} of the largest speed "
    "of the return; not counted, but by the interval of the sticking probability both ways; a longer duration "
    "decides"
)


def missing(study):
    """Lines that say what could not be fitted, and why, and what was decided."""
    for results in study.by_filling.values():
        for fit in (results.size_fit, results.velocity_fit):
            if fit.reason:
                yield f"not fitted: {fit.reason}"
    late = sum(row.exceeded for row in study.rows)
    if late:
        yield f"in {late} of {len(study.rows)} runs d grows beyond its first maximum later; the first is taken"


def text(study, origin):
    """The whole comparison for a terminal (str)."""
    parts = list(provenance_lines(origin))
    for heading, lines in compare(study):
        parts += ["", heading]
        rows = [HEADS] + [_cells(line) for line in lines]
        widths = [max(len(row[i]) for row in rows) for i in range(len(HEADS))]
        for row, note in zip(rows, [""] + [line.note for line in lines]):
            cells = [row[0].ljust(widths[0])] + [c.rjust(w) for c, w in zip(row[1:], widths[1:])]
            parts.append("  " + "  ".join(cells).rstrip() + (f"   [{note}]" if note else ""))
    parts += ["", *LEGEND, *missing(study), "", f"outcomes (95 % intervals; {UNDECIDED_MEANS})"]
    parts += _plain(outcome_rows(study))
    parts += ["", "energy: change in per cent of K(0), from the start to t_max | from t_max to the end"]
    parts += _plain(energy_rows(study, _SHORT))
    return "\n".join(parts)


def markdown(study, origin, notes=(), figures=()):
    """comparison.md: the same, with the figures ((file name, caption) pairs)."""
    parts = ["# Elastoplastic collisions beside A24", "", *(f"- {line}" for line in provenance_lines(origin))]
    parts += [f"- {line}" for line in missing(study)] + [f"- {line}" for line in notes]
    for heading, lines in compare(study):
        parts += ["", f"## {heading[0].upper()}{heading[1:]}", ""]
        parts += _table([HEADS + ("note",)] + [_cells(line) + (line.note,) for line in lines])
    parts += [""] + [f"- {line}" for line in LEGEND]
    parts += [
        "",
        "## How collisions end",
        "",
        "Mean and 95 % interval: bootstrap for the restitution (0 for "
        "sticking), Wilson's for the sticking probability; " + UNDECIDED_MEANS + ".",
        "",
        *_table(outcome_rows(study)),
    ]
    parts += [
        "",
        "## Where the energy goes",
        "",
        "Change of each channel in per cent of K(0), from the start to "
        "t_max | from t_max to the end; mean over the seeds.",
        "",
        *_table(energy_rows(study)),
    ]
    for name, caption in figures:
        parts += ["", f"![{caption}]({name})", "", caption]
    return "\n".join(parts) + "\n"


def data(study, origin, notes=()):
    """The same for JSON (dict; null for what does not exist)."""
    sections = [
        {"heading": heading, "lines": [_line_data(line) for line in lines]} for heading, lines in compare(study)
    ]
    rows = [{key: _plain_value(getattr(row, key)) for key in row.__dataclass_fields__} for row in study.rows]
    points = [{key: _plain_value(getattr(b, key)) for key in b.__dataclass_fields__} for b in study.bounces]
    return {
        "provenance": origin,
        "notes": list(notes),
        "missing": list(missing(study)),
        "comparison": sections,
        "bounces": points,
        "runs": rows,
    }


def outcome_rows(study):
    """Cells (tuples of str), the first row the heads: restitution and sticking probability of each point."""
    yield (
        "filling",
        "R [r]",
        "v [m/s]",
        "seeds",
        "restitution",
        "sticking probability",
        "outcomes",
        "bulk K at the end",
    )
    for b in study.bounces:
        kinds = ", ".join(f"{number} {kind}" for kind, number in b.outcomes.items())
        yield (
            f"{b.filling:g}",
            f"{b.radius:g}",
            f"{b.velocity:.4g}",
            str(b.seeds),
            _interval(b.restitution),
            _interval(b.sticking),
            kinds,
            f"{100 * b.bulk[0]:.2g} %",
        )


def energy_rows(study, names=LABELS):
    """Cells of the energy table: a row a point, a column a channel (by its name) that is not zero
    everywhere."""
    shown = [c for c in CHANNELS if any(b.compression[c][0] or b.parting[c][0] for b in study.bounces)]
    yield ("filling", "R [r]", "v [m/s]") + tuple(names[c] for c in shown)
    for b in study.bounces:
        cells = (f"{100 * b.compression[c][0]:.1f} | {100 * b.parting[c][0]:.1f}" for c in shown)
        yield (f"{b.filling:g}", f"{b.radius:g}", f"{b.velocity:.4g}", *cells)


def _interval(triple):
    mean, low, high = triple
    if mean is None:
        return "-" if low is None else f"- ({low:.3f} to {high:.3f})"
    return f"{mean:.3f}" if low is None else f"{mean:.3f} ({low:.3f} to {high:.3f})"


def _cells(line):
    name = line.quantity + (f" [{line.unit}]" if line.unit else "")
    return (
        name,
        _number(line.ours, line.error),
        _error(line.error),
        _number(line.paper),
        _sigma(line.difference),
        _sigma(line.combined_difference),
    )


def _number(value, error=None):
    """As many digits as the error has use for (two of its own), or four."""
    if value is None or not math.isfinite(value):
        return "inf" if value == math.inf else "-"
    if not error:
        return f"{value:.4g}"
    return f"{value:.{max(0, 1 - math.floor(math.log10(error)))}f}"


def _error(error):
    return "-" if error is None else f"{error:.2g}"


def _sigma(value):
    return "-" if value is None else f"{value:+.1f}"


def _plain(rows):
    rows = [tuple(row) for row in rows]
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    return ["  " + "  ".join(cell.rjust(width) for cell, width in zip(row, widths)) for row in rows]


def _table(rows):
    rows = [" | ".join(cell.replace("|", "\\|") for cell in row) for row in rows]
    return [f"| {rows[0]} |", "|" + "---|" * (rows[0].count(" | ") + 1)] + [f"| {row} |" for row in rows[1:]]


def _line_data(line):
    keys = ("quantity", "unit", "ours", "error", "paper", "paper_error", "difference", "combined_difference", "note")
    return {key: _plain_value(getattr(line, key)) for key in keys}


def _plain_value(value):
    if isinstance(value, dict):
        return {str(key): _plain_value(item) for key, item in value.items()}
    if isinstance(value, (tuple, list)):
        return [_plain_value(item) for item in value]
    if hasattr(value, "item"):
        value = value.item()
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value if isinstance(value, (int, float, bool, str, type(None))) else value.name  # a run's folder
