"""Colours of grains in films and on the page that `analysis view` writes: by what, and what each colour means."""

from dataclasses import dataclass
from functools import cached_property
from typing import Callable

import numpy as np

from ..measures.fragments import grain_masses
from ..progress import progress


def _rgb(codes):
    """Colours (red, green, blue), 0 to 1, of hexadecimal codes."""
    return tuple(tuple(int(code[k : k + 2], 16) / 255 for k in (0, 2, 4)) for code in codes.split())


AGGREGATE_COLOURS = _rgb("eb992e 3d85d1")
GREY, BONDED = _rgb("bfbfbf cc4040")
PIECES = _rgb("3d85d1 eb992e 4da659 bf5999 8c734d 59b3bf")
SCALE = _rgb("440154 472d7b 3b528b 2c728e 21918c 28ae80 5ec962 addc30 fde725")  # matplotlib's viridis, without it
MOST_CONTACTS = 8
_FAST = 99.0  # percentile of the speeds at which the scale ends


@dataclass(frozen=True)
class Colouring:
    """title; colours(Exported, Range) -> (N, 3); legend(Range) -> [{"colour", "text"}, or the scale's ends {"low",
    "high"}]."""

    title: str
    colours: Callable
    legend: Callable


class Range:
    """What colours are relative to in all states of a RunFolder."""

    def __init__(self, run):
        self._states = run.states
        self.aggregates = int(run.start.aggregate.max()) + 1  # their number
        self.materials = str(run.parameters.get("material", "")).split(",")  # their names

    @cached_property
    def fastest(self):
        """The largest speed [m/s] on the scale; all states are read for it."""
        speeds = [_speed(state) for state in progress(self._states, "finding the scale")]
        return float(np.percentile(np.concatenate(speeds), _FAST)) or 1.0


def _speed(state):
    of_centre = np.average(state.velocity, axis=0, weights=grain_masses(vars(state)))
    return np.linalg.norm(state.velocity - of_centre, axis=1)


def on_scale(shares):
    """Colours (N, 3) of shares (N,) of the scale, 0 to 1 and beyond."""
    steps = np.linspace(0, 1, len(SCALE))
    return np.stack([np.interp(shares, steps, channel) for channel in np.transpose(SCALE)], axis=-1)


def _patches(colours, texts):
    return [{"colour": colour, "text": text} for colour, text in zip(colours, texts)]


def _of_table(table, numbers, beyond=None):
    """Rows of a table of colours; numbers past its end: `beyond`, or from its beginning."""
    if beyond is None:
        return np.array(table)[numbers % len(table)]
    return np.array([*table, beyond])[np.minimum(numbers, len(table))]


def _bonded(exported):
    state, bonded = exported.state, np.zeros(len(exported.state.radius), dtype=int)
    bonded[state.contact_pairs[state.contact_bonded].ravel()] = 1
    return bonded


RANKS = ("largest piece", *(f"{rank}." for rank in range(2, len(PIECES) + 1)), "smaller")
COLOURINGS = {
    "aggregate": Colouring(
        "aggregate",
        lambda e, of: _of_table(AGGREGATE_COLOURS, e.state.aggregate),
        lambda of: _patches(AGGREGATE_COLOURS[: of.aggregates], ("aggregate 1", "aggregate 2")),
    ),
    "material": Colouring(
        "material",
        lambda e, of: _of_table(AGGREGATE_COLOURS, e.material()),
        lambda of: _patches(AGGREGATE_COLOURS, of.materials),
    ),
    "contacts": Colouring(
        "contacts of the grain",
        lambda e, of: on_scale(e.coordination() / MOST_CONTACTS),
        lambda of: [{"low": "0", "high": f"{MOST_CONTACTS} or more contacts"}],
    ),
    "speed": Colouring(
        "speed",
        lambda e, of: on_scale(_speed(e.state) / of.fastest),
        lambda of: [{"low": "0", "high": f"{of.fastest:.3g} m/s past the centre of mass"}],
    ),
    "fragment": Colouring(
        "fragment", lambda e, of: _of_table(PIECES, e.fragments(), GREY), lambda of: _patches((*PIECES, GREY), RANKS)
    ),
    "bond": Colouring(
        "sintered bonds",
        lambda e, of: _of_table((GREY, BONDED), _bonded(e)),
        lambda of: _patches((BONDED, GREY), ("sintered to a neighbour", "not")),
    ),
}
