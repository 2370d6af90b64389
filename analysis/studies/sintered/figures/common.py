"""What this study's figures have in common: colours of beta and V_g, lines of points with errors."""

import numpy as np

from ....figures.panels import PAPER, legend, letter, panels, velocity_axis

__all__ = [
    "PAPER",
    "beta_label",
    "draw_points",
    "growth_label",
    "legend",
    "letter",
    "lines_of",
    "neck_colour",
    "order_colour",
    "panels",
    "velocity_axis",
]

_COLOURS = ("#2166ac", "#1b8a8f", "#4d9221", "#e08214", "#c62828", "#7b3fa0", "#8c5a2b", "#555555", "#c51b7d")


def neck_colour(neck):
    """Colour of beta: black when unsintered, then from blue to brown."""
    return "#111111" if not neck else _COLOURS[min(int(round(neck * 10)) - 2, len(_COLOURS) - 1)]


def order_colour(number):
    """Colour of line `number`, from 0."""
    return _COLOURS[number % len(_COLOURS)]


def beta_label(neck):
    """Name of beta in a legend."""
    return rf"$\beta$ = {neck:g}" if neck else "unsintered"


def growth_label(velocity):
    """Name of V_g in a legend."""
    return f"$V_g$ = {velocity:g} m/s" if velocity else "BCCA"


def lines_of(points, name):
    """[(value, [Point])] of points by their attribute `name`, each sorted by velocity and beta; those with more than one."""
    found = []
    for value in sorted({getattr(point, name) for point in points}):
        own = sorted((p for p in points if getattr(p, name) == value), key=lambda p: (p.velocity, p.neck))
        if len(own) > 1:
            found.append((value, own))
    return found


def draw_points(axes, x, points, quantity, colour, label=None, line="-", marker="o"):
    """Means of a quantity of points at x (K,), with standard errors; points without it are left out."""
    known = [(at, point.means[quantity]) for at, point in zip(x, points) if point.means[quantity] is not None]
    if not known:
        return
    at, pairs = zip(*known)
    mean = np.array([pair[0] for pair in pairs])
    error = [pair[1] or 0.0 for pair in pairs]
    axes.errorbar(
        at, mean, error, marker=marker, linestyle=line, color=colour, markersize=4, capsize=2, lw=1.3, label=label
    )
