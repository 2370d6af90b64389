"""Runs as readable text: a line a run, or all numbers of one."""

import textwrap

from ..runs.folder import WIDTH, settings
from ..runs.format import CHANNEL_TABLE
from ..runs.table import FOLDER, RUN, Column
from .rows import MEASURED, at_end, final, varied

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


def long_text(run, row):
    """Several lines (str) of a RunFolder and its row of a table(): parameters, what was measured, energies."""
    energies = [name for channel in CHANNEL_TABLE for name in (channel.name, at_end(channel.name))]
    measured = [column for column in MEASURED if column.name not in ("ended", "time", *energies)]
    names = {column.name for column in measured}
    own = (Column(final(series.name), series.unit, f"at the end: {series.meaning}") for series in run.kind.series)
    measured += [column for column in own if column.name not in names]  # of a kind of a script's own
    known = [column for column in measured if row.get(column.name) is not None and row[column.name] == row[column.name]]
    state = "ended" if run.ended else "NOT ENDED: analysed as far as it went"
    lines = [f"run {run.path} ({state}, t = {row['time'] * 1e9:.4g} ns)"]
    lines.append(textwrap.fill(settings(run.parameters), WIDTH, initial_indent="  ", subsequent_indent="  "))
    for column in known:
        lines.append(f"  {column.name:<24}{_number(row[column.name], column.unit):<16} {column.meaning}".rstrip())
    lines.append(f"\n  {'energy':<28}{'at the end [J]':>14}{'change':>12} (of K(0), or a compression's largest work W)")
    for channel in CHANNEL_TABLE:
        change = row[at_end(channel.name)]
        lines.append(
            f"  {channel.label:<28}{row[channel.name]:>14.5g}{'-' if change != change else f'{change:.3%}':>12}"
        )
    return "\n".join(line for line in lines if line.strip())


def _number(value, unit):
    return (f"{value:.4g}" if isinstance(value, float) else str(value)) + (f" {unit}" if unit != "1" else "")
