"""What this study's figures have in common."""

import numpy as np

from ....figures.panels import OURS, PAPER, legend, letter, panels
from ....theory.compression import compressive_strength, compressive_strength_dense

__all__ = ["LARGER", "OURS", "PAPER", "colours_of", "legend", "letter", "panels", "pressure_axes", "draw_formulae"]

LARGER = "#c62828"  # the same with more grains
_COLOURS = ("#2166ac", "#1b8a8f", "#e08214", "#8c5a2b", "#c62828", "#4d4d4d")


def colours_of(groups):
    """A colour for each of the groups, in their order."""
    picks = np.linspace(0, len(_COLOURS) - 1, len(groups)).round().astype(int) if len(groups) > 1 else [4]
    return [_COLOURS[pick] for pick in picks]


def pressure_axes(axes):
    """Logarithmic axes of pressure against filling factor."""
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel("filling factor $\\phi$")
    axes.set_ylabel("pressure $P$  [Pa]")


def draw_formulae(axes, scale, low, high, dense=True, **options):
    """K13 eq 25 dashed, and T23's formula dotted, between two filling factors."""
    style = {"color": PAPER, "zorder": 1, **options}
    filling = np.geomspace(low, min(high, 0.66), 200)
    axes.plot(filling, compressive_strength(filling, scale), "--", label="K13 eq 25", **style)
    if dense:
        axes.plot(filling, compressive_strength_dense(filling, scale), ":", label="Tatsuuma et al. (2023)", **style)
