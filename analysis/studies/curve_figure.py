"""A quantity against one of the things it depends on, with error bars: what most figures of studies are."""

from dataclasses import dataclass, field
from typing import Callable

import numpy as np
from matplotlib import colormaps
from matplotlib.ticker import LogLocator, NullFormatter
from matplotlib.transforms import offset_copy

from ..figures.style import legend, letter, panels, styled
from ..runs.format import COLOURS as CHANNEL_COLOURS
from .levels import level
from .runs import select

# None of them the paper's (figures.style.PAPER).
COLOURS = ("#2166ac", "#1b8a8f", "#e08214", "#c62828", "#8c5a2b", "#d16ba5", "#111111")
MARKERS, LINES = "osD^vP", ("-", "--", "-.", ":")
WIDEST = 3  # panels beside each other; four where there are no more
MOST_ASIDE = 20.0  # points between the first curve and the last: within the margin of the axes


def palette(results, name):
    """{value: colour} of all values that a level has in a study's quantities: one colour means one value in all its figures, an energy channel
    has its own in all studies, and colours are apart as far as there are any."""
    indices = (quantity.values.index for quantity in results.quantities.values())
    values = {value for index in indices if name in index.names for value in index.get_level_values(name)}
    if values <= set(CHANNEL_COLOURS):
        return {value: CHANNEL_COLOURS[value] for value in sorted(values)}
    many = len(values) > len(COLOURS)
    return dict(zip(sorted(values), colormaps["plasma"](np.linspace(0.0, 0.85, len(values))) if many else COLOURS))


def points(axes, x, estimates, colour, label=None, marker="o", line="-", scale=1.0, aside=0.0):
    """Estimates or Fractions at x (K,), with bars: standard errors, or intervals of fractions; open where the error is not known.
    aside: drawn so far to the right of x [points]."""
    value = np.array([estimate.value for estimate in estimates]) / scale
    errors = [_bar(estimate) for estimate in estimates]
    known = np.array([error is not None for error in errors], dtype=bool)
    bars = np.array([error or (0.0, 0.0) for error in errors]).T / scale
    place = {"transform": offset_copy(axes.transData, axes.figure, aside, units="points"), "color": colour}
    # Limits as if at x: matplotlib 3.10.9 leaves out what is moved.
    good = np.isfinite(value)
    for ends in (value - bars[0], value + bars[1]) if len(value) else ():
        axes.update_datalim(np.column_stack([np.asarray(x, dtype=float), ends])[good])
    axes.plot(x, value, linestyle=line or "none", lw=1.2, **place)
    axes.errorbar(x, value, bars, fmt=marker, capsize=3, markersize=5, mfc="white", label=label, **place)
    axes.plot(np.asarray(x)[known], value[known], marker, markersize=5, zorder=3, **place)


