"""One row of numbers for each compression."""

import numpy as np

from ...measures.ledger import work_closure
from ...measures.of_run import derived_constants
from ...measures.percolation import spanned_axes
from ...measures.periodic_compression import (
    AVERAGED,
    at_filling,
    compressing,
    filling_at_pressure,
    filling_at_share,
    tension,
)
from ...measures.structure import fractal_dimension, grains_within
from ...runs.format import LOST_CHANNELS
from ...runs.table import Column
from .. import grains
from ..definition import NotMeasured
from .curve import FILLINGS, coordination_at, pressure_at

OF_CELL = ("grains", "strainRate", "linearDamping", "stepFraction")
NUMBERS = (*OF_CELL, "finalFilling", "seed")
CONSTANTS = {"rolling_energy": "rollingEnergy", "grain_mass": "grainMass", "time_unit": "timeUnit"}
SILICATE_PRESSURE = 300.0  # Pa: K13 section 3.7
ENERGY_FILLINGS = (0.01, 0.03, 0.1, 0.3, 0.4, 0.5, 0.6)
TWISTING_SHARES = (0.001, 0.1)  # of the rolling dissipation
STRUCTURE_FILLINGS = (0.003, 0.01, 0.03, 0.1)  # K13 Fig. 11
STRUCTURE_SCALE = (3.0, 10.0)  # grain radii between which the fractal dimension is taken
NEAREST = 0.15  # of the filling factor: how far away the state may be
ORIGINS = 2000

# Columns of values at filling factors.
PRESSURES = {f"P_{filling:.4f}": filling for filling in FILLINGS}
COORDINATIONS = {f"Z_{filling:.4f}": filling for filling in FILLINGS}
ENERGIES = {(name, filling): f"{name}_{filling:g}" for filling in ENERGY_FILLINGS for name in LOST_CHANNELS}
TWISTING = {share: f"twisting_{share:g}" for share in TWISTING_SHARES}
DIMENSIONS = {filling: f"D_{filling:g}" for filling in STRUCTURE_FILLINGS}

COLUMNS = (
    Column("material", "", "material of the grains", kind="O"),
    Column("grains", "", "number of grains N", kind="i"),
    Column("strainRate", "1/t0", "C_v"),
    Column("linearDamping", "", "k_n"),
    Column("stepFraction", "t0", "time step"),
    Column("finalFilling", "", "filling factor at which the compression was to end"),
    Column("seed", "", "random seed of the cluster", kind="i"),
    *grains.COLUMNS,
    Column("rolling_energy", "J", "E_roll (K13 eq 1)"),
    Column("grain_mass", "kg", "mass of a grain"),
    Column("time_unit", "s", "t0"),
    Column("initial_filling", "", "filling factor of the first cell"),
    Column("largest_filling", "", "largest filling factor that was reached"),
    Column("last_filling", "", "filling factor at the end, after the stretching"),
    Column("spanned_from", "", "filling factor from which on contacts span the cell along all axes", gaps=True),
    Column("closure", "", "largest error of the energy ledger over the largest work of the boundaries"),
    Column("filling_at_300", "", "filling factor at 300 Pa", gaps=True),
    Column("tensile_strength", "Pa", "largest tension while the cell is stretched", gaps=True),
    Column("tensile_filling", "", "filling factor at which the tension is largest", gaps=True),
    Column("stretched_axes", "", "number of axes along which the cell is stretched", kind="i"),
    *(Column(name, "Pa", f"pressure at the filling {f:.4f}, by the work", gaps=True) for name, f in PRESSURES.items()),
    *(Column(name, "", f"coordination number at the filling {f:.4f}", gaps=True) for name, f in COORDINATIONS.items()),
    *(Column(name, "J", f"{c} until the filling {f:g}", gaps=True) for (c, f), name in ENERGIES.items()),
    *(Column(name, "", f"filling where twisting passes {s:g} of rolling", gaps=True) for s, name in TWISTING.items()),
    *(Column(name, "", f"fractal dimension at 3 to 10 r0, filling {f:g}", gaps=True) for f, name in DIMENSIONS.items()),
)


def measure(run):
    """{column: value} of a RunFolder of the kind compression that has ended. NotMeasured where it covers no bin of the filling factor,
    RunFolderError where something is missing."""
    history, scene = run.history, _scene(run)
    pressure = pressure_at(history)
    if not np.isfinite(pressure).any():
        raise NotMeasured(f"{run.path}: covers no bin of the filling factor")
    width = AVERAGED * scene["time_unit"]
    channels = history, "twistingDissipation", "rollingDissipation"
    return {
        **scene,
        "initial_filling": float(history["filling"][0]),
        "largest_filling": float(history["filling"].max()),
        "last_filling": float(history["filling"][-1]),
        "spanned_from": _spanned_from(run),
        "closure": work_closure(history) or 0.0,
        "filling_at_300": filling_at_pressure(history, SILICATE_PRESSURE, width),
        **_stretching(history, width),
        **dict(zip(PRESSURES, map(float, pressure))),
        **dict(zip(COORDINATIONS, map(float, coordination_at(history)))),
        **{name: at_filling(history, channel, filling) for (channel, filling), name in ENERGIES.items()},
        **{name: filling_at_share(*channels, share) for share, name in TWISTING.items()},
        **{name: _dimension(run, filling) for filling, name in DIMENSIONS.items()},
    }


def _scene(run):
    """The columns that say what was compressed."""
    whole = {name: int(run.parameters[name]) for name in ("grains", "seed")}
    numbers = {name: float(run.parameters[name]) for name in NUMBERS if name not in whole}
    material = {"material": str(run.parameters.get("material", ""))}
    return {**material, **whole, **numbers, **grains.grain_constants(run), **derived_constants(run, CONSTANTS)}


def _stretching(history, width):
    """The columns of the stretching."""
    largest = int(np.argmax(history["filling"]))
    grown = [history[f"edge_{axis}"][-1] > history[f"edge_{axis}"][largest] * (1.0 + 1e-6) for axis in "xyz"]
    fillings, stress = tension(history, width)
    top = int(np.argmax(stress)) if len(stress) else None
    strength, filling = (float("nan"),) * 2 if top is None else (float(stress[top]), float(fillings[top]))
    return {"tensile_strength": strength, "tensile_filling": filling, "stretched_axes": int(sum(grown))}


def _filling_of(run, state):
    return float(np.interp(state.time, run.history["time"], run.history["filling"]))


def _spanned_from(run):
    """Filling factor of the loosest state from which on every state of the compression spans its cell along all axes (measures.percolation);
    inf where the densest does not, NaN without states."""
    found, last = float("inf") if len(run.states) else float("nan"), run.history["time"][compressing(run.history)][-1]
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
    part = compressing(run.history)
    time = run.history["time"][part][np.argmin(np.abs(np.log(run.history["filling"][part] / filling)))]
    state = run.states[run.states.nearest(time)] if len(run.states) else None
    if state is None or state.cell_size is None or abs(_filling_of(run, state) / filling - 1.0) > NEAREST:
        return float("nan")
    distance = np.array(STRUCTURE_SCALE) * state.radius.mean()
    counts = grains_within(state.position, distance, state.cell_size, ORIGINS)
    return float(fractal_dimension(distance, counts)[0])
