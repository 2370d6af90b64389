"""Are the histories of sixteen scenes still the same to the bit? Temporary: it goes when the house has been halved.

/usr/bin/python3 tests/freeze/freeze.py [--write] [--sets avx512,avx2,portable] [SCENE ...]

Each scene runs by its script in plain YADE with each instruction set that the processor has. The sums of all arrays of
history.npz and states/*.npz are compared with those in sums.json beside this file (--write: are put there).
"""

import argparse
import hashlib
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
TOP = HERE.parents[1]
SUMS = HERE / "sums.json"
COLLIDE, COMPRESS, OWN = "yade_scripts/collide.py", "yade_scripts/compress.py", "tests/freeze/own_scenes.py"
CELL = "grains=64 strainRate=1e-4 finalFilling=0.3 states=5"
SCENES = {
    "cpe": (COLLIDE, "radius=7 states=5"),
    "bpca": (COLLIDE, "packing=bpca atRest=0 grains=150 velocity=15 impact=0.3 duration=1e-7 states=5"),
    "bcca_drag": (
        COLLIDE,
        "packing=bcca atRest=0 grains=100 velocity=15 viscoelasticTime=6e-12 duration=1e-7 states=5",
    ),
    "sintered_cut": (
        COLLIDE,
        "packing=bcca atRest=0 grains=80 velocity=15 neck=0.3 limit=cut planar=1 duration=1e-7 states=5",
    ),
    "sintered_held": (COLLIDE, "packing=bcca atRest=0 grains=80 velocity=15 neck=0.4 duration=1e-7 states=5"),
    "unlike": (
        COLLIDE,
        "packing=bpca atRest=0 grains=80 velocity=15 sizes=lognormal sizeSpread=0.3 duration=1e-7 states=5",
    ),
    "plate": (COLLIDE, "target=wall packing=bpca atRest=0 grains=100 velocity=8 duration=1e-7 states=5"),
    "impact_step": (
        COLLIDE,
        "packing=bpca atRest=0 grains=80 velocity=15 impactStepFraction=0.05 duration=6e-8 states=5",
    ),
    "silicate": (COLLIDE, "packing=bpca atRest=0 grains=80 velocity=1 material=silicate states=5"),
    "functors": (COLLIDE, "packing=bcca atRest=0 grains=20 velocity=15 engine=functors duration=4e-8 states=5"),
    "piston": (COMPRESS, "boundary=walls " + CELL),
    "cell": (COMPRESS, CELL + " atRest=0"),
    "stretch": (COMPRESS, CELL + " atRest=0 stretch=x"),
    "resumed": (
        COLLIDE,
        "packing=bpca atRest=0 grains=400 velocity=15 seed=2 duration=3e-7 states=5 checkpointInterval=0.05",
    ),
    "sinter": (OWN, "sinter"),
    "appended": (OWN, "appended"),
}
STOPPED = ("resumed",)  # stopped once, and resumed


def run(scene, instructions, folder):
    """{array: sum} of a scene's run in a folder."""
    script, words = SCENES[scene]
    out = f"{folder}/{scene}-{instructions}"
    command = ["yade", "-n", "-x", "-j1", str(HERE / "in_yade.py"), instructions, str(TOP / script), *words.split()]
    command += [f"out={out}"]
    if scene in STOPPED:
        _start_and_stop(command, out, folder)
        command.append("resume=1")
    done = subprocess.run(command, capture_output=True, text=True, cwd=folder)
    if done.returncode:
        raise RuntimeError(
            f"{scene} {instructions}: status {done.returncode}\n{done.stdout[-1500:]}{done.stderr[-1500:]}"
        )
    return sums(Path(out))


def _start_and_stop(command, out, folder):
    """SIGTERM to a run as soon as it has a checkpoint."""
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, cwd=folder)
    while process.poll() is None and not os.path.exists(f"{out}/checkpoint/recorder.npz"):
        time.sleep(0.05)
    process.send_signal(signal.SIGTERM)
    if process.wait() == 0:
        raise RuntimeError(f"{out}: came to its end before it could be stopped")


def sums(folder):
    found = {}
    for file in [folder / "history.npz", *sorted(folder.glob("states/*.npz"))]:
        with np.load(file) as arrays:
            for name in arrays.files:
                array = np.ascontiguousarray(arrays[name])
                found[f"{file.stem}/{name}"] = hashlib.sha256(array.tobytes()).hexdigest()[:12]
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="*", metavar="SCENE")
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--sets", default="avx512,avx2,portable")
    options = parser.parse_args()
    flags = Path("/proc/cpuinfo").read_text()
    sets = [s for s in options.sets.split(",") if s == "portable" or s.replace("avx512", "avx512vl") in flags]
    written = json.loads(SUMS.read_text()) if SUMS.exists() else {}
    jobs = [(s, "portable") if s == "functors" else (s, i) for s in options.scenes or SCENES for i in sets]
    jobs = list(dict.fromkeys(jobs))
    folder, wrong = tempfile.mkdtemp(prefix="freeze"), 0
    with ThreadPoolExecutor(2) as pool:
        for (scene, instructions), found in zip(jobs, pool.map(lambda job: run(*job, folder), jobs)):
            before = written.setdefault(scene, {}).get(instructions, {})
            differs = [name for name in {**before, **found} if before.get(name) != found.get(name)]
            wrong += bool(differs) and not options.write
            state = "written" if options.write else f"differs: {', '.join(sorted(differs)[:12])}" if differs else "same"
            print(f"{scene:14s} {instructions:9s} {len(found):4d} arrays: {state}", flush=True)
            if options.write:
                written[scene][instructions] = found
    if options.write:
        SUMS.write_text(json.dumps(written, indent=0, sort_keys=True) + "\n")
    shutil.rmtree(folder)
    return int(wrong > 0)


if __name__ == "__main__":
    sys.exit(main())
