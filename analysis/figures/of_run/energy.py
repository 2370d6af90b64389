"""Where the energy goes: the channels stacked against time, in fractions of the initial kinetic energy."""

import numpy as np

from ...measures.ledger import closure, closure_history, fractions
from ...runs.files import RunFolderError
from ...runs.format import CHANNELS, COLOURS, COMPRESSION, HISTORY_FILE, LABELS
from ..style import NANO, new_figure, run_title, styled


@styled
def energy_figure(run):
    """Figure of all channels as fractions of K(0): changes since the start (the kinetic channel itself), so that
    their sum is 1.

    Positive fractions are stacked upward from 0 and negative ones downward; the line is the sum. Below, the
    ledger's error. RunFolderError when there is no kinetic energy at the start."""
    parts = fractions(run.history)
    if parts is None:
        raise RunFolderError(
            f"{run.path / HISTORY_FILE}: no kinetic energy at the start, so fractions of it are undefined"
        )
    time = run.history["time"] * NANO
    figure = new_figure(10.0, 6.6, constrained_layout=True)
    upper, lower = figure.subplots(2, 1, sharex=True, gridspec_kw={"height_ratios": (5, 1)})
    shown = [name for name in CHANNELS if np.any(parts[name] != 0.0)]
    _stack(upper, time, parts, shown)
    upper.plot(time, sum(parts[name] for name in CHANNELS), color="black", label="sum of all channels")
    upper.axhline(0.0, color="black", linewidth=0.7)
    upper.set_ylabel("fraction of the initial kinetic energy")
    upper.set_title(run_title(run), loc="right", fontsize=10, color="0.3")
    upper.set_ylim(*_limits(parts))
    _legend(upper)
    _draw_error(lower, time, run.history)
    lower.set_xlim(time[0], time[-1] if time.size > 1 else time[0] + 1.0)
    return figure


FIGURE = energy_figure
NOT_OF = (COMPRESSION.name,)  # which begins almost at rest: compression.py draws where the boundaries' work goes


def _stack(axes, time, parts, names):
    """Areas of the positive fractions from 0 up and of the negative ones from 0 down, in the order of
    `names`."""
    for sign in (1.0, -1.0):
        base = np.zeros_like(time)
        for name in names:
            height = sign * np.maximum(sign * parts[name], 0.0)
            label = f"{LABELS[name]}  {_percent(name, parts[name][-1])}" if sign > 0 else None
            axes.fill_between(time, base, base + height, color=COLOURS[name], linewidth=0, label=label)
            base = base + height


def _percent(name, fraction):
    return f"{fraction:.2%}" if name == "kinetic" else f"{fraction:+.2%}"


def _limits(parts):
    values = np.array(list(parts.values()))
    top, bottom = np.maximum(values, 0.0).sum(axis=0).max(), np.minimum(values, 0.0).sum(axis=0).min()
    return bottom - 0.03 * (top - bottom) * (bottom < 0), top + 0.03 * (top - bottom)


def _legend(axes):
    """Beside the plot, in the order of the stack from the top, with each channel's fraction at the end of the
    run."""
    handles, labels = axes.get_legend_handles_labels()
    line = [i for i, label in enumerate(labels) if label == "sum of all channels"]
    order = line + [i for i in reversed(range(len(labels))) if i not in line]
    axes.legend(
        [handles[i] for i in order],
        [labels[i] for i in order],
        loc="upper left",
        bbox_to_anchor=(1.01, 1.0),
        frameon=False,
        title="change since the start, at the end\n(kinetic: what is left)",
        title_fontsize=10,
        alignment="left",
    )


def _draw_error(axes, time, history):
    error = closure_history(history)
    largest = closure(history)
    exponent = int(np.floor(np.log10(largest))) if largest > 0 else 0
    axes.plot(time, error / 10.0**exponent, color="black", linewidth=1.2)
    axes.axhline(0.0, color="0.6", linewidth=0.7)
    axes.set_ylabel("sum $-$ 1" + (f"\n[$10^{{{exponent}}}$]" if exponent else ""))
    axes.set_xlabel("time $t$  [ns]")
    axes.text(
        1.02,
        0.5,
        f"largest error of the ledger:\n{largest:.2g} of K(0)",
        transform=axes.transAxes,
        va="center",
        fontsize=10,
    )
