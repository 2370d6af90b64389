"""Tables of the study of compaction: equal BCCA clusters of ice that collide head-on, as in Wada et al. (2008).

desk: eight pairs of 512 + 512 grains, four of 2,048 + 2,048, at kinetic energies up to N E_roll. What has stuck goes on
to shrink: runs last three times as long as usual."""

from itertools import product
from math import pi

from analysis.theory import GRAIN_RADIUS, ICE
from analysis.theory.aggregates import rolling_energy

RADIUS = GRAIN_RADIUS["ice"]
ENERGIES = (0.01, 0.03, 0.1, 0.3, 1.0)  # of all N grains, over N E_roll
LASTING = 18.0  # duration, N^(1/2) r over the velocity
SIZES = {512: range(1, 9), 2048: range(1, 5)}  # grains of each cluster: seeds
HEAD = """Equal BCCA clusters collide head-on: how much they are compacted.
Units: velocity: m/s; duration: s; stepFraction: t0."""


def velocity(energy):
    """Velocity [m/s] at which N/2 grains on as many have this energy over N E_roll: N m0 v^2/8."""
    roll = rolling_energy(ICE.surface_energy, RADIUS, ICE.critical_rolling)
    return (8 * energy * roll / (4 / 3 * pi * ICE.density * RADIUS**3)) ** 0.5


def tables():
    """{size: (rows, head)}; the fast ones of each pair first."""
    rows = []
    for grains, seeds in SIZES.items():
        for seed, energy in product(seeds, reversed(ENERGIES)):
            name, speed = f"N{2 * grains}-E{energy:g}-s{seed}", velocity(energy)
            row = {"description": name, "packing": "bcca", "grains": grains, "velocity": f"{speed:.4g}", "impact": 0}
            row |= {
                "duration": f"{LASTING * (2 * grains) ** 0.5 * RADIUS / speed:.4g}",
                "endWhenApart": 0,
                "seed": seed,
            }
            row |= {"stepFraction": 0.2, "threads": 1, "states": 9}
            rows.append({**row, "out": f"runs/compaction/{name}"})
    return {"desk": (rows, HEAD)}
