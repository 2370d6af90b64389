"""Writes the tables of the study of Sirono & Ueno (2017, S17): python3 yade_scripts/studies/sintered.py

full has the velocities and beta of Figs 6 to 17 with ten seeds, ordinary contacts of xi_crit = 2 and 30 Angstrom; the paper
has five runs a point. desk is an evening on two cores: the points that decide the paper's statements, ten seeds each. beyond is what the
desk's runs leave open: compacted aggregates in space, springs that are held at their limits, xi_crit = 30 Angstrom. decide is twenty
seeds more of what ten leave undecided and thirty may decide. Rows are in the order in which they are worth having: one seed of every
point after another.

Compacted aggregates are read from files that sintered_growth.py makes first.
"""

import os
import sys
from dataclasses import dataclass

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(os.path.dirname(HERE)))
from yade_scripts.studies import table_script

GRAINS = 1024
SEEDS = range(1, 11)
SLIDING = 2  # slidingStiffnessFactor: eqs 11 and 12 as printed
GROWN = "runs/sintered-grown"  # where sintered_growth.py leaves compacted aggregates
# 20,000 periods of the stretching vibration of an unsintered contact: 2 pi [m*/(6/5 F_c/delta_0)]^(1/2) = 1.221 ns.
DURATION = "24.4e-6"  # s
# Above 10 m/s half of it: in 21 runs that went on (the sliding spring of Wada et al. 2007, two seeds) no largest piece changed after 9.2 us, and no part
# of the energy by more than 0.025 K(0) after 12.2 us; at 10 m/s parts still change by up to 0.05 K(0).
FAST, DURATION_FAST = 10.0, "12.2e-6"  # m/s, s
STEP = 0.1  # t0; bonds of beta = 0.2 are stable to 0.119 in BCCA aggregates,
# t0, by beta: packings of files are taken for close-packed ones, in which they are to 0.0996
STEP_COMPACTED = {0.2: 0.09}
STATES = 9  # Fig. 7 shows 0, 2,500, 5,000, 10,000 and 20,000 periods, Fig. 9 also 625 and 1,250
ROOT = "10**0.5"  # m/s, the paper's 3.2


@dataclass(frozen=True)
class Grown:
    """A compacted aggregate: V_g [m/s], seed, xi_crit [Angstrom], planar, limit (of collide.py)."""

    velocity: float
    seed: int
    rolling: float = 2.0
    planar: int = 1
    limit: str = "cut"

    @property
    def name(self):
        """Of its file, without ending."""
        held = "" if self.limit == "cut" else f"-{self.limit}"
        return f"vg{self.velocity:g}-x{self.rolling:g}-{'plane' if self.planar else 'space'}{held}-s{self.seed}"

    def file(self, index):
        """Path of the packing of target (0) or projectile (1)."""
        return os.path.join(GROWN, self.name + ("", "-b")[index] + ".npz")


@dataclass(frozen=True)
class Point:
    """One set of parameters: beta (0: unsintered), V_c [m/s] (text), V_g [m/s] (0: BCCA), xi_crit [Angstrom], planar, T_vis
    [s] (text), limit (cut, or held: the rule of Wada et al. 2007)."""

    neck: float
    velocity: str
    growth: float = 0
    rolling: float = 2
    planar: int = 1
    drag: str = "0"
    limit: str = "cut"

    def name(self, seed):
        """Of a row and its run folder: b0.7-v10-vg3-s1 and what else is special."""
        parts = [f"b{self.neck:g}", "v3.2" if self.velocity == ROOT else f"v{self.velocity}"]
        parts += [f"vg{self.growth:g}"] if self.growth else []
        parts += [f"x{self.rolling:g}"] if self.rolling != 2 else []
        parts += [] if self.planar else ["space"]
        parts += [f"T{1e12 * float(self.drag):g}ps"] if float(self.drag) else []
        parts += [self.limit] if self.limit != "cut" else []
        return "-".join([*parts, f"s{seed}"])

    def grown(self, seed):
        """The Grown that collides, of a compacted one."""
        return Grown(self.growth, seed, self.rolling, self.planar, self.limit)

    def row(self, seed, folder):
        """A table's row."""
        name = self.name(seed)
        grown = self.grown(seed)
        return {
            "description": name,
            "packing": "file" if self.growth else "bcca",
            "grains": "*" if self.growth else GRAINS,
            "seed": "*" if self.growth else seed,
            "file": grown.file(0) if self.growth else "*",
            "projectileFile": grown.file(1) if self.growth else "*",
            "planar": self.planar,
            "neck": f"{self.neck:g}",
            "velocity": self.velocity,
            "criticalRolling": f"{self.rolling:g}e-10",
            "viscoelasticTime": self.drag,
            "limit": self.limit,
            "slidingStiffnessFactor": SLIDING,
            "duration": DURATION if self.velocity == ROOT or float(self.velocity) <= FAST else DURATION_FAST,
            "endWhenApart": 1,
            "states": STATES,
            "stepFraction": STEP_COMPACTED.get(self.neck, STEP) if self.growth else STEP,
            "threads": 1,
            "out": f"{folder}/{name}",
        }


