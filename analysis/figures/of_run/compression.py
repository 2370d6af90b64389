"""A compression: pressure, coordination number, and where the boundaries' work goes, against the filling factor."""

import numpy as np

from ...measures.ledger import work_on_boundaries
from ...measures.periodic_cell import AVERAGED, pressure_over
from ...runs.format import CHANNEL_TABLE, CHANNELS, COLOURS, COMPRESSION, LABELS, WORK
from ...theory.aggregates import bcca_coordination
from ...theory.compression import compressive_strength, compressive_strength_dense, strength_scale
from ..panels import OURS, PAPER, legend, letter, panels
from ..style import run_title, styled

KINDS = (COMPRESSION.name,)


@styled
def compression_figure(run):
    """Figure of pressure (averaged over 1000 t0) beside Kataoka et al. (2013), eq 25, and Tatsuuma et al. (2023), coordination beside Arakawa et
    al. (2024), eq 45, and every channel's change over the work of the boundaries until then, all while the cell shrinks."""
    history = run.history
    part = slice(0, int(np.argmax(history["filling"])) + 1)
    filling = history["filling"][part]
    figure, axes = panels(1, 3, 4.8, 4.2)
    strength, contacts, energy = axes[0]
    _draw_pressure(strength, history, run.derived)
    contacts.plot(filling, history["coordination"][part], color=OURS)
    contacts.plot(filling, bcca_coordination(filling), "--", color=PAPER, label="Arakawa et al. (2024), eq 45")
    contacts.set_ylabel("coordination number $Z$")
    _draw_channels(energy, filling, history, part)
    for place in (strength, contacts, energy):
        place.set_xscale("log")
        place.set_xlabel("filling factor $\\phi$")
        legend(place, loc="upper left", fontsize=8, ncol=2 if place is energy else 1)
    letter(axes, run_title(run))
    return figure


def _draw_pressure(axes, history, derived):
    filling, pressure = pressure_over(history, AVERAGED * derived["timeUnit"])
    axes.plot(filling[pressure > 0], pressure[pressure > 0], color=OURS)
    if "rollingEnergy" in derived:
        scale = strength_scale(derived["rollingEnergy"], derived["grainRadius"])
        axes.plot(
            filling, compressive_strength(filling, scale), "--", color=PAPER, label="Kataoka et al. (2013), eq 25"
        )
        axes.plot(filling, compressive_strength_dense(filling, scale), ":", color=PAPER, label="Tatsuuma et al. (2023)")
    axes.set_yscale("log")
    axes.set_ylabel("pressure $P$  [Pa]")


def _draw_channels(axes, filling, history, part):
    work = {channel.name for channel in CHANNEL_TABLE if channel.kind == WORK}
    total = work_on_boundaries(history)
    done = -(total[part] - total[0])
    shown = done > 1e-4 * done.max() if done.max() > 0 else np.zeros(len(done), bool)
    for name in CHANNELS:
        change = history[name][part][shown] - history[name][0]
        if name not in work and len(change) and np.abs(change / done[shown]).max() > 0.01:
            axes.plot(filling[shown], change / done[shown], color=COLOURS[name], label=LABELS[name])
    axes.set_ylim(-1.0, 1.6)
    axes.set_ylabel("part of the boundaries' work until then")


FIGURE = compression_figure
