"""The study of Sirono & Ueno (2017, S17): head-on collisions of sintered aggregates of 1,024 ice grains.

    python3 yade_scripts/studies/sintered.py grow SIZE [-j JOBS]    the compacted aggregates of a table that are missing

Tables. full: Figs 6 to 17, ordinary contacts of xi_crit = 2 and 30 Angstrom. desk: an evening on two cores: the points
that decide the paper's statements. beyond: what the desk's runs leave open. Each has ten seeds a point, where the paper
has five runs. Rows stand in the order of their worth: one seed of every point after another.

Compacted aggregates. Section 4 makes them by "collision simulations" at V_g, section 5.2 speaks of "successive
collisions", without their start. Here two BCCA clusters of START grains, the same one in two random orientations,
collide head-on, and the largest piece comes to rest (packings/from_run.py). The start decides how compact aggregates
are: the paper's Fig. 6 has about two contacts a grain at low V_g and three at high V_g, and Fig. 17 needs fewer than
2.33 at 1 m/s, 2.31 at 2 m/s and more than 2.36 at 3 m/s (by eqs 14 to 19). START = 512 gives 2.15, 2.49 and 3.01 at 1,
3 and 10 m/s (one seed); six collisions from 16 grains gave 2.5, 2.9 and 3.2, which Figs 6 and 17 exclude. A collision
whose largest piece has less than STUCK of the grains is tried again in other orientations, ATTEMPTS times.
"""

import argparse
import os
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

TOP = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, TOP)
from yade_scripts import packings
from yade_scripts.materials import MATERIALS, equilibrium_overlap
from yade_scripts.packings.from_run import largest_piece_of_run, turned
from yade_scripts.packings.packing import Packing, PackingError
from yade_scripts.parameters import tell
from yade_scripts.run.parameters import CORES

GRAINS, SEEDS = 1024, range(1, 11)
SLIDING = 2  # slidingStiffnessFactor: eqs 11 and 12 as printed
GROWN = "runs/sintered-grown"  # compacted aggregates, each in two orientations: NAME.npz and NAME-b.npz
START, STUCK, ATTEMPTS = 512, 0.9, 5
CROSSINGS = 3.0  # a collision that compacts lasts until the two have moved so many diameters at V_g, at most DURATION
# 20,000 periods of the stretching vibration of an unsintered contact: 2 pi [m*/(6/5 F_c/delta_0)]^(1/2) = 1.221 ns.
DURATION = "24.4e-6"  # s
# Above 10 m/s half of it: in 21 runs that went on no largest piece changed after 9.2 us, and no part of the energy by
# more than 0.025 K(0) after 12.2 us; at 10 m/s parts still change by up to 0.05 K(0).
FAST, DURATION_FAST = 10.0, "12.2e-6"  # m/s, s
STEP = 0.1  # t0; bonds of beta = 0.2 are stable to 0.119 in BCCA aggregates
STEP_COMPACTED = {0.2: 0.09}  # t0, by beta: packings of files count as close-packed, where they are stable to 0.0996
STATES = 9  # Fig. 7 shows 0, 2,500, 5,000, 10,000 and 20,000 periods, Fig. 9 also 625 and 1,250
ROOT = "10**0.5"  # m/s, the paper's 3.2


@dataclass(frozen=True)
class Point:
    """One set of parameters."""

    neck: float  # beta; 0: unsintered
    velocity: str  # V_c [m/s]
    growth: float = 0  # V_g [m/s]; 0: BCCA aggregates
    rolling: float = 2  # xi_crit [Angstrom]
    planar: int = 1
    drag: str = "0"  # T_vis [s]
    limit: str = "cut"  # or held: the rule of Wada et al. 2007

    def name(self, seed):
        """Name of a row and its run folder: b0.7-v10-vg3-s1 and what else is special."""
        name = f"b{self.neck:g}-v{'3.2' if self.velocity == ROOT else self.velocity}"
        name += f"-vg{self.growth:g}" if self.growth else ""
        name += f"-x{self.rolling:g}" if self.rolling != 2 else ""
        name += "" if self.planar else "-space"
        name += f"-T{1e12 * float(self.drag):g}ps" if float(self.drag) else ""
        return name + (f"-{self.limit}" if self.limit != "cut" else "") + f"-s{seed}"

    def grown(self, seed, index):
        """Path of the compacted aggregate that is target (0) or projectile (1)."""
        name = f"vg{self.growth:g}-x{self.rolling:g}-{'plane' if self.planar else 'space'}"
        name += f"-{self.limit}" if self.limit != "cut" else ""
        return f"{GROWN}/{name}-s{seed}{('', '-b')[index]}.npz"

    def row(self, seed, folder):
        """A table's row."""
        aggregates = {"packing": "bcca", "grains": GRAINS, "seed": seed, "file": "*", "projectileFile": "*"}
        step, slow = STEP, self.velocity == ROOT or float(self.velocity) <= FAST
        if self.growth:
            files = {"file": self.grown(seed, 0), "projectileFile": self.grown(seed, 1)}
            aggregates = {"packing": "file", "grains": "*", "seed": "*", **files}
            step = STEP_COMPACTED.get(self.neck, STEP)
        row = {"description": self.name(seed), **aggregates, "atRest": 0}
        row |= {"planar": self.planar, "neck": f"{self.neck:g}", "velocity": self.velocity}
        row |= {"criticalRolling": f"{self.rolling:g}e-10", "viscoelasticTime": self.drag, "limit": self.limit}
        row |= {"slidingStiffnessFactor": SLIDING, "duration": DURATION if slow else DURATION_FAST, "endWhenApart": 1}
        return {**row, "states": STATES, "stepFraction": step, "threads": 1, "out": f"{folder}/{self.name(seed)}"}


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
POINTS = {"desk": unique(DESK, SPACE), "full": FULL, "beyond": BEYOND}
HEAD = """Sirono & Ueno (2017), Figs 6 to 17: head-on collisions of sintered aggregates of 1,024 ice grains. {}
The paper's text is read thus: every contact is sintered in its equilibrium, compacted aggregates (one collision at V_g)
after they have come to rest; ordinary contacts cut their springs at the limits (limit = cut, section 3.2) and
slide with the spring of eqs 11 and 12 as printed (slidingStiffnessFactor = 2); 20,000 periods of the stretching
vibration, 1.22 ns each, is the longest duration, 10,000 above 10 m/s (no largest piece changed later in 21 runs), and
a run ends earlier when no pieces can meet again; grains in contact at the end are one piece.
Units: velocity: m/s; criticalRolling: m; viscoelasticTime, duration: s; stepFraction: t0."""
WHICH = {
    "desk": "A selection.",
    "full": "All of the paper's.",
    "beyond": "What the desk's leave open: compacted aggregates in space, limit = held, both, xi_crit = 30 Angstrom.",
}


