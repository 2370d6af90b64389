"""Writes elastoplastic-prediction.table and elastoplastic-referee.table: python3 yade_scripts/studies/elastoplastic_referee.py

Runs that test what the gallery says of Arakawa et al. (2024), in blocks; each block's comment says what it decides and about
how many core hours it takes. The first table holds the pairs whose d_max was predicted beforehand
(analysis.studies.elastoplastic.prediction). Blocks are in the order in which they are worth having.
"""

import math
import os
import sys
from dataclasses import dataclass

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(os.path.dirname(HERE)))
from analysis.runs.write import write_text
from analysis.studies.elastoplastic import prediction
from yade_scripts.studies import table_script

STEP = 0.2  # t0, as the runs that are compared with these
# t0, of long runs at 1 to 2.5 m/s: one at R = 40 and 1 m/s has the same outcome, d_max, t_max and largest return speed as with 0.1 to
# 5e-5 r, 20 ps and 3e-4 m/s, and closes the ledger to 9e-5 of K(0).
LONGER_STEP = 0.3
DEFAULT = "64.6*{radius}*1.936532021439599e-10"  # s, A24's 1000 ns at R = 80, in proportion to R
SIZES = (0.4, 0.3)
COLUMNS = (
    "description",
    "filling",
    "radius",
    "velocity",
    "seed",
    "viscoelasticTime",
    "removeLooseGrains",
    "initialOverlap",
    "duration",
    "stepFraction",
    "threads",
    "out",
)
# Columns that a table has only where a row differs from these.
USUAL = {"removeLooseGrains": "0", "initialOverlap": "1"}


LONG = "runs/elastoplastic-long"


@dataclass(frozen=True)
class Block:
    """comment; fillings, radii, velocities (i of 10^(0.1 i) m/s), seeds; duration [s] (text, None: DEFAULT); drag [s];
    remove: whether loose grains are; overlap at the start; step [t0]; folder of the run folders. LONG holds pairs that have run before, for longer: analysed by itself."""

    comment: str
    fillings: tuple
    radii: tuple
    velocities: tuple
    seeds: range
    duration: str = None
    drag: tuple = ("0",)
    remove: int = 0
    overlap: float = 1.0
    step: float = STEP
    folder: str = "runs/elastoplastic"

    def scenes(self):
        """(filling, radius, i, seed, drag) of the rows: all pairs of one scene follow each other."""
        for filling in self.fillings:
            for radius in self.radii:
                for i in self.velocities:
                    for drag in self.drag:
                        for seed in self.seeds:
                            yield filling, radius, i, seed, drag

    def hours(self):
        """Core hours, from the 6.55 h that the 172 runs of elastoplastic-desk.table took on one core each."""
        at_step = sum(
            core_hours(filling, radius, float(self.duration) if self.duration else 12.5e-9 * radius)
            for filling, radius, *_ in self.scenes()
        )
        return at_step * STEP / self.step


def core_hours(filling, radius, duration):
    """Core hours of a run of duration [s] at STEP: steps times contacts times (grains)^0.07, which the cache costs."""
    return 0.341 * (filling / 0.4) ** 2.07 * (radius / 80.0) ** 3.21 * duration / 1e-6


