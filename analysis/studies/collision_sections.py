"""Sections of a report that studies of collisions have in common: how collisions end, what comes back, where the energy
goes."""

from ..measures.outcome import STILL_PARTING, UNDECIDED
from ..report.section import Column, Section
from ..runs.format import CHANNELS, LABELS, LOST_CHANNELS

UNDECIDED_MEANS = (
    f"{UNDECIDED}: in one piece at the end, but parting at more than {STILL_PARTING:g} of the largest speed "
    "of the return; a longer duration decides"
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
        Column("outcomes", lambda b: ", ".join(f"{number} {kind}" for kind, number in b["outcomes"].items())),
        Column("sticking probability", lambda b: _both_ways(b["sticking"])),
        Column("restitution", lambda b: _both_ways(b["restitution"])),
        Column("K in bulk motion at the end", lambda b: _per_cent(b["bulk"])),
    )
    return Section(
        "how collisions end",
        columns,
        _records(points, ("seeds", "outcomes", "sticking", "restitution", "bulk")),
        intro="Mean with every undecided run counted either way (low to high), in brackets the outer ends of the 95 % "
        "intervals: Wilson's for the sticking probability, Student's for the restitution (0 for sticking; an undecided "
        "run's is at most the speed at which its halves part at the end; no interval where all are 0). "
        + UNDECIDED_MEANS
        + ".",
    )


def return_section(points, parameters):
    """Section of the energy in bulk motion at the largest return speed; None where no run was timed."""
    rows = tuple(
        {
            **point.parameters,
            "outcome": phases.outcome,
            "seeds": phases.timed,
            "returned": phases.returned,
            "when": phases.when,
            "release": {c: value[0] for c, value in phases.release.items()},
            "stretching": {c: value[0] for c, value in phases.stretching.items()},
            "bulk": phases.bulk,
        }
        for point in points
        for phases in point.phases
        if phases.timed
    )
    if not rows:
        return None
    columns = (
        *parameters,
        Column("outcome", lambda b: b["outcome"]),
        Column("seeds", lambda b: str(b["seeds"])),
        Column("K in bulk motion, returned", lambda b: _per_cent(b["returned"])),
        Column("at [ns]", lambda b: _nanoseconds(b["when"])),
        Column("normal", lambda b: _two_parts(b, "normal"), long="normal (JKR potential)"),
        Column("dissipation", lambda b: f"{_lost(b['release'])} | {_lost(b['stretching'])}"),
        Column("K in bulk motion at the end", lambda b: _per_cent(b["bulk"])),
    )
    return Section(
        "what comes back",
        columns,
        rows,
        intro="K in bulk motion: (v/v_col)^2, the fraction of K(0) in the relative motion of the halves; returned: at the largest "
        "return speed, with standard error. Normal energy and all dissipation: change in per cent of K(0) from t_max to the "
        "largest return speed | from there to the end. That split needs no decided outcome.",
    )


def energy_section(points, parameters):
    """Section of a list of collision_points.CollisionPoint, with Columns for the parameters; a row for each outcome, a
    column for each channel that is not zero everywhere."""
    phases = [each for point in points for each in point.phases]
    shown = [c for c in CHANNELS if any(b.compression[c][0] or b.parting[c][0] for b in phases)]
    rows = tuple(
        {**point.parameters, **{name: getattr(each, name) for name in ("outcome", "seeds", "compression", "parting")}}
        for point in points
        for each in point.phases
    )
    return Section(
        "where the energy goes",
        (
            *parameters,
            Column("outcome", lambda b: b["outcome"]),
            Column("seeds", lambda b: str(b["seeds"])),
            *(Column(_SHORT[c], _change(c), long=LABELS[c]) for c in shown),
        ),
        rows,
        intro="Change of each channel in per cent of K(0), from the start to t_max | from t_max to the end; mean over "
        "the seeds of that outcome. The end is that of the record, in an undecided run in the middle of parting.",
    )


def _records(points, names):
    return tuple({**point.parameters, **{name: getattr(point, name) for name in names}} for point in points)


def _change(channel):
    return lambda b: f"{100 * b['compression'][channel][0]:.1f} | {100 * b['parting'][channel][0]:.1f}"


def _two_parts(row, channel):
    return f"{100 * row['release'][channel]:.1f} | {100 * row['stretching'][channel]:.1f}"


def _lost(changes):
    """All dissipation in a phase [per cent of K(0)]."""
    return f"{100 * sum(changes[c] for c in LOST_CHANNELS):.1f}"


def _per_cent(pair):
    if pair is None:
        return "-"
    mean, error = pair
    return f"{100 * mean:.2g} %" + (f" +- {100 * error:.1g}" if error else "")


def _nanoseconds(pair):
    mean, error = pair
    return f"{1e9 * mean:.0f}" + (f" +- {1e9 * error:.0f}" if error else "")


def _both_ways(ends):
    low, high, lowest, highest = ends
    if low is None:
        return "-"
    text = f"{low:.2f}" if abs(high - low) < 5e-3 else f"{low:.2f} to {high:.2f}"
    return text if lowest is None and highest is None else text + f" ({_end(lowest, low)} to {_end(highest, high)})"


def _end(end, mean):
    """End of an interval, or that mean which has none."""
    return f"{mean if end is None else end:.2f}"
