"""Writes the tables of the study of Arakawa et al. (2024): python3 yade_scripts/studies/elastoplastic.py

full is what the paper's Figs 4 to 9 show, section 3: ten seeds of every collision, at its default step. desk is a
selection for an evening, at twice that step. first is one figure for a first look (Fig. 8, R = 40), some minutes. Rows are in the order in which they are
worth having: small aggregates first, and every figure gets its first points early.
"""

import os
import sys
from itertools import product

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(os.path.dirname(HERE)))
from yade_scripts.studies import table_script

FASTEST_STEP = 0.2  # t0; the ledger closes to 5e-4 of the kinetic energy or better
REFERENCE = 5  # i of the velocity 10^0.5 m/s at which sizes are compared (Figs 5 to 7)
VELOCITIES = range(8)
FILLINGS = (0.4, 0.3)

# {(filling, radius): seeds} at the reference velocity, seeds of every other velocity at R = 40, and of slow
# collisions of larger aggregates, which show best whether tau_max falls with velocity (the elastic limit's sign)
DESK_SIZES = {(filling, radius): n for radius, n in {40: 20, 50: 8, 60: 8, 80: 3}.items() for filling in FILLINGS}
DESK_VELOCITIES = 10
DESK_SLOW = {(0.4, 60): 3, (0.3, 60): 2}
SLOW = (0, 2)
TIME_UNIT = "1.936532021439599e-10"  # s: t0 of ice
# The paper follows aggregates of 80 grain radii for 1000 ns, which is 64.6 t0 per grain radius; times from the start.
DURATION = "64.6*{radius}*" + TIME_UNIT
# The slowest at R = 40 are followed for twice as long, when more of them have stuck or parted.
FOLLOWED = {(40, i): "1e-6" for i in range(3)}  # {(radius, i): duration [s]}
FIRST = 2  # seeds of each of these that come before any third
FIRST_LOOK = (1, 3, 5, 7)  # i of the velocities of the table first


def desk():
    """[(filling, radius, i, seed)] of the small study."""
    sizes = [(*size, REFERENCE, seed) for size, seeds in DESK_SIZES.items() for seed in range(1, seeds + 1)]
    scenes = product(range(1, DESK_VELOCITIES + 1), FILLINGS, VELOCITIES)
    velocities = [(filling, 40, i, seed) for seed, filling, i in scenes if i != REFERENCE]
    slow = [(*size, i, seed) for size, seeds in DESK_SLOW.items() for i in SLOW for seed in range(1, seeds + 1)]
    return sorted(sizes + velocities + slow, key=_order)


def full():
    """[(filling, radius, i, seed)] of all of the paper's runs."""
    scenes = {*product(FILLINGS, (40, 50, 60, 70, 80), (REFERENCE,)), *product(FILLINGS, (40, 80), VELOCITIES)}
    scenes = sorted(scenes, key=lambda scene: (scene[1], -scene[0], scene[2]))
    return sorted(((*scene, seed) for scene in scenes for seed in range(1, 11)), key=_order)


def _order(scene):
    """That in which collisions are worth having."""
    _, radius, _, seed = scene
    return seed > FIRST, radius, seed


def first():
    """[(filling, radius, i, seed)] of one figure."""
    return [(0.4, 40, i, seed) for seed in range(1, FIRST + 1) for i in FIRST_LOOK]


def rows(scenes, folder, step=FASTEST_STEP, followed={}):
    """A table's rows, with run folders FOLDER/fFILLING-RRADIUS-iI-sSEED; followed: {(radius, i): duration} of
    those that have another than DURATION."""
    found = []
    for filling, radius, i, seed in scenes:
        name = f"f{filling:g}-R{radius:g}-i{i}-s{seed}"
        found.append(
            {
                "description": name,
                "filling": filling,
                "radius": radius,
                "velocity": f"10**(0.1*{i})",
                "seed": seed,
                "duration": followed.get((radius, i), DURATION.format(radius=radius)),
                "stepFraction": step,
                "threads": 1,
                "out": f"{folder}/{name}",
            }
        )
    return found


HEAD = """Arakawa et al. (2024), section 3 and Figs 4 to 9: head-on collisions of equal CPE aggregates of ice grains. {which}
Units: radius: grain radii; velocity: m/s; duration: s; stepFraction: t0."""


def write_tables(folder):
    """Write elastoplastic-first.table, elastoplastic-desk.table and elastoplastic-full.table into a folder."""
    tables = {
        "first": (rows(first(), "runs/elastoplastic-first"), "One figure: Fig. 8 at R = 40."),
        "desk": (rows(desk(), "runs/elastoplastic", followed=FOLLOWED), "A selection."),
        "full": (rows(full(), "runs/elastoplastic-full", step=0.1), "All of the paper's."),
    }
    table_script.write(folder, "elastoplastic", HEAD, tables)


if __name__ == "__main__":
    table_script.main(write_tables, HERE, __doc__)
