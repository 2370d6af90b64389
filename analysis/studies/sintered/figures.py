"""Figures of the study: S17's own, springs that are cut beside springs that are held, and what space changes."""

import numpy as np

from ...figures.panels import PAPER, legend, letter, panels, velocity_axis
from ...figures.style import styled
from ...theory import ICE
from ...theory.chains import stretching_period
from ...theory.pair_constants import pair_constants
from ..curve_figure import MARKERS, CurveFigure, colours, pairs_text, points
from ..definition import StudyFigure
from ..levels import level
from ..paper import read_paper
from ..runs import alike, select
from ..snapshot_figure import SnapshotFigure
from .measure import energy_ratio
from .models import papers_necks

GRAIN = dict(grainRadius=1e-7, density=ICE.density, surfaceEnergy=ICE.surface_energy)
PERIOD = stretching_period(pair_constants(ICE, GRAIN["grainRadius"]))
BCCA, STRONG = {"growth_velocity": 0.0}, {"neck": 0.7}
BOTH = ("cut", "held")


def _setup_colours(results):
    return colours(results["largest"].values.index.get_level_values("setup"))


@styled
def _held(results):
    """Largest piece with either rule, and what S17 says of it: against velocity, unsintered and beta = 0.7, and against beta."""
    said = [claim for claim in read_paper(results.folder)[1] if claim.where.get("setup") == "held"]
    figure, axes = panels(1, 3, 4.6)
    for place, fixed, x in zip(axes[0], ({"neck": 0.0}, STRONG, {"velocity": 30.0}), ("velocity", "velocity", "neck")):
        for setup, marker in zip(BOTH, MARKERS):
            series = results.series("largest", setup=setup, **BCCA, **fixed).sort_index()
            label = f"springs {setup}, {pairs_text(series)}"
            points(place, series.index.get_level_values(x), series.to_list(), _setup_colours(results)[setup], label, marker)
        _said(place, [claim for claim in said if all(alike([claim.where.get(n, np.nan)], v)[0] for n, v in fixed.items())], x)
        place.set_xlabel(level(x).axis())
        place.set_title(", ".join(level(name).label(value) for name, value in fixed.items()), fontsize=10)
        place.set_ylim(0, 1.05)
        place.axhline(0.5, color="0.7", lw=0.8, zorder=0)
        if x == "velocity":
            velocity_axis(place, [3.1, 50.0])
    axes[0, 0].set_ylabel("mass in the largest piece")
    legend(axes[0, 1], fontsize=8)
    letter(axes, "")
    return figure