def rows(size):
    """Rows of a table: every point with the first seed, then with the next one. In desk space and drag come last."""
    folder = "runs/sintered" + ("" if size == "desk" else f"-{size}")
    groups = [DESK, [point for point in SPACE if point not in DESK]] if size == "desk" else [POINTS[size]]
    return [point.row(seed, folder) for group in groups for seed in SEEDS for point in group]


def tables():
    """{size: (rows, head)}."""
    return {size: (rows(size), HEAD.format(which)) for size, which in WHICH.items()}


# ---- compacted aggregates ----


def compacted(size):
    """{file: (point, seed)} of the compacted aggregates that the rows of a table need."""
    return {point.grown(seed, 0): (point, seed) for seed in SEEDS for point in POINTS[size] if point.growth}


def grow(point, seed):
    """Make both packings of a compacted aggregate; one line about it. Raises PackingError when halves don't stick."""
    ice = MATERIALS["ice"]
    half = packings.bcca(START, ice.grainRadius, equilibrium_overlap(ice), seed, 0, bool(point.planar))
    with tempfile.TemporaryDirectory() as folder:
        for attempt in range(ATTEMPTS):
            run = os.path.join(folder, str(attempt))
            files = [f"{run}-{index}.npz" for index in (0, 1)]
            for index, file in enumerate(files):
                packings.save(file, turned(half, seed, 1000 + 2 * attempt + index))
            collide(half, point, files, run)
            found = largest_piece_of_run(run)
            if found.grains >= STUCK * 2 * START:
                break
        else:
            what = f"halves did not stick at {point.growth:g} m/s in {ATTEMPTS} orientations"
            raise PackingError(f"{point.grown(seed, 0)}: {what}; must be a smaller growth velocity")
    about = {**found.parameters, "growthVelocity": point.growth, "criticalRolling": point.rolling * 1e-10}
    about |= {"limit": point.limit, "start": START, "generations": 1}
    aggregate = Packing(found.position, found.radius, seed, about)
    for index in (1, 0):  # the target last: when it is there, both are
        packings.save(point.grown(seed, index), turned(aggregate, seed, 100 + index))
    contacts = 2 * len(packings.contacts(aggregate)) / aggregate.grains
    return f"{point.grown(seed, 0)}: {aggregate.grains} grains, {contacts:.2f} contacts a grain"


def collide(half, point, files, run):
    """Run the collision that compacts, at V_g."""
    duration = min(float(DURATION), CROSSINGS * 2 * packings.extent(half) / point.growth)
    arguments = dict(packing="file", atRest=0, file=files[0], projectileFile=files[1], velocity=point.growth, out=run)
    arguments |= dict(criticalRolling=point.rolling * 1e-10, slidingStiffnessFactor=SLIDING, limit=point.limit)
    arguments |= dict(planar=point.planar, duration=duration, states=2, threads=1)
    command = ["yade", "-n", "-x", os.path.join(TOP, "yade_scripts", "collide.py")]
    command += [f"{name}={value}" for name, value in arguments.items()]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        raise PackingError(f"collide.py failed: {done.stderr.strip()}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=["grow"])
    parser.add_argument("size", choices=sorted(POINTS))
    parser.add_argument("-j", "--jobs", type=int, default=CORES)
    options = parser.parse_args()
    os.makedirs(GROWN, exist_ok=True)
    failed = 0
    with ThreadPoolExecutor(max(1, options.jobs)) as pool:
        missing = [which for file, which in compacted(options.size).items() if not os.path.exists(file)]
        for found in [pool.submit(grow, *which) for which in missing]:
            try:
                print(found.result(), flush=True)
            except (PackingError, OSError) as error:
                failed = 1
                tell(error, "sintered.py")
    sys.exit(failed)


if __name__ == "__main__":
    main()
