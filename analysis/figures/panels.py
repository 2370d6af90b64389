"""Parts of figures of many runs: panels with letters, legends, and the two colours of what is ours and a paper's."""

import numpy as np

from .style import new_figure

# What is ours is drawn in black, what is a paper's in this colour.
OURS, PAPER = "#111111", "#7b3fa0"


def panels(rows, columns, width=5.2, height=4.2):
    """(figure, axes array (rows, columns))."""
    figure = new_figure(width * columns, height * rows, constrained_layout=True)
    return figure, figure.subplots(rows, columns, squeeze=False)


def letter(axes, text):
    """(a), (b), ... at the upper left of each of the axes, with `text` on the first."""
    flat = list(np.ravel(axes))
    for place, name in zip(flat, "abcdefgh"):
        place.set_title(f"({name})" if len(flat) > 1 else "", loc="left")
    flat[-1].set_title(text, loc="right", fontsize=10, color="0.3")


def legend(axes, **options):
    """Legend without a frame, where there is something to name."""
    if axes.get_legend_handles_labels()[0]:
        axes.legend(frameon=False, **options)
