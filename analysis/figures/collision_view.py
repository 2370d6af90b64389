"""A state of a collision seen along z, as a panel of a figure: grains coloured by the aggregate they come from."""

import numpy as np

from .grain_colours import AGGREGATE_COLOURS
from .sphere_raster import paint_spheres

PIXELS = 420  # across a panel
MICRO = 1e6


def reach(state, held=0.95):
    """Half width [m] of a square around the origin that holds this fraction of a state's grains."""
    return float(np.quantile(np.abs(state.position[:, :2]).max(axis=1), held))


def draw_view(axes, state, unit, half, centre=(0.0, 0.0, 0.0)):
    """A StateArrays in a square of half width `half`, in units of `unit` [m], around `centre` [m], with its time; without ticks."""
    window, pixel = (-half, half, -half, half), 2 * half / PIXELS
    colour = np.array(AGGREGATE_COLOURS)[state.aggregate]
    image = paint_spheres((state.position - centre) / unit, state.radius / unit, colour, window, pixel, fading=half)
    axes.imshow(image, extent=window, origin="lower", interpolation="antialiased")
    axes.text(0.03, 0.97, rf"{state.time * MICRO:.2f} $\mu$s", transform=axes.transAxes, va="top", fontsize=9)
    axes.set_xticks([])
    axes.set_yticks([])
    axes.spines[:].set_visible(True)
    axes.spines[:].set_color("0.75")
