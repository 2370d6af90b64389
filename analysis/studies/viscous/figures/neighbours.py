"""Velocities between neighbouring grains: A22 Figs. 10 to 12."""

import numpy as np

from ....figures.style import styled
from ....measures.pair_velocities import NEAR, pair_velocities
from ...definition import StudyFigure
from .. import paper
from ..measure import pair_speeds
from .common import PAPER, legend, letter, one_run_each, own_times, panels, run_folder, time_colours, time_label

MICRO = 1e6
LEAST = 1e-2  # m/s
CLOSE = 0.35  # of a state's time to the paper's


def at_time(number):
    """Figure of the cumulative frequencies of v_rel at the paper's time `number`: Figs. 10, 11."""

    @styled
    def figure(results):
        colours, made = time_colours(results.table), None
        for time, row in one_run_each(results):
            run, wanted = run_folder(row), own_times(paper.PAIR_TIMES, row)[number]
            k = run.states.nearest(wanted)
            reached = float(run.states.times[k])
            if abs(reached / wanted - 1) > CLOSE:
                continue
            made = made or panels(1, 2, 4.8, 4.2)
            arrays = run.states.arrays(k, ("position", "velocity"))
            values = pair_velocities(arrays["position"], arrays["velocity"], NEAR * row.grain_radius)
            label = f"{time_label(time)}, {reached * MICRO:.2f} $\\mu$s"
            for place, own in zip(made[1][0], (values[values > 0], -values[values < 0])):
                own = np.sort(own)
                place.step(own, len(own) - np.arange(len(own)), color=colours[time], label=label)
        return _finished(*made, results) if made else None

    return figure


def _finished(figure, axes, results):
    names = ("$N_{pair,p}(> v_{rel})$", "$N_{pair,n}(< -v_{rel})$")
    for place, name in zip(axes[0], names):
        place.set_xscale("log")
        place.set_yscale("log")
        place.set_xlim(1e-2, 1e2)
        place.set_xlabel("$|v_{rel}|$  [m/s]")
        place.set_ylabel(name)
    legend(axes[0, 0], fontsize=8, loc="lower left")
    letter(axes, f"{results.reference_size} grains each")
    return figure


@styled
def over_time(results):
    """Root mean square of v_rel against time: Fig. 12."""
    shown = one_run_each(results)
    if not shown:
        return None
    figure, axes = panels(1, 1)
    place, colours = axes[0, 0], time_colours(results.table)
    for time, row in shown:
        times, speeds = np.transpose(pair_speeds(run_folder(row)))
        speeds = np.where(speeds > LEAST, speeds, np.nan)  # nothing moves within aggregates that haven't met
        place.plot(times * MICRO, speeds, "o-", markersize=3, color=colours[time], label=time_label(time))
    place.axhline(paper.PAIR_SPEED, color=PAPER, ls="--", lw=1.2, label="A22: below it with drag")
    place.set_yscale("log")
    place.set_ylim(LEAST, None)
    place.set_xlabel(r"$t$  [$\mu$s]")
    place.set_ylabel("$v_{rel,rms}$  [m/s]")
    legend(place, fontsize=8)
    letter(axes, f"{results.reference_size} grains each")
    return figure


FIGURES = (
    StudyFigure(
        "fig10_neighbours",
        "A22 Fig. 10: velocities between neighbours at 0.32 us (of other sizes: in proportion to r_c).",
        at_time(0),
    ),
    StudyFigure("fig11_neighbours", "A22 Fig. 11: the same at 0.63 us.", at_time(1)),
    StudyFigure("fig12_neighbours", "A22 Fig. 12: their root mean square against time.", over_time),
)
