"""What is measured of each compression: cell and grains, pressures and the rest at fixed filling factors, tension."""

import numpy as np

from ...measures import periodic_cell as cells
from ...measures.ledger import work_closure
from ...measures.network import spanned_axes
from ...measures.structure import fractal_dimension, grains_within
from ...runs.format import LOST_CHANNELS
from ...runs.table import Column
from ..columns import MATERIAL, constant, group, parameter
from ..definition import NotMeasured
from ..grains import GRAINS
from .curve import FILLINGS, coordination_at, pressure_at

SILICATE_PRESSURE = 300.0  # Pa: K13 section 3.7
ENERGY_FILLINGS = (0.01, 0.03, 0.1, 0.3, 0.4, 0.5, 0.6)
TWISTING_OVER = "twistingDissipation", "rollingDissipation"
STRUCTURE_SCALE = (3.0, 10.0)  # grain radii between which the fractal dimension is taken
NEAREST = 0.15  # of the filling factor: how far away the state may be
ORIGINS = 2000

# Columns of values at filling factors, or at shares of the rolling dissipation: {place: name}.
PRESSURES = {filling: f"P_{filling:.4f}" for filling in FILLINGS}
COORDINATIONS = {filling: f"Z_{filling:.4f}" for filling in FILLINGS}
ENERGIES = {(name, filling): f"{name}_{filling:g}" for filling in ENERGY_FILLINGS for name in LOST_CHANNELS}
TWISTING = {share: f"twisting_{share:g}" for share in (0.001, 0.1)}
DIMENSIONS = {filling: f"D_{filling:g}" for filling in (0.003, 0.01, 0.03, 0.1)}  # K13 Fig. 11


def _at_places(names, unit, meaning):
    return (Column(name, unit, meaning.format(place), gaps=True) for place, name in names.items())


def _reached(run, row):
    filling, at_300 = run.history["filling"], (SILICATE_PRESSURE, cells.AVERAGED * row["time_unit"])
    ends = (float(value) for value in (filling[0], filling.max(), filling[-1]))
    return *ends, _spanned_from(run), cells.filling_at_pressure(run.history, *at_300), work_closure(run.history) or 0.0


def _pressures(run, row):
    """NotMeasured where the run covers no bin of the filling factor."""
    pressure = pressure_at(run.history)
    if not np.isfinite(pressure).any():
        raise NotMeasured(f"{run.path}: covers no bin of the filling factor")
    return pressure


def _stretching(run, row):
    """Largest tension [Pa] and where it is, NaN for a cell that is not stretched; number of axes."""
    history, largest = run.history, int(np.argmax(run.history["filling"]))
    grown = [history[f"edge_{axis}"][-1] > history[f"edge_{axis}"][largest] * (1.0 + 1e-6) for axis in "xyz"]
    return *cells.tensile_strength(history, cells.AVERAGED * row["time_unit"]), int(sum(grown))


def _filling_of(run, state):
    return float(np.interp(state.time, run.history["time"], run.history["filling"]))


def _spanned_from(run):
    """Filling factor of the loosest state from which on every state of the compression spans its cell along all axes (measures.network);
    inf where the densest does not, NaN without states."""
    found = float("inf") if len(run.states) else float("nan")
    last = run.history["time"][cells.compressing(run.history)][-1]
    for state in (run.states[k] for k in reversed(range(len(run.states)))):
        if state.time > last * (1.0 + 1e-9):
            continue
        if state.cell_size is None or spanned_axes(state.position, state.contact_pairs, state.cell_size) < 3:
            return found
        found = _filling_of(run, state)
    return found


def _dimension(run, filling):
    """Fractal dimension between STRUCTURE_SCALE of the state nearest to a filling factor while the cell shrinks; NaN where none is within
    NEAREST."""
    part = cells.compressing(run.history)
    time = run.history["time"][part][np.argmin(np.abs(np.log(run.history["filling"][part] / filling)))]
    state = run.states[run.states.nearest(time)] if len(run.states) else None
    if state is None or state.cell_size is None or abs(_filling_of(run, state) / filling - 1.0) > NEAREST:
        return float("nan")
    distance = np.array(STRUCTURE_SCALE) * state.radius.mean()
    counts = grains_within(state.position, distance, state.cell_size, ORIGINS)
    return float(fractal_dimension(distance, counts)[0])


_OF_CELL = {"strainRate": ("1/t0", "C_v"), "linearDamping": ("", "k_n"), "stepFraction": ("t0", "time step")}
_OF_CELL["finalFilling"] = "", "filling factor at which the compression was to end"
NUMBERS = ("grains", *_OF_CELL, "seed")

MEASURED = (
    MATERIAL,
    parameter("grains", "", "number of grains N", "i"),
    *(parameter(name, *of) for name, of in _OF_CELL.items()),
    parameter("seed", "", "random seed of the cluster", "i"),
    *GRAINS,
    constant("rolling_energy", "J", "E_roll (K13 eq 1)", "rollingEnergy"),
    constant("grain_mass", "kg", "mass of a grain", "grainMass"),
    constant("time_unit", "s", "t0", "timeUnit"),
    group(
        _reached,
        Column("initial_filling", "", "filling factor of the first cell"),
        Column("largest_filling", "", "largest filling factor that was reached"),
        Column("last_filling", "", "filling factor at the end, after the stretching"),
        Column("spanned_from", "", "filling factor from which on contacts span the cell along all axes", gaps=True),
        Column("filling_at_300", "", "filling factor at 300 Pa", gaps=True),
        Column("closure", "", "largest error of the energy ledger over the largest work of the boundaries"),
    ),
    group(
        _stretching,
        Column("tensile_strength", "Pa", "largest tension while the cell is stretched", gaps=True),
        Column("tensile_filling", "", "filling factor at which the tension is largest", gaps=True),
        Column("stretched_axes", "", "number of axes along which the cell is stretched", kind="i"),
    ),
    group(_pressures, *_at_places(PRESSURES, "Pa", "pressure at the filling {:.4f}, by the work")),
    group(
        lambda run, row: coordination_at(run.history),
        *_at_places(COORDINATIONS, "", "coordination number at the filling {:.4f}"),
    ),
    group(
        lambda run, row: [cells.at_filling(run.history, *of) for of in ENERGIES],
        *_at_places(ENERGIES, "J", "{0[0]} until the filling {0[1]:g}"),
    ),
    group(
        lambda run, row: [cells.filling_at_share(run.history, *TWISTING_OVER, share) for share in TWISTING],
        *_at_places(TWISTING, "", "filling where twisting passes {:g} of rolling"),
    ),
    group(
        lambda run, row: [_dimension(run, filling) for filling in DIMENSIONS],
        *_at_places(DIMENSIONS, "", "fractal dimension at 3 to 10 r0, filling {:g}"),
    ),
)
