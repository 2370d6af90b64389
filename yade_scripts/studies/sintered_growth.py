"""Grows the compacted aggregates of Sirono & Ueno (2017), section 4.

    python3 yade_scripts/studies/sintered_growth.py SIZE [-j JOBS]    of a table (desk, full, beyond, decide)

Section 4 makes aggregates of 1,024 grains by "collision simulations" at V_g, section 5.2 speaks of "successive
collisions", without their start. Here an aggregate starts as a BCCA cluster of START grains and collides
head-on with itself, both in random orientations, until it has 1,024 grains: each collision's largest piece, at rest, is
the next one's aggregate (packings/from_run.py). A generation whose largest piece has less than STUCK of the grains is
tried again in other orientations, ATTEMPTS times.

The start decides how compact aggregates are. The paper's Fig. 6 has about two contacts a grain at low V_g and three at
high V_g, and Fig. 17 needs fewer than 2.33 at 1 m/s, 2.31 at 2 m/s and more than 2.36 at 3 m/s (by eqs 14 to 19). One
collision, START = 512, gives 2.15, 2.49 and 3.01 at 1, 3 and 10 m/s (one seed). Six from START = 16 gave 2.5, 2.9 and
3.2, which Figs 6 and 17 exclude. So it is 512.

Packings are runs/sintered-grown/NAME.npz and NAME-b.npz, the same aggregate in two orientations: target and projectile.
A second call makes what is missing.
"""

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor

TOP = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, TOP)
from yade_scripts import packings
from yade_scripts.materials import MATERIALS, pair_constants
from yade_scripts.packings.from_run import largest_piece_of_run, turned
from yade_scripts.packings.packing import Packing, PackingError
from yade_scripts.parameters.errors import tell
from yade_scripts.run.parameters import CORES
from yade_scripts.studies.sintered import DURATION, GRAINS, GROWN, POINTS, SLIDING
from yade_scripts.studies.sintered import grown as grown_of

START = 512
STUCK, ATTEMPTS = 0.9, 5
RADIUS = 1e-7  # m
# A collision lasts as long as the two take to move so many times their diameters at V_g, and no longer than DURATION.
CROSSINGS = 3.0


def grow(grown):
    """Make both packings of an aggregate; one line about it. Raises PackingError when a generation doesn't stick."""
    constants = pair_constants(MATERIALS["ice"])
    aggregate = packings.bcca(START, RADIUS, constants["equilibriumOverlap"], grown.seed, 0, bool(grown.planar))
    with tempfile.TemporaryDirectory() as folder:
        generation = 0
        while 2 * aggregate.grains <= GRAINS:
            aggregate = _next(aggregate, grown, generation, folder)
            generation += 1
    about = {
        **aggregate.parameters,
        "growthVelocity": grown.velocity,
        "criticalRolling": grown.rolling * 1e-10,
        "limit": grown.limit,
        "start": START,
        "generations": generation,
    }
    aggregate = Packing(aggregate.position, aggregate.radius, grown.seed, about)
    for index in (1, 0):  # the target last: when it is there, both are
        packings.save(grown.file(index), turned(aggregate, grown.seed, 100 + index))
    contacts = 2 * len(packings.contacts(aggregate)) / aggregate.grains
    return f"{grown.name}: {aggregate.grains} grains, {contacts:.2f} contacts a grain"


def _next(aggregate, grown, generation, folder):
    for attempt in range(ATTEMPTS):
        run = os.path.join(folder, f"{generation}-{attempt}")
        files = [f"{run}-{index}.npz" for index in (0, 1)]
        for index, file in enumerate(files):
            packings.save(file, turned(aggregate, grown.seed, 1000 + 20 * generation + 2 * attempt + index))
        _collide(aggregate, grown, files, run)
        found = largest_piece_of_run(run)
        shutil.rmtree(run)
        if found.grains >= STUCK * 2 * aggregate.grains:
            return found
    raise PackingError(
        f"{grown.name}: two aggregates of {aggregate.grains} grains did not stick at {grown.velocity:g} m/s in "
        f"{ATTEMPTS} "
        f"orientations; must be a smaller growth velocity"
    )


def _collide(aggregate, grown, files, run):
    duration = min(float(DURATION), CROSSINGS * 2 * packings.extent(aggregate) / grown.velocity)
    arguments = dict(
        packing="file",
        file=files[0],
        projectileFile=files[1],
        planar=grown.planar,
        velocity=grown.velocity,
        criticalRolling=grown.rolling * 1e-10,
        limit=grown.limit,
        slidingStiffnessFactor=SLIDING,
        duration=duration,
        states=2,
        threads=1,
        out=run,
    )
    command = ["yade", "-n", "-x", os.path.join(TOP, "yade_scripts", "collide.py")]
    # yade-batch's choice of a table's row must not reach the collisions here.
    environment = {name: value for name, value in os.environ.items() if name != "YADE_BATCH"}
    done = subprocess.run(
        command + [f"{name}={value}" for name, value in arguments.items()],
        capture_output=True,
        text=True,
        env=environment,
    )
    if done.returncode:
        lines = [line for line in done.stderr.splitlines() if line.strip()]
        raise PackingError(f"{grown.name}: collide.py failed: {lines[-1] if lines else done.returncode}")


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("size", choices=sorted(POINTS))
    parser.add_argument("-j", "--jobs", type=int, default=CORES)
    options = parser.parse_args(arguments)
    missing = [grown for grown in grown_of(options.size) if not os.path.exists(grown.file(0))]
    os.makedirs(GROWN, exist_ok=True)
    failed = 0
    with ThreadPoolExecutor(max(1, options.jobs)) as pool:
        for found in [pool.submit(grow, grown) for grown in missing]:
            try:
                print(found.result(), flush=True)
            except (PackingError, OSError) as error:
                failed = 1
                tell(error, "sintered_growth.py")
    return failed


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
