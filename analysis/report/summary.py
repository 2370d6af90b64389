"""What a run says in a few numbers, as a dict (for JSON) and as a table (for people)."""

import textwrap

from ..measures.ledger import closure, initial_kinetic_energy, largest_work, work_closure
from ..measures.of_run import are_equal, maximum_of_run, met, outcome_of_run
from ..measures.outcome import BOUNCING
from ..measures.periodic_cell import AVERAGED, pressure_at_end, tensile_strength
from ..runs.format import CHANNEL_TABLE, CHANNELS, COLLISION, COMPRESSION, LABELS
from ..runs.shown import WIDTH, settings
from ..runs.table import Column

# Of a collision, named as measures.compression.Maximum and measures.outcome.Outcome have them.
COMPRESSION_KEYS = (
    Column(
        "d_max",
        "m",
        "largest compression length of equal aggregates that met (A24 eqs 10, 11); a measure of head-on collisions",
        gaps=True,
    ),
    Column("d_max_error", "m", "its error", gaps=True),
    Column("t_max", "s", "its time", gaps=True),
    Column("t_max_error", "s", "its error", gaps=True),
    Column("maximum_inside", "", "False: d_max is only a bound, at an end of the record", "O", gaps=True),
)
# Of a compression that was stretched afterwards.
TENSION_KEYS = (
    Column("tensile_strength", "Pa", f"largest tension while stretched, over {AVERAGED:g} t0", gaps=True),
    Column("tensile_filling", "1", "filling factor there", gaps=True),
)
OUTCOME_KEYS = (
    Column("restitution", "1", "coefficient of restitution, where there is one (measures.outcome)", gaps=True),
    Column(
        "outcome",
        "",
        "sticking (the largest piece gained at least 0.8 of the projectile's mass over the target; of equal ones: holds 0.9 of all), "
        "bouncing, fragmentation, never met, undecided (measures.outcome, .plate)",
        "O",
        gaps=True,
    ),
    Column("why_undecided", "", "why an outcome may still become another one; none of decided ones", "O", gaps=True),
    Column("mass_fractions", "1", "of the mass, in the two largest pieces", "O", gaps=True),
    Column("largest_fragment", "", "number of grains of the largest piece by mass", gaps=True),
    Column("fragments", "", "number of pieces", gaps=True),
    Column("growth_efficiency", "1", "(m_largest - m_target)/m_projectile (A22 eq 28); of a plate m_on/m", gaps=True),
    Column("mass_on_plate", "1", "of the mass, what sticks to the plate", gaps=True),
)
ENERGY_KEYS = (
    Column(
        "energy_closure", "1", "max |E(t) - E(0)|/K(0); of a compression over the boundaries' largest work", gaps=True
    ),
    Column("initial_kinetic_energy", "J", "K(0)"),
    *(Column(channel.name, "J", f"{channel.label}, at the end") for channel in CHANNEL_TABLE),
)


def summarise(run):
    """Numbers of a RunFolder as a dict, SI units, None where a value does not exist: run (path), ended, time (of the last
    sample), ended_by (what ended a compression), and by their names COMPRESSION_KEYS, OUTCOME_KEYS (None but for collisions), TENSION_KEYS
    and ENERGY_KEYS. RunFolderError when a state is missing or damaged."""
    history = run.history
    collision = run.kind is COLLISION
    maximum = maximum_of_run(run) if collision and are_equal(run) and met(run) else None
    numbers = {"run": str(run.path), "ended": run.ended, "time": float(history["time"][-1])}
    numbers["ended_by"] = run.record.get("endedBy")
    numbers.update(_compression(maximum))
    numbers.update(_outcome(run) if collision else dict.fromkeys(_names(OUTCOME_KEYS)))
    numbers.update(dict.fromkeys(_names(TENSION_KEYS)) if run.kind is not COMPRESSION else _tension(run))
    numbers["energy_closure"] = (work_closure if run.kind is COMPRESSION else closure)(history)
    numbers["initial_kinetic_energy"] = initial_kinetic_energy(history)
    numbers.update({name: float(history[name][-1]) for name in CHANNELS})
    return numbers


def _compression(maximum):
    if maximum is None:
        return dict.fromkeys(_names(COMPRESSION_KEYS))
    values = [float(x) for x in (maximum.length, maximum.length_error, maximum.time, maximum.time_error)]
    if not maximum.inside:
        values[1] = values[3] = None
    return dict(zip(_names(COMPRESSION_KEYS), values + [maximum.inside]))


def _outcome(run):
    outcome = outcome_of_run(run)
    numbers = {name: getattr(outcome, "kind" if name == "outcome" else name) for name in _names(OUTCOME_KEYS)}
    return {**numbers, "mass_fractions": list(outcome.mass_fractions)}


def _names(columns):
    return [column.name for column in columns]


def table(run, numbers):
    """Readable table (str, several lines) of a RunFolder and its summarise() dict."""
    given = textwrap.fill(settings(run.parameters), WIDTH, initial_indent="  ", subsequent_indent="  ")
    rows = [f"run {run.path} ({_progress(run, numbers)})", given]
    rows += [f"  {name:<20} {value}" for name, value in _measures(run, numbers)]
    return "\n".join(row for row in rows if row) + "\n\n" + _channel_table(run, numbers)


