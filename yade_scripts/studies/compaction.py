"""Tables of the study of compaction: equal BCCA clusters of ice that collide head-on, as in Wada et al. (2008).

desk: eight pairs of 512 + 512 grains and of 2,048 + 2,048, at kinetic energies up to N E_roll. What has stuck goes on
to shrink: runs last LASTING, though their outcome is decided."""

from itertools import product

from analysis.studies.compaction import energy_of
from analysis.theory import GRAIN_RADIUS

RADIUS = GRAIN_RADIUS["ice"]
ENERGIES = (0.01, 0.03, 0.1, 0.3, 1.0)  # of all N grains, over N E_roll
LASTING = 18.0  # duration, N^(1/2) r over the velocity
GRAINS = 512, 2048  # of each cluster
SEEDS = range(1, 9)
HEAD = """Equal BCCA clusters collide head-on: how much they are compacted.
Units: velocity: m/s; duration: s; stepFraction: t0."""


def tables():
    """{size: (rows, head)}; the fast ones of each pair first."""
    rows = []
    for grains, seed, energy in product(GRAINS, SEEDS, reversed(ENERGIES)):
        name, speed = f"N{2 * grains}-E{energy:g}-s{seed}", (energy / energy_of(1.0, RADIUS)) ** 0.5
        lasting = LASTING * (2 * grains) ** 0.5 * RADIUS / speed
        row = {"description": name, "packing": "bcca", "grains": grains, "velocity": f"{speed:.4g}", "impact": 0}
        row |= {"duration": f"{lasting:.4g}", "endWhenApart": 0, "seed": seed}
        row |= {"stepFraction": 0.2, "threads": 1, "states": 9}
        rows.append({**row, "out": f"runs/compaction/{name}"})
    return {"desk": (rows, HEAD)}
