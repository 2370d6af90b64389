"""What this study's figures have in common: colours of T_vis and B_off, the runs that A22 shows most."""

import numpy as np
from matplotlib import colormaps

from ....figures.panels import PAPER, legend, letter, panels, velocity_axis
from ....runs.table import run_folder
from ....statistics import mean_and_error
from .. import paper
from ..impact_mean import offsets_text, spans
from ..results import over_offsets, picoseconds

__all__ = [
    "PAPER",
    "comparable",
    "draw_curve",
    "impact_colour",
    "legend",
    "letter",
    "mean_points",
    "one_run_each",
    "own_times",
    "panels",
    "run_folder",
    "size_label",
    "threshold_points",
    "time_colours",
    "time_label",
    "velocity_axis",
]

_COLOURS = ("#2166ac", "#1b8a8f", "#e08214", "#c62828", "#7b3fa0", "#8c5a2b")


def time_colours(table):
    """{T_vis [s]: colour} of a table's runs, no drag in blue; from a colour map where they are more than _COLOURS."""
    times = sorted(set(table.viscoelasticTime.round(16)))
    colours = _COLOURS if len(times) <= len(_COLOURS) else colormaps["turbo"](np.linspace(0.05, 0.95, len(times)))
    return dict(zip(map(float, times), colours))


def time_label(time):
    """Name of T_vis in a legend."""
    return f"$T_{{vis}}$ = {picoseconds(time)} ps"


def impact_colour(square):
    """Colour of B_off^2, from dark (head-on) to light."""
    return tuple(np.array((0.10, 0.15, 0.40)) + square * np.array((0.80, 0.60, 0.10)))


def size_label(grains, curves):
    """Words on the size of the aggregates of some Curves, with their offsets where these are not the paper's."""
    numbers = sorted({offsets_text(curve.offsets) for curve in curves})
    return f"{grains} grains each" + (numbers[0] if len(numbers) == 1 else ", unlike offsets")


def comparable(results):
    """(Results, words): over the offsets that all sizes have at the T_vis that several have, so that they can be compared."""
    times = [time for _, time in results.growth]
    several = [growth.offsets for (_, time), growth in results.growth.items() if times.count(time) > 1]
    if len(set(several)) < 2:
        return results, ""
    common = sorted(set.intersection(*map(set, several)))
    return (over_offsets(results, common), f"{len(common)} offsets") if spans(common) else (results, "unlike offsets")


def mean_points(axes, x, samples, colour, label=None, marker="o", line="-"):
    """Means with standard errors of samples [(n,)] at x (K,), joined by a line."""
    means, errors = zip(*(mean_and_error(sample) for sample in samples))
    errors = [error or 0.0 for error in errors]
    axes.errorbar(x, means, yerr=errors, fmt=marker + line, color=colour, markersize=4, capsize=2, lw=1.3, label=label)


def draw_curve(axes, curve, colour, label, scale=1.0):
    """Means of a Curve with errors against velocity over scale [m/s]; open where the error is not known."""
    x, known = curve.velocities / scale, np.isfinite(curve.error)
    axes.errorbar(
        x,
        curve.mean,
        np.nan_to_num(curve.error),
        fmt="o-",
        color=colour,
        capsize=3,
        mfc=colour if known.all() else "white",
        label=label,
    )
    axes.plot(x[known], curve.mean[known], "o", color=colour, zorder=3)


def threshold_points(axes, x, growths, colour, label):
    """v_fra of Growths that have one, at x (K,); open, and without a bar, where its error is not known."""
    values = [growth.v_fra for growth in growths]
    axes.errorbar(
        x, values, [g.v_fra_error or 0.0 for g in growths], fmt="o-", color=colour, capsize=3, mfc="white", label=label
    )
    known = [k for k, growth in enumerate(growths) if growth.v_fra_error]
    axes.plot([x[k] for k in known], [values[k] for k in known], "o", color=colour, zorder=3)


def one_run_each(results):
    """[(T_vis, row)] of the collision that A22 shows most (50.1 m/s, B_off^2 = 3/12) at the largest size, the first seed of
    each T_vis; [] without any."""
    runs = results.reference
    runs = runs[runs.grains == results.reference_size].sort_values("seed", kind="stable") if len(runs) else runs
    times = runs.viscoelasticTime.round(16)
    return [(float(t), next(runs[times == t].itertuples())) for t in sorted(times.unique())]


def own_times(times, row):
    """The paper's times [s] for aggregates of another size: in proportion to their characteristic radius; those of the
    paper's own number of grains as they are. row: of the table."""
    if row.grains == paper.GRAINS:
        return times
    scale = row.characteristic_radius / row.grain_radius / np.mean(paper.CHARACTERISTIC_RADII)
    return tuple(float(time * scale) for time in times)
