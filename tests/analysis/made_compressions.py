"""Made-up run folders of compressions, with the pressure that is wanted."""

import numpy as np
from written_runs import PAIR, RADIUS, cubic_lattice, record, state_arrays, write_run

from analysis.runs.format import COMPRESSION
from analysis.theory import SILICATE
from analysis.theory.compression import rolling_energy

GRAINS = 512
CONSTANTS = ("grainRadius", "young", "poisson", "density", "surfaceEnergy", "criticalRolling")


def compression_record(seed, **others):
    """The dict of run.json of ice grains (or of others: parameters by name)."""
    given = dict(material="ice", grains=GRAINS, packing="bcca", seed=seed, strainRate=3e-7, linearDamping=0.01)
    given |= dict(criticalRolling=0.8e-9, grainRadius=RADIUS, slidingStiffnessFactor=1.0, stepFraction=0.2)
    given |= dict(finalFilling=0.5, viscoelasticTime=0.0) | others
    about = record(1.0, given, **{name: given[name] for name in CONSTANTS if name in given})
    of_rolling = (about["derived"][name] for name in ("surfaceEnergy", "grainRadius", "criticalRolling"))
    about["derived"]["rollingEnergy"] = rolling_energy(*of_rolling)
    return {**about, "kind": "compression", "seed": seed}


def compression_history(pressure, low=0.002, high=0.5, stretched=False):
    """A history: pressure(filling) [Pa], a constant strain rate, rolling until a filling of 0.1 and twisting beyond;
    the work that the pressure does."""
    rate, samples = 3e-7, 3000
    filling = np.geomspace(low, high, samples)
    if stretched:
        filling = np.concatenate([filling, np.geomspace(high, 0.4 * high, samples)[1:]])
    time = np.arange(len(filling)) * np.log(high / low) / (samples - 1) / (6 * rate) * PAIR.time_unit
    volume = GRAINS * 4 / 3 * np.pi * RADIUS**3 / filling
    values = pressure(filling) * np.where(np.arange(len(filling)) < samples, 1.0, -1.0)
    work = np.concatenate([[0.0], np.cumsum(0.5 * (values[1:] + values[:-1]) * np.diff(volume))])
    history = {quantity.name: np.zeros(len(filling)) for quantity in COMPRESSION.history if not quantity.optional}
    history.update(
        time=time,
        filling=filling,
        pressure=values,
        boundaryWork=work,
        rollingDissipation=-np.where(filling < 0.1, work, work[np.searchsorted(filling[:samples], 0.1)]),
        coordination=2.0 + 9.38 * filling**1.62,
        contacts=np.full(len(filling), GRAINS),
        **{f"edge_{axis}": volume ** (1 / 3) for axis in "xyz"},
    )
    history["twistingDissipation"] = -work - history["rollingDissipation"]
    return history


def made_compression(path, seed, pressure, states=True, stretched=False, low=0.002, high=0.5, **others):
    """Write a run folder; its states are a simple cubic lattice in the cell."""
    history = compression_history(pressure, low, high, stretched=stretched)
    return write_run(path, compression_record(seed, **others), history, _states(history) if states else [])


def _states(history):
    """At fillings of 0.003 and 0.0101, where the cell is not connected along z yet, 0.0305 and 0.102."""
    connected, loose = cubic_lattice(8), cubic_lattice(8, axes=(0, 1))
    for number, row in enumerate(np.searchsorted(history["filling"][:3000], (0.003, 0.0101, 0.0305, 0.102))):
        site, pairs = connected if number > 1 else loose
        edge = history["edge_x"][row]
        still = np.zeros((GRAINS, 3)), np.zeros(GRAINS, int)
        state = state_arrays(history["time"][row], site * edge / 8, *still, pairs)
        yield {**state, "cell_size": np.full(3, edge)}


# K13's silicate, by the parameters' names.
SILICATE_GRAINS = dict(material="silicate", grainRadius=6e-7, young=SILICATE.young, poisson=SILICATE.poisson)
SILICATE_GRAINS |= dict(density=SILICATE.density, surfaceEnergy=SILICATE.surface_energy)
SILICATE_GRAINS |= dict(criticalRolling=SILICATE.critical_rolling)
