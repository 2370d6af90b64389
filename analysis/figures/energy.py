"""Where the energy of a run goes, and the compression of a periodic cell against its filling factor."""

import numpy as np

from ..measures.periodic_cell import AVERAGED, pressure_over, work_on_boundaries
from ..runs.files import RunFolderError
from ..runs.format import CHANNEL_TABLE, CHANNELS, COLOURS, HISTORY_FILE, LABELS, WORK
from ..runs.ledger import closure, closure_history, fractions
from ..runs.measured import unit_of
from ..theory.aggregates import bcca_coordination, compressive_strength, compressive_strength_dense, strength_scale
from .style import NANO, OURS, PAPER, legend, letter, new_figure, panels, run_title, styled


@styled
def energy_figure(run):
    """Figure of all channels as fractions of K(0): changes since the start (the kinetic channel itself), so that their
    sum is 1. Of a script's own run they are fractions of its largest change.

    Positive fractions are stacked upward from 0 and negative ones downward; the line is the sum. Below, the ledger's
    error. RunFolderError where the unit is 0.
    """
    unit, name = unit_of(run)
    parts = fractions(run.history, unit)
    if parts is None:
        raise RunFolderError(f"{run.path / HISTORY_FILE}: {name} is 0, so fractions of it are undefined")
    time = run.history["time"] * NANO
    figure = new_figure(10.0, 6.6, constrained_layout=True)
    upper, lower = figure.subplots(2, 1, sharex=True, gridspec_kw={"height_ratios": (5, 1)})
    _stack(upper, time, parts)
    upper.plot(time, sum(parts[name] for name in CHANNELS), color="black", label="sum of all channels")
    upper.axhline(0.0, color="black", linewidth=0.7)
    upper.set_ylabel(f"fraction of {name.replace('K(0)', 'the initial kinetic energy')}")
    upper.set_title(run_title(run), loc="right", fontsize=10, color="0.3")
    values = np.array(list(parts.values()))
    top, bottom = np.maximum(values, 0.0).sum(axis=0).max(), np.minimum(values, 0.0).sum(axis=0).min()
    upper.set_ylim(bottom - 0.03 * (top - bottom) * (bottom < 0), top + 0.03 * (top - bottom))
    handles, labels = upper.get_legend_handles_labels()  # beside the plot, in the order of the stack from the top
    title = "change since the start, at the end\n(kinetic: what is left)"
    place = {"loc": "upper left", "bbox_to_anchor": (1.01, 1.0), "frameon": False}
    upper.legend(handles[::-1], labels[::-1], title=title, title_fontsize=10, alignment="left", **place)
    _draw_error(lower, time, run.history, unit, name)
    lower.set_xlim(time[0], time[-1] if time.size > 1 else time[0] + 1.0)
    return figure


def _stack(axes, time, parts):
    """Areas of the positive fractions from 0 up and of the negative ones from 0 down, of channels that are not 0."""
    for sign in (1.0, -1.0):
        base = np.zeros_like(time)
        for name in (name for name in CHANNELS if np.any(parts[name] != 0.0)):
            height, end = sign * np.maximum(sign * parts[name], 0.0), parts[name][-1]
            label = f"{LABELS[name]}  {end:.2%}" if name == "kinetic" else f"{LABELS[name]}  {end:+.2%}"
            area = {"color": COLOURS[name], "linewidth": 0, "label": label if sign > 0 else None}
            axes.fill_between(time, base, base + height, **area)
            base = base + height


def _draw_error(axes, time, history, unit, name):
    error, largest = closure_history(history, unit), closure(history, unit)
    exponent = int(np.floor(np.log10(largest))) if largest > 0 else 0
    axes.plot(time, error / 10.0**exponent, color="black", linewidth=1.2)
    axes.axhline(0.0, color="0.6", linewidth=0.7)
    axes.set_ylabel("sum $-$ 1" + (f"\n[$10^{{{exponent}}}$]" if exponent else ""))
    axes.set_xlabel("time $t$  [ns]")
    text = f"largest error of the ledger:\n{largest:.2g} of {name}"
    axes.text(1.02, 0.5, text, transform=axes.transAxes, va="center", fontsize=10)


@styled
def compression_figure(run):
    """Figure of pressure (averaged over 1000 t0) beside Kataoka et al. (2013), eq 25, and Tatsuuma et al. (2023),
    coordination beside Arakawa et al. (2024), eq 45, and every channel's change over the work of the boundaries until
    then, all while the cell shrinks."""
    history = run.history
    part = slice(0, int(np.argmax(history["filling"])) + 1)
    filling = history["filling"][part]
    figure, axes = panels(1, 3, 4.8, 4.2)
    strength, contacts, energy = axes[0]
    _draw_pressure(strength, history, run.derived)
    contacts.plot(filling, history["coordination"][part], color=OURS)
    contacts.plot(filling, bcca_coordination(filling), "--", color=PAPER, label="Arakawa et al. (2024), eq 45")
    contacts.set_ylabel("coordination number $Z$")
    _draw_channels(energy, filling, history, part)
    for place in (strength, contacts, energy):
        place.set_xscale("log")
        place.set_xlabel("filling factor $\\phi$")
        legend(place, loc="upper left", fontsize=8, ncol=2 if place is energy else 1)
    letter(axes, run_title(run))
    return figure


def _draw_pressure(axes, history, derived):
    filling, pressure = pressure_over(history, AVERAGED * derived["timeUnit"])
    axes.plot(filling[pressure > 0], pressure[pressure > 0], color=OURS)
    if "rollingEnergy" in derived:
        scale = strength_scale(derived["rollingEnergy"], derived["grainRadius"])
        of_kataoka, of_tatsuuma = compressive_strength(filling, scale), compressive_strength_dense(filling, scale)
        axes.plot(filling, of_kataoka, "--", color=PAPER, label="Kataoka et al. (2013), eq 25")
        axes.plot(filling, of_tatsuuma, ":", color=PAPER, label="Tatsuuma et al. (2023)")
    axes.set_yscale("log")
    axes.set_ylabel("pressure $P$  [Pa]")


def _draw_channels(axes, filling, history, part):
    work = {channel.name for channel in CHANNEL_TABLE if channel.kind == WORK}
    total = work_on_boundaries(history)
    done = -(total[part] - total[0])
    shown = done > 1e-4 * done.max() if done.max() > 0 else np.zeros(len(done), bool)
    for name in CHANNELS:
        change = history[name][part][shown] - history[name][0]
        if name not in work and len(change) and np.abs(change / done[shown]).max() > 0.01:
            axes.plot(filling[shown], change / done[shown], color=COLOURS[name], label=LABELS[name])
    axes.set_ylim(-1.0, 1.6)
    axes.set_ylabel("part of the boundaries' work until then")
