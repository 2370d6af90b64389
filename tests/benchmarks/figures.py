"""The figures of the bench: contact updates a second of every code at each moment (bench-speed.png), and error against step
and cost (bench-error.png)."""

import errors
import matplotlib
import numpy as np
from codes import CODES
from measured_scenes import all_scenes
from report import QUANTITIES, curves, each_moment

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

COLOURS = dict(zip(CODES, ("#c1272d", "#d98880", "#e8c4c0", "#1b8a8f", "#1f5fa8", "#f2a134", "#8c4a9e")))
STYLE = {"axes.spines.top": False, "axes.spines.right": False, "legend.frameon": False, "font.size": 10}


def draw(results, settings, folder):
    """Both figures, of what was measured."""
    with plt.rc_context(STYLE):
        if len(results.speed):
            save(draw_speed(results, all_scenes(settings)), results.moments, folder / "bench-speed.png")
        if len(results.error):
            save(draw_errors(results, settings), results.error, folder / "bench-error.png")


def save(figure, table, path):
    about = table[["cpu", "commit"]].drop_duplicates().to_numpy()
    figure.suptitle("; ".join(f"{cpu}, commit {commit[:7]}" for cpu, commit in about), fontsize=9, color="0.35")
    figure.savefig(path, dpi=110)
    plt.close(figure)


def draw_speed(results, scenes):
    """A line for each moment, with all rounds of every code (open: one core, full: two)."""
    moments = list(each_moment(results, scenes))
    figure, axis = plt.subplots(figsize=(10, max(4, 1.8 + 0.26 * len(moments))), constrained_layout=True)
    for code, colour in COLOURS.items():
        for threads, face in ((1, "white"), (2, colour)):
            rates = [results.rates(at.scene, at.moment, code, threads) / 1e6 for _, at in moments]
            points = [(rate, line) for line, each in enumerate(rates) for rate in each]
            if points:
                label = f"{CODES[code].name}, {threads} core{'s' * (threads - 1)}"
                axis.plot(*zip(*points), "o", color=colour, markerfacecolor=face, markersize=5, label=label)
    axis.set(xlabel="million contact updates a second", xscale="log", yticks=range(len(moments)))
    labels = [f"{scenes[at.scene].title if at.scene in scenes else at.scene}; {at.moment}" for _, at in moments]
    axis.set_yticklabels(labels, fontsize=8)
    axis.invert_yaxis()
    plain_numbers(axis.xaxis)
    axis.grid(alpha=0.25)
    axis.legend(fontsize=8, ncols=2, loc="upper center", bbox_to_anchor=(0.3, -0.05))
    return figure


def draw_errors(results, settings):
    """A panel for each quantity against the step, and the ledger's error against the cost of a run."""
    panels, titles = curves(results), {name: scene.title for name, scene in errors.scenes(settings).items()}
    figure, axes = plt.subplots(1, len(panels) + 1, figsize=(4 * len(panels) + 4, 4.2), constrained_layout=True)
    for axis, ((name, quantity), (steps, error)) in zip(axes, panels.items()):
        axis.loglog(steps, error, "o-", color=COLOURS["engine"], label="root mean square")
        middle, (slope, wrong) = len(steps) // 2, errors.order(steps, error)
        axis.loglog(steps, error[middle] * (steps / steps[middle]) ** 2, ":", color="0.4", label="second order")
        if np.isfinite(slope):
            fitted = f"order {slope:.2f} ± {wrong:.2f}, {errors.FITTED[0]:g} to {errors.FITTED[1]:g} $t_0$"
            axis.plot([], [], " ", label=fitted)
        rows = results.error[results.error.scene == name]
        for step in rows[rows.refused.notna()].step.unique():
            axis.axvspan(0.95 * step, 1.15 * step, color="0.85", label="refused")
        decorate(axis, f"{titles[name]}: {QUANTITIES[quantity]}", "time step  [$t_0$]")
    for name, rows in results.error[results.error.ledger.notna()].groupby("scene", sort=False):
        cost, (steps, error) = rows.groupby("step").seconds.mean(), errors.curve(rows, "ledger")
        axes[-1].loglog(cost[steps], error, "o-", label=titles[name])
        for step, y in zip(steps, error):
            axes[-1].annotate(f" {step:g} $t_0$", (cost[step], y), fontsize=8)
    decorate(axes[-1], "ledger's largest error against cost", "seconds a run")
    return figure


def decorate(axis, title, x):
    axis.set_title(title, fontsize=10)
    axis.set_xlabel(x)
    plain_numbers(axis.xaxis)
    axis.grid(alpha=0.25)
    axis.legend(fontsize=8)


def plain_numbers(axis):
    """1, 2 and 5 of each decade, written out."""
    axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:,.6g}"))
    axis.set_minor_formatter(NullFormatter())
