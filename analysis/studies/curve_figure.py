"""A quantity against one of the things it depends on, with error bars: what most figures of studies are."""

from dataclasses import dataclass, field
from typing import Callable

import numpy as np
from matplotlib import colormaps

from ..figures.panels import PAPER, legend, letter, panels
from ..figures.style import styled
from .levels import level
from .runs import alike, select

_COLOURS = ("#2166ac", "#1b8a8f", "#e08214", "#c62828", "#7b3fa0", "#8c5a2b", "#111111")
MARKERS = "osD^vP"


def colours(values):
    """{value: colour} of all values of a level in a study: one colour means one value in all its figures."""
    values = sorted(set(values))
    if len(values) <= len(_COLOURS):
        return dict(zip(values, _COLOURS))
    return dict(zip(values, colormaps["turbo"](np.linspace(0.05, 0.95, len(values)))))


def points(axes, x, estimates, colour, label=None, marker="o", line="-", scale=1.0):
    """Estimates or Fractions at x (K,), with bars: standard errors, or intervals of fractions; open where the error is not known.

    label gets the number of pairs."""
    value = np.array([estimate.value for estimate in estimates]) / scale
    errors = [_bar(estimate) for estimate in estimates]
    known = np.array([error is not None for error in errors], dtype=bool)
    bars = np.array([error or (0.0, 0.0) for error in errors]).T / scale
    if label is not None:
        label += f" ({_pairs(estimates)})"
    axes.plot(x, value, line, color=colour, lw=1.2)
    axes.errorbar(x, value, bars, fmt=marker, color=colour, capsize=3, markersize=5, mfc="white", label=label)
    axes.plot(np.asarray(x)[known], value[known], marker, color=colour, markersize=5, zorder=3)


@dataclass(frozen=True)
class CurveFigure:
    """name, caption (as definition.StudyFigure); y: names of the quantities (one, or several: a row of panels each); x: the level on the
    axis; colour, panel: levels that tell curves and panels apart (''); where: values of other levels; logarithmic: of 'x', 'y', 'xy', '';
    y_label; limits: of y; level_line: where to draw a thin line (0.0, say); paper: (axes, {level: value} of the panel) -> None draws
    what the paper prints. vector as in StudyFigure."""

    name: str
    caption: str
    y: tuple
    x: str
    colour: str = ""
    panel: str = ""
    where: dict = field(default_factory=dict)
    logarithmic: str = ""
    y_label: str = ""
    limits: tuple = None
    level_line: float = None
    paper: Callable = None
    vector: bool = True

    def draw(self, results):
        """The Figure of definition.Results; None where there is nothing to draw."""
        return _draw(self, results)


@styled
def _draw(figure, results):
    names = (figure.y,) if isinstance(figure.y, str) else figure.y
    series = [select(results[name].values, **figure.where) for name in names]
    shown = sorted({v for own in series for v in own.index.get_level_values(figure.panel)}) if figure.panel else [None]
    if not any(map(len, series)) or not shown:
        return None
    drawn, axes = panels(len(names), len(shown), 4.4, 3.8)
    for name, own, row in zip(names, series, axes):
        for value, place in zip(shown, row):
            part = own if value is None else select(own, **{figure.panel: value})
            _curves(place, figure, results[name], part, results.table)
            _dress(place, figure, value)
        row[0].set_ylabel(figure.y_label or f"{name} [{results[name].unit}]".replace(" []", ""))
    legend(axes[0, 0], fontsize=8)
    letter(axes, "")
    return drawn


def _curves(axes, figure, quantity, series, table):
    """The curves of one panel."""
    if not figure.colour:
        return _curve(axes, figure, quantity, series, _COLOURS[-1], quantity.name, MARKERS[0])
    known = series.index.get_level_values(figure.colour)
    palette = colours(table[figure.colour] if figure.colour in table else known)
    for k, value in enumerate(sorted(set(known))):
        colour = next(own for key, own in palette.items() if alike([key], value)[0])
        own = select(series, **{figure.colour: value})
        _curve(axes, figure, quantity, own, colour, level(figure.colour).label(value), MARKERS[k % len(MARKERS)])


def _curve(axes, figure, quantity, series, colour, label, marker):
    series = series.sort_index()
    x = series.index.get_level_values(figure.x).to_numpy(dtype=float) / level(figure.x).scale
    points(axes, x, series.to_list(), colour, label, marker, scale=quantity.scale)


def _dress(axes, figure, value):
    if figure.level_line is not None:
        axes.axhline(figure.level_line, color="0.6", lw=0.8, zorder=0)
    if "x" in figure.logarithmic:
        axes.set_xscale("log")
        axes.xaxis.set_major_formatter(lambda number, _: f"{number:.3g}")
    if "y" in figure.logarithmic:
        axes.set_yscale("log")
    if figure.limits:
        axes.set_ylim(*figure.limits)
    if figure.paper:
        figure.paper(axes, {} if value is None else {figure.panel: value})
    if value is not None:
        axes.set_title(level(figure.panel).label(value), fontsize=10)
    axes.set_xlabel(level(figure.x).axis())


def _bar(estimate):
    """(below, above) of an estimate; None where its error is not known."""
    if estimate.error is not None:
        return estimate.error, estimate.error
    low, high = estimate.interval()
    return None if low is None else (estimate.value - low, high - estimate.value)


def _pairs(estimates):
    numbers = sorted({estimate.pairs for estimate in estimates})
    return f"{numbers[0]:g}" if len(numbers) == 1 else f"{numbers[0]:g} to {numbers[-1]:g}"


__all__ = ["PAPER", "CurveFigure", "colours", "points"]
