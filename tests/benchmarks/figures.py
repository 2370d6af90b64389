"""The figures of the bench: contact updates a second of every code at each moment (bench-speed.png), and error against step and cost (bench-error.png)."""

import errors
import matplotlib
import numpy as np
from codes import CODES
from measured_scenes import all_scenes
from report import QUANTITIES, curves, each_moment

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter  # noqa: E402

COLOURS = {
    "engine": "#c1272d",
    "engine-avx2": "#d98880",
    "engine-portable": "#e8c4c0",
    "functors": "#1b8a8f",
    "stock": "#1f5fa8",
    "lammps": "#f2a134",
    "liggghts": "#8c4a9e",
}
STYLE = {"axes.spines.top": False, "axes.spines.right": False, "legend.frameon": False, "font.size": 10}


def draw(results, settings, folder):
    """Both figures, of what was measured."""
    with plt.rc_context(STYLE):
        if len(results.speed):
            save(draw_speed(results, all_scenes(settings)), results.moments, folder / "bench-speed.png")
        if len(results.error):
            save(draw_errors(results, settings), results.error, folder / "bench-error.png")


def save(figure, table, path):
    about = table[["cpu", "commit"]].drop_duplicates()
    figure.suptitle(
        "; ".join(f"{cpu}, commit {commit[:7]}" for cpu, commit in about.to_numpy()), fontsize=9, color="0.35"
    )
    figure.savefig(path, dpi=110)
    plt.close(figure)


def draw_speed(results, scenes):
    """A line for each moment, with all rounds of every code (open: one core, full: two); and a panel for each collision that was measured on its way."""
    moments = list(each_moment(results, scenes))
    through = [name for name in scenes if scenes[name].through and name in set(results.moments.scene)]
    columns = 1 + bool(through)
    figure = plt.figure(figsize=(8 + 5 * bool(through), max(4, 1.2 + 0.3 * len(moments))), constrained_layout=True)
    grid = figure.add_gridspec(max(1, len(through)), columns, width_ratios=(8, 5)[:columns])
    if moments:
        draw_moments(figure.add_subplot(grid[:, 0]), results, scenes, moments)
    for k, name in enumerate(through):
        draw_through(figure.add_subplot(grid[k, 1]), results, name, scenes[name])
    return figure


def draw_moments(axis, results, scenes, moments):
    for code, colour in COLOURS.items():
        for threads, face in ((1, "white"), (2, colour)):
            rates = [results.rates(at.scene, at.moment, code, threads) / 1e6 for _, at in moments]
            points = [(rate, line) for line, each in enumerate(rates) for rate in each]
            if points:
                label = f"{CODES[code].name}, {threads} core{'s' * (threads - 1)}"
                axis.plot(*zip(*points), "o", color=colour, markerfacecolor=face, markersize=5, label=label)
    axis.set(xlabel="million contact updates a second", xscale="log", yticks=range(len(moments)))
    title = {name: scene.title for name, scene in scenes.items()}
    axis.set_yticklabels([f"{title.get(at.scene, at.scene)}; {at.moment}" for _, at in moments], fontsize=8)
    axis.invert_yaxis()
    plain_numbers(axis.xaxis)
    axis.grid(alpha=0.25)
    axis.legend(fontsize=7.5, ncols=2, loc="upper center", bbox_to_anchor=(0.3, -0.04))


def draw_through(axis, results, name, scene):
    """Rates in the parts of a collision (lines), and contacts at their ends (dotted)."""
    parts = results.moments[results.moments.scene == name].iloc[1:]
    ends = np.array([0.0, *parts.until]) * 1e9
    for threads, line in ((1, "-"), (2, "--")):
        flying, *rates = (results.rate(name, moment, "engine", threads).median / 1e6 for moment in scene.moments)
        label = f"{threads} core{'s' * (threads - 1)}"
        axis.stairs(rates, ends, color=COLOURS["engine"], linestyle=line, label=label)
        axis.axhline(0.75 * flying, color="0.6", linewidth=0.8, linestyle=line, label=f"75 % of the flight, {label}")
    axis.set(xlabel="time [ns]", ylabel="million contact updates a second", title=scene.title)
    axis.set_ylim(0, None)
    axis.grid(alpha=0.25)
    axis.legend(loc="lower left", fontsize=8)
    contacts = axis.twinx()
    contacts.plot((ends[1:] + ends[:-1]) / 2, parts.contacts / 1e3, ".:", color=COLOURS["stock"])
    contacts.set_ylabel("thousand contacts at a part's end (dotted)", color=COLOURS["stock"])
    contacts.set_ylim(0, 1.15e-3 * parts.contacts.max())


def draw_errors(results, settings):
    """A panel for each quantity against the step, and the ledger's error against the cost of a run."""
    of_each, titles = curves(results), {name: scene.title for name, scene in errors.scenes(settings).items()}
    panels = [*of_each.items()]
    figure, axes = plt.subplots(1, len(panels) + 1, figsize=(4 * len(panels) + 4, 4.2), constrained_layout=True)
    for axis, ((name, quantity), (steps, error)) in zip(axes, panels):
        axis.loglog(steps, error, "o-", color=COLOURS["engine"], label="root mean square")
        middle = len(steps) // 2
        axis.loglog(steps, error[middle] * (steps / steps[middle]) ** 2, ":", color="0.4", label="second order")
        slope, wrong = errors.order(steps, error)
        if np.isfinite(slope):
            axis.plot(
                [],
                [],
                " ",
                label=f"order {slope:.2f} ± {wrong:.2f}, {errors.FITTED[0]:g} to {errors.FITTED[1]:g} $t_0$",
            )
        rows = results.error[results.error.scene == name]
        for step in rows[rows.refused.notna()].step.unique():
            axis.axvspan(0.95 * step, 1.15 * step, color="0.85", label="refused")
        axis.set_xlabel("time step  [$t_0$]")
        decorate(axis, f"{titles[name]}: {QUANTITIES[quantity]}")
        axis.legend(fontsize=8)
    for name, rows in results.error[results.error.ledger.notna()].groupby("scene", sort=False):
        cost, (steps, error) = rows.groupby("step").seconds.mean(), errors.curve(rows, "ledger")
        axes[-1].loglog(cost[steps], error, "o-", label=titles[name])
        for step in steps:
            axes[-1].annotate(f" {step:g} $t_0$", (cost[step], error[steps == step][0]), fontsize=8)
    axes[-1].set_xlabel("seconds a run")
    decorate(axes[-1], "ledger's largest error against cost")
    axes[-1].legend(fontsize=8)
    return figure


def decorate(axis, title):
    axis.set_title(title, fontsize=10)
    plain_numbers(axis.xaxis)
    axis.grid(alpha=0.25)


def plain_numbers(axis):
    """1, 2 and 5 of each decade, written out."""
    axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:,.6g}"))
    axis.set_minor_formatter(NullFormatter())
