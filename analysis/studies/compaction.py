"""How much equal BCCA clusters are compacted when they collide head-on, against the energy of the collision.

W08: Wada et al. (2008), whose abstract alone was at hand; that n is about -0.1 is quoted by others."""

import numpy as np
import pandas

from ..measures.fragments import fragment_labels
from ..measures.outcome import STICKING
from ..measures.structure import of_members
from ..theory import ICE
from ..theory.aggregates import rolling_energy
from .columns import CLOSURE, GRAIN_RADIUS, OUTCOME, SEED, VELOCITY, Column, group, parameter, require_papers_grains
from .comparison import Row
from .estimates import estimate, estimates, mean, where
from .figures import curves
from .study import Study

LAW = -0.125, -0.075  # limits of n, about -0.1


def energy_of(velocity, grain_radius):
    """Kinetic energy over N E_roll of N/2 ice grains that hit as many at a velocity [m/s]: m0 v^2/(8 E_roll); arrays
    broadcast."""
    roll = rolling_energy(ICE.surface_energy, grain_radius, ICE.critical_rolling)
    return 4 / 3 * np.pi * ICE.density * grain_radius**3 * velocity**2 / (8 * roll)


def _largest(run, row):
    """R_g, coordination and grains of the largest piece at the end."""
    require_papers_grains(run)
    state = run.last
    own = fragment_labels(len(state.radius), state.contact_pairs) == 0
    _, coordination, gyration = of_members(state, own)
    return gyration, coordination, own.sum()


MEASURED = (
    parameter("grains", "", "of each cluster", "i"),
    SEED,
    VELOCITY,
    GRAIN_RADIUS,
    OUTCOME,
    group(
        _largest,
        Column("gyration", "m", "R_g of the largest piece at the end"),
        Column("coordination", "", "its mean number of contacts of a grain"),
        Column("largest", "", "its grains", "i"),
    ),
    CLOSURE,
)


def prepared(runs):
    """The table with `energy` over N E_roll, and `size`, R_g/(N^(2/5) r)."""
    size = runs.gyration / runs.grain_radius / (2 * runs.grains) ** 0.4
    energy = [float(f"{value:.1g}") for value in energy_of(runs.velocity, runs.grain_radius)]
    return runs.assign(energy=energy, size=size, of=[f"2 × {grains:,} grains" for grains in runs.grains])


def power_law(runs):
    """(size at an energy of 0.1 N E_roll, n) of size ~ energy^n: least squares of the logarithms with a level of its
    own for each pair, whose mean counts; NaN with fewer than three energies."""
    if runs.energy.nunique() < 3:
        return np.nan, np.nan
    points = pandas.DataFrame({"x": np.log(runs.energy / 0.1), "y": np.log(runs["size"])}).groupby(runs.pair)
    middle, away = points.mean(), points.transform(lambda own: own - own.mean())
    n = away.x @ away.y / (away.x @ away.x)
    return np.exp((middle.y - n * middle.x).mean()), n


def _stuck(runs):
    """Runs that stuck, at energies at which most of a size did."""
    stuck = runs.outcome == STICKING
    most = stuck.groupby([runs.of, runs.energy]).transform("mean") > 0.5
    return runs[stuck & most]


def rows(runs):
    """The exponent for each size; radii and contacts."""
    runs = _stuck(runs)
    for words, own in runs.groupby("of"):
        level, n = estimates(power_law, own)
        yield Row(f"n of R_g/(N^(2/5) r) ~ (E/(N E_roll))^n, {words}", n, LAW, "about −0.1", "W08")
        yield Row(f"R_g/(N^(2/5) r) at E = 0.1 N E_roll, fit, {words}", level)
        for energy in sorted(own.energy.unique()):
            at = where(own, energy=energy)
            yield Row(f"R_g/(N^(2/5) r), E = {energy:g} N E_roll, {words}", estimate(mean("size"), at))
            yield Row(f"contacts of a grain, E = {energy:g} N E_roll, {words}", estimate(mean("coordination"), at))


def figures(runs):
    """The radius against the energy."""
    own = _stuck(runs)
    look = {"x_label": r"$E/(N E_{roll})$", "y_label": r"$R_g/(N^{2/5} r)$"}
    figure = curves(own, lambda part: estimate(mean("size"), part), "energy", "of", log="xy", **look)
    yield "size", "Radius of gyration of what two BCCA clusters become that collide head-on.", figure


STUDY = Study(
    title="Compaction",
    question="How much are BCCA clusters compacted when they collide head-on?",
    values={"packing": "bcca", "impact": 0.0, "atRest": 1, "viscoelasticTime": 0.0, "material": "ice"},
    key=("grains", "seed", "velocity"),
    measured=MEASURED,
    pair=("grains", "seed"),
    rows=rows,
    figures=figures,
    prepared=prepared,
)