# s: at filling 0.3 and 1 m/s two of ten pairs had not turned around after the default, 500 ns.
SLOW, SLOW_DURATION = 2.0, "8e-7"
PREDICTION = tuple(
    Block(
        f"Pairs whose d_max was predicted from their packings alone: analysis/gallery/elastoplastic/{each.file}.",
        prediction.FILLINGS,
        (each.radius,),
        (round(10 * math.log10(each.velocity)),),
        each.seeds,
        SLOW_DURATION if each.velocity < SLOW else None,
    )
    for each in prediction.SETS
)
REFEREE = (
    Block(
        "Drag left on? The pairs of R = 40 at 3.162 m/s again with T_vis = 1, 3, 6 ps: paired differences of d_max and t_max.",
        SIZES,
        (40,),
        (5,),
        range(1, 11),
        drag=("1e-12", "3e-12", "6e-12"),
    ),
    Block(
        "Did the paper keep the grains outside the largest piece? The same pairs without them.",
        SIZES,
        (40,),
        (5,),
        range(1, 21),
        remove=1,
    ),
    Block(
        "Neighbours that start without overlap (next to none: rounding would decide at 0 which touch): the same pairs.",
        SIZES,
        (40,),
        (5,),
        range(1, 11),
        overlap=1e-3,
    ),
    Block("R = 70 of A24's Figs 5 and 6.", SIZES, (70,), (5,), range(1, 6)),
    Block(
        "Outcomes at R = 40, followed for 3 us: sticking at 1 to 2.5 m/s. Pairs that have run for less are among them:\n"
        f"analyse {LONG} by itself.",
        (0.4,),
        (40,),
        (0, 2, 4),
        range(1, 21),
        "3e-6",
        step=LONGER_STEP,
        folder=LONG,
    ),
    Block(
        "E* at 0.4: R = 80 at 1 to 2 m/s, where tau v/delta differs most between elastic and rigid-plastic spheres, until the\n"
        "halves have parted fastest.",
        (0.4,),
        (80,),
        (0, 1, 2, 3),
        range(1, 7),
        "8e-7",
        step=LONGER_STEP,
    ),
    Block(
        "Outcomes at R = 60, followed for 3 us, beside those of R = 40 and 80.",
        (0.4,),
        (60,),
        (0, 2, 4),
        range(1, 11),
        "3e-6",
        step=LONGER_STEP,
        folder=LONG,
    ),
)


def rows(block):
    """Cells (tuples of text) of a block's rows; run folders are named fFILLING-RRADIUS-iI-sSEED and what is special."""
    for filling, radius, i, seed, drag in block.scenes():
        special = (f"-T{float(drag) * 1e12:g}ps" if float(drag) else "") + ("-largest" if block.remove else "")
        special += f"-overlap{block.overlap:g}" if block.overlap != 1 else ""
        special += f"-{float(block.duration) * 1e6:g}us" if block.duration else ""
        name = f"f{filling:g}-R{radius:g}-i{i}-s{seed}{special}"
        duration = block.duration or DEFAULT.format(radius=radius)
        start = drag, block.remove, f"{block.overlap:g}", duration
        yield tuple(
            map(
                str,
                (name, f"{filling:g}", radius, f"10**(0.1*{i})", seed, *start, block.step, 1, f"{block.folder}/{name}"),
            )
        )


def text(blocks, title):
    """A table (str) of blocks, each after a comment with its core hours."""
    table = [(block, list(rows(block))) for block in blocks]
    every = [row for _, own in table for row in own]
    shown = [k for k, name in enumerate(COLUMNS) if any(row[k] != USUAL.get(name) for row in every)]
    widths = [max(len(row[k]) for row in [COLUMNS, *every]) for k in shown]

    def line(cells):
        return "  ".join(cells[k].ljust(width) for k, width in zip(shown, widths)).rstrip()

    lines = [
        f"# {title}",
        "# Units: radius: grain radii; velocity: m/s; viscoelasticTime, duration: s; stepFraction: t0.",
    ]
    lines += [
        f"# Written by yade_scripts/studies/{os.path.basename(__file__)}; core hours are estimates.",
        line(COLUMNS),
    ]
    for block, own in table:
        lines += [f"# {part}" for part in block.comment.splitlines()]
        lines += [f"# {len(own)} runs, {block.hours():.1f} core hours."]
        lines += [line(row) for row in own]
    return "\n".join(lines) + "\n"


TABLES = {
    "elastoplastic-prediction.table": (
        PREDICTION,
        "Arakawa et al. (2024): pairs whose largest compression was predicted before they ran.",
    ),
    "elastoplastic-referee.table": (REFEREE, "Arakawa et al. (2024): what the comparison leaves open."),
}


def write_tables(folder):
    """Write both tables into a folder."""
    for name, (blocks, title) in TABLES.items():
        write_text(os.path.join(folder, name), text(blocks, title))


if __name__ == "__main__":
    table_script.main(write_tables, HERE, __doc__)
