"""Where aggregates bounce, from the table of outcomes: the surface p_bounce = 1/2, and where p_bounce is highest."""

import numpy as np
import pandas

from .outcome_table import INSIDE

HALF, FINE = 0.5, 1000  # of p; points of a line between nodes
EDGES = ("first", "last")


def barrier(table):
    """DataFrame, a row for each mass ratio, filling and number of grains of an OutcomeTable where there are runs nearby (its column `runs`) inside
    of the data: the highest p_bounce over the velocities there, its error (90 % half width), velocity over v_break and runs nearby; and the velocities
    first .. last around it where it is HALF or more, each as (by p, by p + error, by p - error): NaN where nowhere, 0 or infinite where the data end first."""
    axes = {axis.name: axis.nodes for axis in table.axes}
    at, found = {name: table.values[..., k] for k, name in enumerate(table.columns)}, []
    for k, m, j in np.ndindex(*(len(axes[name]) for name in ("mass_ratio", "filling", "grains"))):
        known = (at[INSIDE][:, j, k, m] == 1) & (at["runs"][:, j, k, m] > 0)
        if known.sum() < 2:
            continue
        speed = np.log(axes["velocity"][known])
        p, error, runs = (at[name][known, j, k, m] for name in ("p_bouncing", "error_bouncing", "runs"))
        top = int(p.argmax())
        row = {"mass_ratio": axes["mass_ratio"][k], "filling": axes["filling"][m], "grains": axes["grains"][j]}
        row |= {"p": p[top], "error": error[top], "velocity": np.exp(speed[top]), "runs": int(runs[top])}
        ends = [_range(speed, p + sign * error, speed[top]) for sign in (0, 1, -1)]
        found.append({**row, **dict(zip(EDGES, zip(*ends)))})
    return pandas.DataFrame(found)


def _range(speed, p, top):
    """(first, last) velocity of the connected range around `top` in which p (at ln velocities) is HALF or more."""
    line = np.linspace(speed[0], speed[-1], FINE)
    enough, start = np.interp(line, speed, p) >= HALF, int(np.abs(line - top).argmin())
    if not enough[start]:
        return np.nan, np.nan
    lower, upper = np.flatnonzero(~enough[:start]), np.flatnonzero(~enough[start:])
    return (
        np.exp(line[lower[-1] + 1]) if len(lower) else 0.0,
        np.exp(line[start + upper[0] - 1]) if len(upper) else np.inf,
    )


def barrier_text(name, table):
    """Lines (str) on the surface p_bounce = HALF and on the highest p_bounce, in Markdown; name: of which collisions."""
    found = barrier(table)
    best = found.loc[found.p.idxmax()]
    yield (
        f"**{name.capitalize()}**: where runs are nearby and within the data, p_bounce is {best.p:.2f} ± {best.error:.2f} (90 %) at most, at "
        f"{best.velocity:.2g} v_break, {best.grains:.0f} grains, filling {best.filling:.2g} and mass ratio {best.mass_ratio:.2g}, "
        f"with {best.runs} runs nearby."
    )
    half = found[found.p >= HALF]
    if half.empty:
        yield "It is 1/2 nowhere.\n"
        return
    yield "It is 1/2 or more between these velocities over v_break (in brackets: with p more, and less, by its error; runs: nearby the highest):\n"
    yield "| mass ratio | filling | grains | highest | at | runs | from | to |\n|---|---|---|---|---|---|---|---|"
    for row in half.itertuples(index=False):
        edges = " | ".join(_edge(*getattr(row, name)) for name in EDGES)
        yield f"| {row.mass_ratio:.2g} | {row.filling:.2g} | {row.grains:.0f} | {row.p:.2f} ± {row.error:.2f} | {row.velocity:.2g} | {row.runs} | {edges} |"
    yield ""


def _edge(value, more, less):
    return f"{_velocity(value)} ({_velocity(more)}, {_velocity(less)})"


def _velocity(value):
    return (
        "nowhere" if np.isnan(value) else "slowest" if value == 0 else "fastest" if value == np.inf else f"{value:.2g}"
    )
