"""What this study's figures have in common."""

import numpy as np

from ....figures.panels import OURS, PAPER, legend, letter, panels, scatter_of_seeds, size_colours, velocity_axis
from .. import paper

ELASTIC, RIGID = "#6b8fb5", "#b58a5a"
# None of them a size's.
FILLING_COLOURS = ("#4a7a1e", "#b8358b", "#555555", "#3b3b8f")
MEGA = 1e6

__all__ = [
    "ELASTIC",
    "FILLING_COLOURS",
    "MEGA",
    "OURS",
    "PAPER",
    "RIGID",
    "filling_text",
    "fit_text",
    "is_papers_velocity",
    "legend",
    "letter",
    "main_filling",
    "of_main_filling",
    "of_other_filling",
    "panels",
    "scatter_of_seeds",
    "size_colours",
    "velocity_axis",
]


def filling_text(filling, velocity=None):
    """Filling and velocity for a figure's corner."""
    return f"filling {filling:g}" + ("" if velocity is None else f", {velocity:.4g} m/s")


def main_filling(results):
    """The filling factor that A24 shows most: 0.4, or the largest there is."""
    return 0.4 if 0.4 in results.by_filling else max(results.by_filling)


def fit_text(values, limits):
    """Moduli [MPa] and delta_offset [grain radii] of a joint_fit.JointFit (values and limits in SI units but for the offset) for
    a legend; only E*'s lower limit where it has no upper one."""
    sigma, young, offset = values
    bounded = np.isfinite(limits[1][1])
    text = f"{young / MEGA:.3g} MPa" if bounded else f"{limits[1][0] / MEGA:.2g} MPa or more"
    return f"{sigma / MEGA:.3g} MPa, {text}, {offset:.2f} $r$"


def is_papers_velocity(velocity):
    """Whether it is 10^0.5 m/s, for which A24 gives its lines."""
    return abs(velocity / paper.VELOCITY - 1.0) < 1e-3


def of_main_filling(make, needs_offset=True):
    """Figure of the main filling from make(results, filling); None where it has no delta_offset but needs one."""

    def figure(results):
        return _made(make, results, main_filling(results), needs_offset)

    return figure


def of_other_filling(make, needs_offset=True):
    """Figure of the second filling, the one that A24 shows in Figs. 6 and 9; None where there is one only."""

    def figure(results):
        others = [f for f in results.by_filling if f != main_filling(results)]
        if not others:
            return None
        return _made(make, results, 0.3 if 0.3 in others else others[0], needs_offset)

    return figure


def _made(make, results, factor, needs_offset):
    filling = results.by_filling[factor]
    return None if needs_offset and filling.offset is None else make(results, filling)
