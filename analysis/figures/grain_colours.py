"""Colours of grains in films and on the page that `analysis view` writes: by what, and what each colour means."""

from dataclasses import dataclass
from functools import cached_property
from typing import Callable

import numpy as np

from ..progress import progress

AGGREGATE_COLOURS = ((0.92, 0.60, 0.18), (0.24, 0.52, 0.82))
GREY, BONDED = (0.75, 0.75, 0.75), (0.80, 0.25, 0.25)
PIECES = (
    (0.24, 0.52, 0.82),
    (0.92, 0.60, 0.18),
    (0.30, 0.65, 0.35),
    (0.75, 0.35, 0.60),
    (0.55, 0.45, 0.30),
    (0.35, 0.70, 0.75),
)
SCALE = (  # matplotlib's viridis in even steps, without matplotlib
    (0.267, 0.005, 0.329),
    (0.279, 0.175, 0.483),
    (0.230, 0.322, 0.546),
    (0.173, 0.449, 0.558),
    (0.128, 0.567, 0.551),
    (0.158, 0.684, 0.502),
    (0.369, 0.789, 0.383),
    (0.678, 0.864, 0.190),
    (0.993, 0.906, 0.144),
)
MOST_CONTACTS = 8
_FAST = 99.0  # percentile of the speeds at which the scale ends


@dataclass(frozen=True)
class Patch:
    """A colour (R, G, B) and what it means."""

    colour: tuple
    text: str


@dataclass(frozen=True)
class Scale:
    """The colour scale from `low` to `high` (texts)."""

    low: str
    high: str


@dataclass(frozen=True)
class Colouring:
    """title; colours(Exported, Range) -> (N, 3); legend(Range) -> [Patch or Scale]."""

    title: str
    colours: Callable
    legend: Callable


class Range:
    """What colours are relative to in all states of a RunFolder."""

    def __init__(self, run):
        self._states = run.states
        self.aggregates = int(run.start.aggregate.max()) + 1  # their number

    @cached_property
    def fastest(self):
        """The largest speed [m/s] on the scale; all states are read for it."""
        speeds = [_speed(state) for state in progress(self._states, "finding the scale")]
        return float(np.percentile(np.concatenate(speeds), _FAST)) or 1.0


def _speed(state):
    of_centre = np.average(state.velocity, axis=0, weights=state.radius**3)
    return np.linalg.norm(state.velocity - of_centre, axis=1)


def on_scale(shares):
    """Colours (N, 3) of shares (N,) of the scale, 0 to 1 and beyond."""
    steps = np.linspace(0, 1, len(SCALE))
    return np.stack([np.interp(shares, steps, channel) for channel in np.transpose(SCALE)], axis=-1)


def _of_table(table, numbers, beyond=None):
    """Rows of a table of colours; numbers past its end: `beyond`, or from its beginning."""
    if beyond is None:
        return np.array(table)[numbers % len(table)]
    return np.array([*table, beyond])[np.minimum(numbers, len(table))]


def _bonded(exported):
    state, bonded = exported.state, np.zeros(len(exported.state.radius), dtype=int)
    bonded[state.contact_pairs[state.contact_bonded].ravel()] = 1
    return bonded


def _aggregates(of):
    return [
        Patch(AGGREGATE_COLOURS[k % len(AGGREGATE_COLOURS)], f"aggregate {k + 1}") for k in range(min(of.aggregates, 2))
    ]


def _pieces(of):
    return [
        Patch(PIECES[0], "largest piece"),
        *(Patch(c, f"{k}.") for k, c in enumerate(PIECES[1:], 2)),
        Patch(GREY, "smaller"),
    ]


COLOURINGS = {
    "aggregate": Colouring("aggregate", lambda e, of: _of_table(AGGREGATE_COLOURS, e.state.aggregate), _aggregates),
    "contacts": Colouring(
        "contacts of the grain",
        lambda e, of: on_scale(e.coordination() / MOST_CONTACTS),
        lambda of: [Scale("0", f"{MOST_CONTACTS} or more contacts")],
    ),
    "speed": Colouring(
        "speed",
        lambda e, of: on_scale(_speed(e.state) / of.fastest),
        lambda of: [Scale("0", f"{of.fastest:.3g} m/s past the centre of mass")],
    ),
    "fragment": Colouring("fragment", lambda e, of: _of_table(PIECES, e.fragments(), GREY), _pieces),
    "bond": Colouring(
        "sintered bonds",
        lambda e, of: _of_table((GREY, BONDED), _bonded(e)),
        lambda of: [Patch(BONDED, "sintered to a neighbour"), Patch(GREY, "not")],
    ),
}