def points(necks, velocities, growth=(0,), **more):
    """Every combination, the velocities fastest."""
    return [Point(n, v, g, **more) for g in growth for n in necks for v in velocities]


def unique(*groups):
    """Points of the groups in their order, each once."""
    return list(dict.fromkeys(point for group in groups for point in group))


NECKS = (0, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7)
DESK = unique(
    points((0, 0.7), (ROOT, "10", "20", "30", "50")),  # Figs 8, 15
    points((0.7,), ("15",)),
    points((0.2,), ("10", "20", "30")),
    points(NECKS, ("10", "30")),  # Figs 11, 12, 14
    points((0.7,), (ROOT, "10", "30"), (1, 3, 10)),  # Figs 10, 15
    [Point(0, "3", 3), *(Point(n, f"{g}", g) for g in (1, 2, 3, 5) for n in (0.2, 0.7))],  # Figs 9, 13, 17
)
# The same in space, the paper's section 6.2: does bouncing survive, and which mode breaks necks? And with drag.
SPACE = unique(
    points((0.7,), (ROOT, "10", "20", "30"), planar=0),
    points((0, 0.2), ("10", "30"), planar=0),
    points((0.7,), ("10", "30"), drag="6e-12"),
)
GROWTH = (1, 2, 3, 4, 5, 7.5, 10, 15, 20)  # V_g of Fig. 6 for 2 Angstrom,
GROWTH_30 = (1, 3, 5, 10, 15, 20)  # for 30
FULL = unique(
    points((0, 0.2, 0.7), ("1", "2", ROOT, "5", "10", "15", "20", "30", "50", "70", "100")),
    points(NECKS, ("10", "30")),
    points((0.7,), ("1", ROOT, "5", "10", "15", "20", "30", "50", "100"), (1, 3, 10)),
    points(NECKS, ("10", "30"), rolling=30),
    [Point(n, f"{g:g}", g) for g in GROWTH for n in NECKS],
    [Point(n, f"{g:g}", g, 30) for g in GROWTH_30 for n in NECKS],
    SPACE,
)
# What the desk's runs leave open, each beside points of theirs with the same seeds.
BEYOND = unique(
    points((0.7,), ("10", "30"), (1, 3, 10), planar=0),
    [Point(0.7, f"{g}", g, planar=0) for g in (1, 3)],
    points((0.7,), ("10", "20", "30"), limit="held"),
    points((0,), ("10", "50"), limit="held"),
    # where the runs with springs that are cut differ from the paper, or hardly agree
    points((0.7,), (ROOT, "15", "50"), limit="held"),
    points((0,), ("20", "30"), limit="held"),
    points((0.2, 0.5), ("10", "30"), limit="held"),
    points((0.4,), ("30",), limit="held"),
    points((0.7,), ("10", "30"), (1, 3), limit="held"),
    [Point(0.7, f"{g}", g, limit="held") for g in (1, 3)],
    points((0, 0.4, 0.5, 0.7), ("30",), rolling=30),
    points((0.7,), ("10",), rolling=30),
    points((0.7,), (ROOT, "10", "20", "30"), planar=0, limit="held"),
    points((0, 0.2), ("10", "30"), planar=0, limit="held"),
)
# By what ten pairs gave, in the order of the chance that thirty decide.
DECIDE = unique(
    points((0.7,), ("10", "15"), (3,)),
    points((0.5,), ("30",)),
    points((0.2,), ("30",)),
    points((0.2,), ("30",), planar=0),
    points((0, 0.7), ("20",)),
    points((0,), ("50",)),
    points((0,), ("50",), limit="held"),
)
TABLES = {"desk": unique(DESK, SPACE), "full": FULL, "beyond": BEYOND, "decide": DECIDE}