def _progress(run, numbers):
    reached = f"t = {numbers['time'] * 1e9:.4g} ns"
    if run.ended:
        return f"ended, {reached}"
    return f"NOT ENDED: analysed as far as it went, {reached}"


def _measures(run, numbers):
    if run.kind is COLLISION:
        yield from _collision_measures(run, numbers)
    else:
        yield "kind", f"a run of the kind {run.kind.name}"
    if run.kind is COMPRESSION:
        yield from _compression_measures(run, numbers)
    closed, (_, unit) = numbers["energy_closure"], _energy_unit(run, numbers)
    yield "energy closure", (f"undefined: no {unit}" if closed is None else f"{closed:.3g} of {unit}")


def _tension(run):
    """TENSION_KEYS of a compression; None where it was not stretched."""
    found = tensile_strength(run.history, AVERAGED * run.derived["timeUnit"])
    return {name: value if value == value else None for name, value in zip(_names(TENSION_KEYS), found)}


def _energy_unit(run, numbers):
    """(energy [J], its name) that changes of energy are told in."""
    if run.kind is COMPRESSION:
        return largest_work(run.history), "W"
    return numbers["initial_kinetic_energy"], "K(0)"


def _compression_measures(run, numbers):
    history, largest = run.history, run.history["filling"].argmax()
    yield "filling factor", f"{history['filling'][0]:.4g} to {history['filling'][largest]:.4g}"
    if largest + 1 < len(history["filling"]):
        yield "stretched to", f"{history['filling'][-1]:.4g}"
    if numbers["tensile_strength"] is not None:
        yield (
            "tensile strength",
            f"{numbers['tensile_strength']:.4g} Pa at a filling factor of {numbers['tensile_filling']:.4g}",
        )
    yield "coordination", f"{history['coordination'][0]:.4g} to {history['coordination'][largest]:.4g}"
    pressed = {name: series[: largest + 1] for name, series in history.items()}
    pressure = pressure_at_end(pressed, AVERAGED * run.derived["timeUnit"])
    yield "pressure", f"{pressure:.4g} Pa at the largest filling factor, of the work over the last {AVERAGED:g} t0"
    if numbers["ended_by"]:
        yield "ended by", numbers["ended_by"]


def _collision_measures(run, numbers):
    yield "d_max", _d_max(run, numbers)
    yield "t_max", _t_max(numbers)
    f1, f2 = numbers["mass_fractions"]
    kind = numbers["outcome"] + ("" if run.ended else ", so far")
    yield "outcome", f"{kind} (mass in the two largest fragments: {f1:.2%}, {f2:.2%})"
    if numbers["why_undecided"]:
        yield "", numbers["why_undecided"]
    restitution = numbers["restitution"]
    yield "restitution", _no_restitution(numbers) if restitution is None else f"{restitution:.4g}"
    grains, fragments = run.start.radius.size, numbers["fragments"]
    yield "largest fragment", f"{numbers['largest_fragment']} grains of {grains}, {fragments} fragments"
    yield "growth efficiency", f"{numbers['growth_efficiency']:.4g}"
    if numbers["mass_on_plate"] is not None:
        yield "on the plate", f"{numbers['mass_on_plate']:.2%} of the mass"


def _no_restitution(numbers):
    if numbers["outcome"] == BOUNCING:
        return "none: no velocity at the start, or the two pieces have passed each other"
    return f"none: {numbers['outcome']}"


def _d_max(run, numbers):
    grain_radius = run.derived["grainRadius"]
    if numbers["d_max"] is None:
        if not are_equal(run):
            return "undefined: aggregates of unlike mass"
        return "undefined: " + ("all grains on one side of x = 0" if met(run) else "the aggregates have not met")
    text = f"{numbers['d_max']:.4g} m = {numbers['d_max'] / grain_radius:.4g} grain radii"
    if numbers["maximum_inside"]:
        return text + f" (+- {numbers['d_max_error'] / grain_radius:.1g})"
    return text + " (only a bound: the largest d is at an end of the record)"


def _t_max(numbers):
    if numbers["t_max"] is None:
        return "undefined"
    text = f"{numbers['t_max'] * 1e9:.4g} ns"
    return text + (f" (+- {numbers['t_max_error'] * 1e9:.1g} ns)" if numbers["maximum_inside"] else "")


def _channel_table(run, numbers):
    unit, name_of_unit = _energy_unit(run, numbers)
    width = max(map(len, LABELS.values())) + 1
    rows = [f"  {'energy':<{width}}{'final [J]':>14}{'change [J]':>14}{f'change/{name_of_unit}':>14}"]
    for name in CHANNELS:
        change = numbers[name] - run.history[name][0]
        fraction = f"{change / unit:.3%}" if unit > 0 else "-"
        rows.append(f"  {LABELS[name]:<{width}}{numbers[name]:>14.5g}{change:>14.4g}{fraction:>14}")
    about = ", the largest work of the boundaries" if name_of_unit == "W" else ""
    rows.append(f"  {name_of_unit} = {unit:.5g} J{about}")
    return "\n".join(rows)