@dataclass(frozen=True)
class CurveFigure:
    """name, caption (as definition.StudyFigure); y: name of the quantity; x: the level on the axis (words as `where` lists them); colour,
    panel: levels that tell curves and panels apart (''); where: values of other levels, or a tuple of those of a level that are drawn;
    logarithmic: of 'x', 'y', 'xy', ''; y_label; limits: of y; level_line: where to draw a thin line (0.0, say); line: '-' where points are
    joined, '' where not; apart: between curves, at most [points], whose dashes differ then, so that none hides an equal one; paper: (axes, {level: value}
    of the panel) -> None draws what the paper prints."""

    name: str
    caption: str
    y: str
    x: str
    colour: str = ""
    panel: str = ""
    where: dict = field(default_factory=dict)
    logarithmic: str = ""
    y_label: str = ""
    limits: tuple = None
    level_line: float = None
    line: str = "-"
    apart: float = 0.0
    paper: Callable = None
    vector = True  # as in StudyFigure

    @styled
    def draw(self, results):
        """The Figure of definition.Results; None where there is nothing to draw."""
        quantity = results[self.y]
        series = select(quantity.values, **self.where)
        if not len(series):
            return None
        shown = list(dict.fromkeys(series.index.get_level_values(self.panel))) if self.panel else [None]
        shown = shown if isinstance(shown[0], str) else sorted(shown, key=lambda value: (value is None, value))
        columns = len(shown) if len(shown) <= WIDEST + 1 else WIDEST
        drawn, axes = panels(-(-len(shown) // columns), columns, 4.4, 3.8)
        flat = axes.ravel()
        of_points = []
        for value, place in zip(shown, flat):
            part = series if value is None else select(series, **{self.panel: value})
            of_points += [place] * (part.index.get_level_values(self.x).nunique() == 1)
            _curves(place, self, quantity, part, results)
            _dress(place, self, value, part, results.independent)
        for place in flat[len(shown) :]:
            place.set_axis_off()
        _share_y(flat[: len(shown)], self.limits or (None, None))
        _widen(of_points, [place for place in flat[: len(shown)] if place not in of_points])
        for row in axes:
            row[0].set_ylabel(self.y_label or f"{self.y}{quantity.in_unit}")
        _legends(flat)
        letter(flat[: len(shown)], "")
        return drawn


def _legends(flat):
    """A legend in the panel that names most, and in those that name something else."""
    named = lambda place: {text.partition(",")[0] for text in place.get_legend_handles_labels()[1]}
    most = max(flat, key=lambda place: len(named(place)))
    for place in flat:
        if place is most or not named(place) <= named(most):
            legend(place, fontsize=8)


def _share_y(places, limits):
    """One scale for all panels of a quantity."""
    low, high = zip(*(place.get_ylim() for place in places))
    for place in places:
        place.set_ylim(min(low) if limits[0] is None else limits[0], max(high) if limits[1] is None else limits[1])


def _widen(of_points, others):
    """Panels with one value of x have the scale of the others."""
    if others:
        low, high = zip(*(place.get_xlim() for place in others))
        for place in of_points:
            place.set_xlim(min(low), max(high))


def _curves(axes, figure, quantity, series, results):
    """The curves of one panel."""
    if not figure.colour:
        return _curve(axes, figure, quantity, series, COLOURS[-1])
    values = sorted(set(series.index.get_level_values(figure.colour)))
    curves = {value: select(series, **{figure.colour: value}) for value in values}
    colour_of = palette(results, figure.colour)
    for k, (value, own) in enumerate(curves.items()):
        # the title of a panel has it, and a legend is of all panels
        number = "" if figure.panel else f", {pairs_text(own, results.independent)}"
        label = level(figure.colour).label(value) + number
        aside = min(figure.apart, MOST_ASIDE / len(curves)) * (k - (len(curves) - 1) / 2)
        # markers as colours are the same in all panels
        _curve(axes, figure, quantity, own, colour_of[value], label, list(colour_of).index(value), aside)


def _curve(axes, figure, quantity, series, colour, label=None, k=0, aside=0.0):
    series = series.sort_index()
    if "y" in figure.logarithmic:
        series = series[[estimate.value > 0 for estimate in series]]
    x, words = series.index.get_level_values(figure.x), figure.where.get(figure.x)
    if isinstance(words, tuple) and isinstance(words[0], str):
        axes.set_xticks(range(len(words)), [level(figure.x).text(word).replace(" ", "\n") for word in words])
        axes.set_xlim(-0.5, len(words) - 0.5)
        x = [words.index(word) for word in x]
    else:
        x = level(figure.x).of(x.to_numpy(dtype=float))
    line = LINES[k % len(LINES)] if figure.line and figure.apart else figure.line
    points(axes, x, series.to_list(), colour, label, MARKERS[k % len(MARKERS)], line, quantity.scale, aside)


def _dress(axes, figure, value, series, independent):
    """Axes, thin line, what the paper has, and the title with the number of pairs."""
    if figure.level_line is not None:
        axes.axhline(figure.level_line, color="0.6", lw=0.8, zorder=0)
    for name in figure.logarithmic:
        getattr(axes, f"set_{name}scale")("log")
    if figure.paper:
        figure.paper(axes, {} if value is None else {figure.panel: value})
    for name in figure.logarithmic:
        plain_ticks(getattr(axes, f"{name}axis"))
    title = [] if value is None else [level(figure.panel).label(value)]
    if figure.panel or not figure.colour:
        title.append(pairs_text(series, independent))
    axes.set_title(", ".join(title), fontsize=10)
    axes.set_xlabel(level(figure.x).head(math=True))


def plain_ticks(axis):
    """Ticks of a logarithmic axis at 1, 2 and 5 where it spans less than two decades, with plain numbers."""
    low, high = axis.get_view_interval()
    steps = (1, 2, 5) if high < 50 * low else (1,)
    axis.set_major_locator(LogLocator(subs=steps))
    axis.set_major_formatter(lambda number, _: f"{number:g}")
    axis.set_minor_formatter(NullFormatter())


def _bar(estimate):
    """(below, above) of an estimate; None where its error is not known."""
    if estimate.error is not None:
        return estimate.error, estimate.error
    low, high = estimate.interval()
    return None if low is None else (estimate.value - low, high - estimate.value)


def pairs_text(estimates, independent="pairs"):
    """'4 pairs' or '2 to 4 pairs' behind estimates, or of what else is independent."""
    numbers = sorted({estimate.pairs for estimate in estimates})
    if numbers == [1]:
        return f"1 {independent[:-1]}"
    return (f"{numbers[0]:g} to " if len(numbers) > 1 else "") + f"{numbers[-1]:g} {independent}"
