"""Common look of the figures: sizes, fonts, panels with letters, legends, and how they are saved small."""

import io
from functools import wraps

import numpy as np
from matplotlib import rc_context
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from PIL import Image  # with which matplotlib itself writes PNGs

from ..runs.files import replacing
from ..runs.folder import shown
from ..runs.format import COLLISION

NANO = 1e9
OURS, PAPER = "#111111", "#7b3fa0"  # the colours of what is ours and what is a paper's
DOTS_PER_INCH = 80  # a gallery of all of a study's figures stays below 1.5 MB

_SETTINGS = {
    "font.size": 11,
    "axes.labelsize": 12,
    "axes.titlesize": 12,
    "legend.fontsize": 10,
    "lines.linewidth": 1.6,
    "axes.grid": False,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "savefig.dpi": 150,
}


def styled(make):
    """Decorator: make(...) -> Figure under this module's settings."""

    @wraps(make)
    def figure_of(*arguments, **options):
        with rc_context(_SETTINGS):
            return make(*arguments, **options)

    return figure_of


class _Shown(Figure):
    """A Figure that a notebook shows without pyplot."""

    def _repr_png_(self):
        content = io.BytesIO()
        self.savefig(content, format="png", dpi=100)
        return content.getvalue()


def new_figure(width, height, **options):
    """Figure [inches] that draws through Agg, without pyplot's global state."""
    figure = _Shown(figsize=(width, height), **options)
    FigureCanvasAgg(figure)
    return figure


def panels(rows, columns, width=5.2, height=4.2):
    """(figure, axes array (rows, columns))."""
    figure = new_figure(width * columns, height * rows, constrained_layout=True)
    return figure, figure.subplots(rows, columns, squeeze=False)


def letter(axes, text):
    """(a), (b), ... at the upper left of each of the axes, with `text` at the upper right of the last."""
    flat = list(np.ravel(axes))
    for place, name in zip(flat, "abcdefgh"):
        place.set_title(f"({name})" if len(flat) > 1 else "", loc="left")
    flat[-1].set_title(text, loc="right", fontsize=10, color="0.3")


def legend(axes, **options):
    """Legend without a frame, where there is something to name."""
    if axes.get_legend_handles_labels()[0]:
        axes.legend(frameon=False, **options)


def run_title(run, addition=None):
    """Short description of a run from its parameters, as far as they are known, with an addition."""
    known = {
        "filling": "filling {}",
        "radius": "radius {} $r$",
        "grains": "{} grains" + " per aggregate" * (run.kind is COLLISION),
        "velocity": "{} m/s",
        "impact": "impact {}",
        "surfaceEnergy": "$\\gamma$ = {} J/m²",
    }
    parts = []
    for name, text in known.items():
        value = shown(run.parameters, run.derived, name)
        if isinstance(value, (int, float)) and (value or name != "impact"):
            value = f"{value:,}" if isinstance(value, int) else f"{value:.4g}"
        if isinstance(value, str):
            parts.append(text.format(value))
    return ", ".join(parts + [addition] * bool(addition))


def save_small(figure, file):
    """Save a matplotlib Figure as a PNG with a palette, at less than half the size."""
    image = io.BytesIO()
    figure.savefig(image, dpi=DOTS_PER_INCH)
    small = Image.open(image).convert("RGB").quantize(256, kmeans=1, dither=Image.Dither.NONE)
    with replacing(file) as out:
        small.save(out, format="png", optimize=True)