def seeds(size):
    """Of a table's points."""
    return range(11, 31) if size == "decide" else SEEDS


def grown(size):
    """[Grown] that the rows of a table need, each once."""
    wanted = (point.grown(seed) for seed in seeds(size) for point in TABLES[size] if point.growth)
    return list(dict.fromkeys(wanted))


def rows(size):
    """A table's rows: every point with the first seed, then with the next one. In desk space and drag come last."""
    folder = "runs/sintered" + ("" if size == "desk" else f"-{size}")
    groups = (DESK, [point for point in TABLES[size] if point not in DESK]) if size == "desk" else (TABLES[size],)
    return [point.row(seed, folder) for group in groups for seed in seeds(size) for point in group]


HEAD = """Sirono & Ueno (2017), Figs 6 to 17: head-on collisions of sintered aggregates of 1,024 ice grains. {which}
Compacted aggregates (packing = file) come from sintered_growth.py, which make study-sintered runs first.
The paper's text is read thus: every contact is sintered in its equilibrium, compacted aggregates (one collision at V_g)
after they have come to rest; ordinary contacts cut their springs at the limits (limit = cut, section 3.2) and
slide with the spring of eqs 11 and 12 as printed (slidingStiffnessFactor = 2); 20,000 periods of the stretching
vibration, 1.22 ns each, is the longest duration, 10,000 above 10 m/s (no largest piece changed later in 21 runs), and
a run ends earlier when no pieces can meet again; grains in contact at the end are one piece.
Units: velocity: m/s; criticalRolling: m; viscoelasticTime, duration: s; stepFraction: t0."""
# Wall time of a row [s]: mean of 160 rows of the desk's BCCA aggregates (3.17 core hours), one thread each, on a busy machine.
# 198 later rows, 108 of compacted aggregates among them, took 34 s each on a newer AMD EPYC with both cores busy.
ROW = 71.3
LEFT = "What the desk's runs leave open: compacted aggregates in space, springs held at the limits (limit = held), both, xi_crit = 30 Angstrom."
# What a table is, and how many core hours it takes to grow its aggregates.
WHICH = {
    "desk": ("A selection.", "one"),
    "full": ("All of the paper's.", "three"),
    "beyond": (LEFT, "less than one"),
    "decide": ("Seeds 11 to 30 of what ten pairs leave undecided and thirty may decide.", "less than one"),
}
COST = """{which}
{seeds} seeds a point where the paper has five runs. Some {hours:.0f} core hours (71 s a row, the mean of 160 rows of BCCA aggregates on a busy machine), and {growth} to grow the aggregates."""


def core_hours(size):
    """Of a table's rows, by ROW."""
    return ROW * len(rows(size)) / 3600


def write_tables(folder):
    """Write sintered-desk.table, sintered-full.table, sintered-beyond.table and sintered-decide.table into a folder."""
    tables = {}
    for size, (which, growth) in WHICH.items():
        cost = COST.format(which=which, seeds=len(seeds(size)), hours=core_hours(size), growth=growth)
        tables[size] = rows(size), cost
    table_script.write(folder, "sintered", HEAD, tables)


if __name__ == "__main__":
    table_script.main(write_tables, HERE, __doc__)
