"""The figures of make bench."""

import errors
import matplotlib
import numpy as np
from ratios import Speeds

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter  # noqa: E402

COLOURS = {"engine": "#c1272d", "functors": "#1b8a8f", "stock": "#1f5fa8", "lammps": "#f2a134", "liggghts": "#8c4a9e"}
LABELS = {
    "engine": "JKRWadaEngine",
    "functors": "functors",
    "stock": "YADE's stock cohesive loop",
    "lammps": "LAMMPS",
    "liggghts": "LIGGGHTS",
}
THREADS = {1: dict(linestyle="-", markerfacecolor="white"), 2: dict(linestyle="--")}
PANELS = {
    "ledger": "collision: ledger's largest error / K(0)",
    "d_max": "collision: |d_max - finest| [grain radii]",
    "pair": "pair: error of the rebound speed",
}


def draw(how, found, folder):
    """bench-speed.png and bench-error.png, of the parts that were measured."""
    about = f"{found['machine']['cpu']}, {found['machine']['cores']} cores, commit {found['machine']['commit']}"
    with plt.rc_context(
        {"axes.spines.top": False, "axes.spines.right": False, "legend.frameon": False, "font.size": 10}
    ):
        if "speed" in found or "collision" in found:
            save(draw_speed(how, found), about, folder / "bench-speed.png")
        if "error" in found:
            save(draw_error(how, found["error"]), about, folder / "bench-error.png")


def save(figure, about, path):
    figure.suptitle(about, fontsize=9, color="0.35")
    figure.savefig(path, dpi=110)
    plt.close(figure)


def draw_speed(how, found):
    """A panel for the sizes and one for each collision."""
    collisions = found.get("collision", [])
    panels = len(collisions) + ("speed" in found)
    figure, axes = plt.subplots(1, panels, figsize=(6 * panels, 4.8), constrained_layout=True, squeeze=False)
    axes = list(axes[0])
    if "speed" in found:
        draw_sizes(axes.pop(0), Speeds(found["speed"]["results"], how.reference), found["speed"]["results"])
    for axis, collision in zip(axes, collisions):
        draw_collision(axis, collision)
    return figure


def draw_sizes(axis, speeds, results):
    for code in COLOURS:
        for threads, style in THREADS.items():
            radii = sorted(
                {result["radius"] for result in results if result["code"] == code and result["kind"] == "uniform"}
            )
            if not radii:
                continue
            grains = [
                speeds.find(code, threads, radius)[0]["grains"]
                for radius in radii
                if speeds.find(code, threads, radius)
            ]
            rates = [speeds.rate(code, threads, radius) for radius in radii if speeds.find(code, threads, radius)]
            median = np.array([rate.median for rate in rates]) / 1e6
            spread = np.array([[rate.median - rate.least, rate.most - rate.median] for rate in rates]).T / 1e6
            axis.errorbar(
                grains,
                median,
                spread,
                marker="o",
                color=COLOURS[code],
                capsize=2,
                markersize=5,
                label=f"{LABELS[code]}, {threads} core{'s' * (threads > 1)}",
                **style,
            )
    axis.set(
        xscale="log",
        yscale="log",
        xlabel="grains",
        ylabel="million contact updates a second",
        title="like grains, on their way to each other",
    )
    for numbers in (axis.xaxis, axis.yaxis):
        plain_numbers(numbers)
    axis.grid(alpha=0.25, which="both")
    axis.legend(fontsize=7.5, ncols=2, loc="upper center", bbox_to_anchor=(0.5, -0.14))


def draw_collision(axis, collision):
    ends = np.array([0.0] + [part["until"] for part in collision["parts"]]) * 1e9
    for threads, style in THREADS.items():
        rates = np.array([part[f"rate{threads}"] for part in collision["parts"]]) / 1e6
        axis.stairs(
            rates,
            ends,
            color=COLOURS["engine"],
            linestyle=style["linestyle"],
            label=f"{threads} core{'s' * (threads > 1)}",
        )
        axis.axhline(
            0.75 * collision["before"][threads] / 1e6,
            color="0.6",
            linewidth=0.8,
            linestyle=style["linestyle"],
            label="75 % of that at the usual speed" if threads == 1 else None,
        )
    axis.set(
        xlabel="time [ns]",
        ylabel="million contact updates a second",
        title=f"through a collision, R = {collision['radius']:g} r, {collision['speed']:g} m/s",
        ylim=(0, 1.15e-6 * max(part[f"rate{threads}"] for part in collision["parts"] for threads in THREADS)),
    )
    axis.grid(alpha=0.25)
    axis.legend(loc="lower left", fontsize=8)
    contacts = axis.twinx()
    contacts.plot(
        (ends[1:] + ends[:-1]) / 2,
        [part["contacts"] / 1e3 for part in collision["parts"]],
        ".:",
        color=COLOURS["stock"],
    )
    contacts.set_ylabel("thousand contacts at a part's end (dotted)", color=COLOURS["stock"])
    contacts.set_ylim(0, 1.15e-3 * max(part["contacts"] for part in collision["parts"]))


def draw_error(how, found):
    figure, axes = plt.subplots(1, 4, figsize=(16, 4.2), constrained_layout=True)
    curves = errors.curves(how, found)
    for axis, (name, title) in zip(axes, PANELS.items()):
        steps, error, order, wrong = curves[name]
        axis.loglog(steps, error, "o-", color=COLOURS["engine"], label="root mean square")
        if np.isfinite(order):
            x = np.array(how.fit)
            within = (steps >= x[0]) & (steps <= x[1])
            height = np.exp(np.mean(np.log(error[within]) - order * np.log(steps[within])))
            axis.loglog(
                x, height * x**order, "-", color="0.3", linewidth=4, alpha=0.3, label=f"order {order:.2f} ± {wrong:.2f}"
            )
        middle = len(steps) // 2
        axis.loglog(steps, error[middle] * (steps / steps[middle]) ** 2, ":", color="0.4", label="second order")
        refused = [
            step
            for step, runs in (found["pair"] if name == "pair" else found["collision"]).items()
            if isinstance(runs, str) or isinstance(runs[0], dict) and "refused" in runs[0]
        ]
        for step in refused:
            axis.axvspan(0.95 * step, 1.15 * step, color="0.85", label="refused")
        axis.set(xlabel="time step  [$t_0$]", title=title)
        plain_numbers(axis.xaxis)
        axis.title.set_fontsize(10)
        axis.legend(fontsize=8)
        axis.grid(alpha=0.25)
    draw_cost(axes[3], found)
    return figure


def draw_cost(axis, found):
    ran = {step: runs for step, runs in found["collision"].items() if not any("refused" in run for run in runs)}
    cost = [np.mean([run["seconds"] for run in runs]) for runs in ran.values()]
    error = [errors.rms([run["closure"] for run in runs]) for runs in ran.values()]
    axis.loglog(cost, error, "o-", color=COLOURS["engine"])
    for x, y, step in zip(cost, error, ran):
        axis.annotate(f" {step:g} $t_0$", (x, y), fontsize=8)
    axis.set(xlabel="seconds a collision", title="ledger's largest error / K(0) against cost")
    plain_numbers(axis.xaxis)
    axis.title.set_fontsize(10)
    axis.grid(alpha=0.25)


def plain_numbers(axis):
    """1, 2 and 5 of each decade, written out."""
    axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:,.6g}"))
    axis.set_minor_formatter(NullFormatter())
