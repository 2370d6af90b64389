"""How long a step a compression needs: the ledger's error and the pressure against the step.

    python3 tests/benchmarks/compression_step.py FOLDER    run what is missing in FOLDER (half an hour on one core), write results

Clusters of 256 grains are compressed to a filling of 0.5 at C_v = 1e-5, with and without damping, with steps of 0.05 to
0.36 t0. Writes results/compression_step.md. A run of another step is another path through the same events, so that its
pressure differs by chance: what counts is the mean over seeds and bins against its error.
"""

import subprocess
import sys
from itertools import product
from pathlib import Path

import numpy as np
from measured_on import RESULTS, TOP, machine

sys.path.insert(0, str(TOP))

from analysis import open_run  # noqa: E402
from analysis.measures.ledger import total_energy  # noqa: E402
from analysis.measures.periodic_compression import pressures  # noqa: E402
from analysis.statistics import mean_and_error  # noqa: E402

STEPS = (0.05, 0.1, 0.2, 0.3, 0.36)  # t0; the first is the reference
DAMPING, SEEDS = (0.01, 0.0), (1, 2, 3, 4, 5, 6)
SCENE = {"grains": 256, "strainRate": 1e-5, "threads": 1}
BINS = np.geomspace(0.03, 0.5, 13)


def run_of(folder, damping, step, seed):
    """RunFolder of one run, made when it is missing."""
    path = Path(folder) / f"k{damping:g}-step{step:g}-s{seed}"
    if not (path / "ended").exists():
        given = {**SCENE, "linearDamping": damping, "stepFraction": step, "seed": seed, "out": path, "overwrite": 1}
        command = [
            "yade",
            "-n",
            "-x",
            str(TOP / "yade_scripts" / "compress.py"),
            *(f"{k}={v}" for k, v in given.items()),
        ]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return open_run(path)


def ledger_error(run):
    """Largest change of the sum of all channels over the work of the boundaries until then, up to a filling of 0.1 and to
    the end."""
    history = run.history
    total, work = total_energy(history), -history["boundaryWork"]
    thin = history["filling"] < 0.1
    return [float(np.abs(total - total[0])[part].max() / work[part].max()) for part in (thin, thin | True)]


def binned_pressure(run):
    """Pressure (12,) in BINS, by the work of the boundaries (curve.py): samples of the virial miss what contacts without damping
    do between them."""
    filling, pressure = pressures(run.history)
    place = np.digitize(filling, BINS)
    return np.array([pressure[place == k].mean() for k in range(1, len(BINS))])


def lines(folder):
    """Rows of the table."""
    for damping in DAMPING:
        reference = {}
        for step in STEPS:
            runs = {seed: run_of(folder, damping, step, seed) for seed in SEEDS}
            pressure = {seed: binned_pressure(run) for seed, run in runs.items()}
            reference = reference or pressure
            thin, whole = np.mean([ledger_error(run) for run in runs.values()], axis=0)
            ratios = [np.log(np.abs(pressure[seed] / reference[seed])) for seed in SEEDS]
            low, high = ([float(np.mean(ratio[part])) for ratio in ratios] for part in (slice(0, 5), slice(5, None)))
            cells = [f"{mean:+.3f} ± {error:.3f}" for mean, error in map(mean_and_error, (low, high))]
            yield f"| {damping:g} | {step:g} | {thin:.1e} | {whole:.1e} | {cells[0]} | {cells[1]} |"


def main(folder):
    for damping, step, seed in product(DAMPING, STEPS[::-1], SEEDS):
        run_of(folder, damping, step, seed)
    about = machine()
    head = (
        f"Compression of {SCENE['grains']} grains of ice at C_v = {SCENE['strainRate']:g} to a filling of 0.5, mean of "
        f"{len(SEEDS)} seeds. Measured on: {about['cpu']}, commit {about['commit']}.\n\nledger: largest error of the sum of all channels over the work of "
        f"the boundaries; P: mean of ln(P/P at a step of {STEPS[0]:g} t0) over bins of the filling, with its standard error "
        "from the seeds.\n\n| k_n | step [t0] | ledger, filling < 0.1 | ledger, to 0.5 | ln P ratio, 0.03-0.1 | ln P ratio, "
        "0.1-0.5 |\n|---:|---:|---:|---:|---:|---:|\n"
    )
    (RESULTS / "compression_step.md").write_text(head + "\n".join(lines(folder)) + "\n", encoding="utf-8")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(sys.argv[1])
