"""Sections of a report that studies of collisions have in common: how collisions end, where the energy goes."""

from ..measures.outcome import STILL_PARTING, UNDECIDED
from ..report.section import Column, Section
from ..runs.format import CHANNELS, LABELS

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


def outcome_section(points, parameters):
    """Section of a list of collision_points.CollisionPoint, with Columns for the parameters."""
    columns = (
        *parameters,
        Column("seeds", lambda b: str(b["seeds"])),
        Column("restitution", lambda b: _interval(b["restitution"])),
        Column("sticking probability", lambda b: _interval(b["sticking"])),
        Column("outcomes", lambda b: ", ".join(f"{number} {kind}" for kind, number in b["outcomes"].items())),
        Column("bulk K at the end", lambda b: f"{100 * b['bulk'][0]:.2g} %"),
    )
    return Section(
        "how collisions end",
        columns,
        _records(points, ("seeds", "restitution", "sticking", "outcomes", "bulk")),
        intro="Mean and 95 % interval: bootstrap for the restitution (0 for sticking), Wilson's for the sticking "
        "probability; " + UNDECIDED_MEANS + ".",
    )


def energy_section(points, parameters):
    """Section of a list of collision_points.CollisionPoint, with Columns for the parameters; a column for each channel
    that is not zero everywhere."""
    shown = [c for c in CHANNELS if any(b.compression[c][0] or b.parting[c][0] for b in points)]
    return Section(
        "where the energy goes",
        (*parameters, *(Column(_SHORT[c], _change(c), long=LABELS[c]) for c in shown)),
        _records(points, ("compression", "parting")),
        intro="Change of each channel in per cent of K(0), from the start to t_max | from t_max to the end; mean over "
        "the seeds.",
    )


def _records(points, names):
    return tuple({**point.parameters, **{name: getattr(point, name) for name in names}} for point in points)


def _change(channel):
    return lambda b: f"{100 * b['compression'][channel][0]:.1f} | {100 * b['parting'][channel][0]:.1f}"


def _interval(triple):
    mean, low, high = triple
    if mean is None:
        return "-" if low is None else f"- ({low:.3f} to {high:.3f})"
    return f"{mean:.3f}" if low is None else f"{mean:.3f} ({low:.3f} to {high:.3f})"
