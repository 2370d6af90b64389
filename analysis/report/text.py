"""Runs as readable text: a line a run, or all numbers of one."""

import textwrap

from ..measures.outcome import BOUNCING
from ..measures.periodic_cell import AVERAGED, pressure_at_end
from ..runs.folder import WIDTH, settings
from ..runs.format import CHANNELS, COLLISION, COMPRESSION, LABELS
from ..runs.ledger import largest_work
from ..runs.measured import are_equal, met
from ..runs.table import FOLDER, RUN
from .rows import varied

# Columns of the line of a run.
SHORT = (
    *("outcome", "largest_fraction", "fragments", "growth_efficiency", "mass_on_plate", "restitution", "d_max"),
    *("final_filling", "final_pressure", "energy_closure"),
)


def short_text(found):
    """A line a run of a table(): its folder, the parameters in which the runs of a kind differ, and SHORT."""
    kinds = [found[found.kind == kind] for kind in found.kind.unique()]
    differing = [name for own in kinds for name in varied(own)] + (["kind"] if len(kinds) > 1 else [])
    first = [FOLDER, *(["velocity"] if "velocity" in found else []), *differing]
    shown = [name for name in SHORT if name in found and found[name].notna().any()]
    names = dict.fromkeys([*first, *([] if found.ended.all() else ["ended"]), *shown])
    units = {name: found.attrs["units"].get(name, "") for name in names}
    heads = {name: name + (f" [{unit}]" if unit not in ("", "1") else "") for name, unit in units.items()}
    text = found[list(names)]
    if "d_max" in names:
        shown = zip(found.d_max, found.maximum_inside)
        text = text.assign(d_max=[f"{'' if inside else '>='}{d:.4g}" if d == d else "-" for d, inside in shown])
    text = text.rename(columns={**heads, FOLDER: RUN})
    return text.to_string(index=False, na_rep="-", float_format="{:.4g}".format)


def long_text(run, numbers):
    """Several lines (str) of a RunFolder and its summarise()."""
    given = textwrap.fill(settings(run.parameters), WIDTH, initial_indent="  ", subsequent_indent="  ")
    reached = f"t = {numbers['time'] * 1e9:.4g} ns"
    state = f"ended, {reached}" if run.ended else f"NOT ENDED: analysed as far as it went, {reached}"
    lines = [f"run {run.path} ({state})", given]
    lines += [f"  {name:<20} {value}" for name, value in _measures(run, numbers)]
    return "\n".join(line for line in lines if line) + "\n\n" + _channels(run, numbers)


def _measures(run, numbers):
    """(name, text) of what became of a run."""
    if run.kind is COLLISION:
        yield from _collision(run, numbers)
    else:
        yield "kind", f"a run of the kind {run.kind.name}"
    if run.kind is COMPRESSION:
        yield from _compression(run, numbers)
    closed, (_, unit) = numbers["energy_closure"], _energy_unit(run, numbers)
    yield "energy closure", (f"undefined: no {unit}" if closed is None else f"{closed:.3g} of {unit}")


def _collision(run, numbers):
    yield "d_max", _d_max(run, numbers)
    if numbers["t_max"] is not None:
        error = f" (+- {numbers['t_max_error'] * 1e9:.1g} ns)" if numbers["maximum_inside"] else ""
        yield "t_max", f"{numbers['t_max'] * 1e9:.4g} ns{error}"
    f1, f2 = numbers["mass_fractions"]
    kind = numbers["outcome"] + ("" if run.ended else ", so far")
    yield "outcome", f"{kind} (mass in the two largest fragments: {f1:.2%}, {f2:.2%})"
    if numbers["why_undecided"]:
        yield "", numbers["why_undecided"]
    if numbers["restitution"] is not None:
        yield "restitution", f"{numbers['restitution']:.4g}"
    elif numbers["outcome"] == BOUNCING:
        yield "restitution", "none: no velocity at the start, or the two pieces have passed each other"
    else:
        yield "restitution", f"none: {numbers['outcome']}"
    grains, fragments = run.start.radius.size, numbers["fragments"]
    yield "largest fragment", f"{numbers['largest_fragment']} grains of {grains}, {fragments} fragments"
    yield "growth efficiency", f"{numbers['growth_efficiency']:.4g}"
    if numbers["mass_on_plate"] is not None:
        yield "on the plate", f"{numbers['mass_on_plate']:.2%} of the mass"


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


def _compression(run, numbers):
    history, largest = run.history, run.history["filling"].argmax()
    yield "filling factor", f"{history['filling'][0]:.4g} to {history['filling'][largest]:.4g}"
    if largest + 1 < len(history["filling"]):
        yield "stretched to", f"{history['filling'][-1]:.4g}"
    if numbers["tensile_strength"] is not None:
        filling = numbers["tensile_filling"]
        yield "tensile strength", f"{numbers['tensile_strength']:.4g} Pa at a filling factor of {filling:.4g}"
    yield "coordination", f"{history['coordination'][0]:.4g} to {history['coordination'][largest]:.4g}"
    pressed = {name: series[: largest + 1] for name, series in history.items()}
    pressure = pressure_at_end(pressed, AVERAGED * run.derived["timeUnit"])
    yield "pressure", f"{pressure:.4g} Pa at the largest filling factor, of the work over the last {AVERAGED:g} t0"
    if numbers["ended_by"]:
        yield "ended by", numbers["ended_by"]


def _energy_unit(run, numbers):
    """(energy [J], its name) over which changes of energy are given."""
    if run.kind is COMPRESSION:
        return largest_work(run.history), "W"
    return numbers["initial_kinetic_energy"], "K(0)"


def _channels(run, numbers):
    unit, name_of_unit = _energy_unit(run, numbers)
    width = max(map(len, LABELS.values())) + 1
    lines = [f"  {'energy':<{width}}{'final [J]':>14}{'change [J]':>14}{f'change/{name_of_unit}':>14}"]
    for name in CHANNELS:
        change = numbers[name] - run.history[name][0]
        fraction = f"{change / unit:.3%}" if unit > 0 else "-"
        lines.append(f"  {LABELS[name]:<{width}}{numbers[name]:>14.5g}{change:>14.4g}{fraction:>14}")
    about = ", the largest work of the boundaries" if name_of_unit == "W" else ""
    lines.append(f"  {name_of_unit} = {unit:.5g} J{about}")
    return "\n".join(lines)
