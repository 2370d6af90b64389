"""Common look of the figures: sizes and fonts (colours of grains: grain_colours; of the channels: runs.format)."""

import io

from matplotlib import rc_context
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

NANO = 1e9

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

    def figure_of(*arguments, **options):
        with rc_context(_SETTINGS):
            return make(*arguments, **options)

    figure_of.__name__, figure_of.__doc__ = make.__name__, make.__doc__
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


def run_title(run, addition=None):
    """Short description of a run from its parameters; empty when they say nothing known; with an addition."""
    p = run.parameters
    known = [
        ("filling", "filling {}"),
        ("radius", "aggregate radius {} $r$"),
        ("grains", "{} grains per aggregate"),
        ("velocity", "{} m/s"),
        ("impact", "impact {}"),
    ]
    parts = []
    for key, text in known:
        value = p.get(key)
        if isinstance(value, bool) or not isinstance(value, (int, float)) or (key == "impact" and not value):
            continue
        parts.append(text.format(f"{value:,}" if isinstance(value, int) else f"{value:.4g}"))
    return ", ".join(parts + [addition] * bool(addition))
