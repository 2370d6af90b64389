"""The comparison with A24: the sections of the report."""

from ...measures.outcome import STILL_PARTING, UNDECIDED
from ...report.beside_paper import section_of_lines
from ...report.section import Column, Section
from ...runs.format import CHANNELS, LABELS
from ...statistics import RESAMPLES
from .lines import compare

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
# A terminal is no wider than 160.
_SHORT = {
    **{c: c for c in CHANNELS},
    "slidingDissipation": "slid. diss.",
    "rollingDissipation": "roll. diss.",
    "twistingDissipation": "twist. diss.",
    "disconnection": "disconn.",
    "bondBreaking": "bonds",
}


def sections(results):
    """Sections of results.Results: one for each filling and subject, how collisions end, where the energy goes."""
    for heading, lines in compare(results):
        yield section_of_lines(heading, lines)
    yield Section("how to read the tables", notes=LEGEND)
    yield _outcome_section(results.bounces)
    yield _energy_section(results.bounces)


def remarks(results):
    """Lines that say what could not be fitted, and why, and what was decided."""
    for filling in results.by_filling.values():
        for fit in (filling.size_fit, filling.velocity_fit):
            if fit.reason:
                yield f"not fitted: {fit.reason}"
    late = int(results.table.exceeded.sum())
    if late:
        yield f"in {late} of {len(results.table)} runs d grows beyond its first maximum later; the first is taken"


def _outcome_section(points):
    names = ("filling", "radius", "velocity", "seeds", "restitution", "sticking", "outcomes", "bulk")
    columns = (
        *_POINT,
        Column("seeds", lambda b: str(b["seeds"])),
        Column("restitution", lambda b: _interval(b["restitution"])),
        Column("sticking probability", lambda b: _interval(b["sticking"])),
        Column("outcomes", lambda b: ", ".join(f"{number} {kind}" for kind, number in b["outcomes"].items())),
        Column("bulk K at the end", lambda b: f"{100 * b['bulk'][0]:.2g} %"),
    )
    return Section(
        "how collisions end",
        columns,
        tuple({name: getattr(b, name) for name in names} for b in points),
        intro="Mean and 95 % interval: bootstrap for the restitution (0 for sticking), Wilson's for the sticking "
        "probability; " + UNDECIDED_MEANS + ".",
    )


def _energy_section(points):
    shown = [c for c in CHANNELS if any(b.compression[c][0] or b.parting[c][0] for b in points)]
    names = ("filling", "radius", "velocity", "compression", "parting")
    columns = (*_POINT, *(Column(_SHORT[c], _change(c), long=LABELS[c]) for c in shown))
    return Section(
        "where the energy goes",
        columns,
        tuple({name: getattr(b, name) for name in names} for b in points),
        intro="Change of each channel in per cent of K(0), from the start to t_max | from t_max to the end; mean over "
        "the seeds.",
    )


def _change(channel):
    return lambda b: f"{100 * b['compression'][channel][0]:.1f} | {100 * b['parting'][channel][0]:.1f}"


_POINT = (
    Column("filling", lambda b: f"{b['filling']:g}"),
    Column("R [r]", lambda b: f"{b['radius']:g}"),
    Column("v [m/s]", lambda b: f"{b['velocity']:.4g}"),
)


def _interval(triple):
    mean, low, high = triple
    if mean is None:
        return "-" if low is None else f"- ({low:.3f} to {high:.3f})"
    return f"{mean:.3f}" if low is None else f"{mean:.3f} ({low:.3f} to {high:.3f})"
