"""Equality and speed of the ensemble on a GPU, as lines of JSON that come as they are found (on_device.sh).

    python3 tests/gpu/on_device.py prepare          makes the pairs of aggregates, build/gpu/pairs.npz (needs numba)
    python3 tests/gpu/on_device.py measure SECONDS  needs that file and the libraries beside it, numpy and scipy

Speeds are of 2 x 256 BPCA grains of ice at 5 m/s, 0.1 t0, 0.4 us (20,660 steps), without an early end, extrapolated
from a part of the steps around the impact; and of two larger sizes.
"""

import json
import sys
import time
from dataclasses import astuple, replace
from pathlib import Path

import numpy as np

TOP = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(TOP))
from analysis import theory
from yade_scripts.run.ensemble import BUILT, DEVICE, MECHANISMS, PROCESSOR, WHOLE_DEVICE, Collision, Grains, Library

PAIRS = BUILT / "pairs.npz"
RADIUS = 1e-7
PAIR = theory.pair_constants(theory.ICE, RADIUS)
STEP = 0.1 * PAIR.time_unit
LASTING = round(0.4e-6 / STEP)
MADE = {256: 32, 2048: 4, 8192: 2, 50_000: 1}  # grains of an aggregate: pairs


def prepare():
    from yade_scripts import packings
    from yade_scripts.packings.placing import offset_pair

    arrays = {}
    for grains, pairs in MADE.items():
        for seed in range(pairs):
            one, other = (packings.bpca(grains, RADIUS, PAIR.equilibrium_overlap, 2 * seed + k) for k in (0, 1))
            pair, _ = offset_pair(one, other, 1.0, 0.3 * (seed % 3))
            arrays[f"{grains}-{seed}"] = np.array([packing.position for packing in pair])
    PAIRS.parent.mkdir(parents=True, exist_ok=True)
    np.savez_compressed(PAIRS, **arrays)


def collisions(library, grains, count, steps, velocity=5.0, interval=500, **options):
    """So many collisions of the pairs of that size, in turn."""
    found = []
    with np.load(PAIRS) as pairs:
        positions = [pairs[f"{grains}-{seed}"] for seed in range(MADE[grains])]
    material = replace(theory.ICE, viscoelastic_time=6e-12 if "mechanisms" in options else 0.0)
    for number in range(count):
        position = positions[number % len(positions)]
        moving = np.zeros((2, grains, 3))
        moving[0, :, 0], moving[1, :, 0] = velocity / 2, -velocity / 2
        sign = np.sign(position[1, :, 0].mean() - position[0, :, 0].mean())
        one = Grains(
            position.reshape(-1, 3),
            sign * moving.reshape(-1, 3),
            np.full(2 * grains, RADIUS),
            np.array([astuple(material)]),
            aggregate=np.repeat([0, 1], grains),
        )
        found.append(Collision(library, one, steps, STEP, interval, **options))
    return found


def say(what, **numbers):
    print(json.dumps({"what": what, **numbers}), flush=True)


def timed(library, many, steps):
    begun = time.perf_counter()
    library.run(many, steps)
    return time.perf_counter() - begun


def equality(processor, device):
    """The same collisions by both back ends: largest difference of positions over the radius, and the channels'."""
    for name, options in (
        ("held", {}),
        ("cut", {"limit": "cut"}),
        ("drag", {"mechanisms": sum(MECHANISMS.values())}),
        ("bonds", {"neck": 0.3}),
    ):
        both = []
        for library in (processor, device):
            many = collisions(library, 256, 8, 2000, velocity=20.0, **options)
            library.run(many, 2000)
            both.append([each.read() for each in many])
        apart = [np.abs(a.motion()[0] - b.motion()[0]).max() / RADIUS for a, b in zip(*both)]
        energy = [
            max(np.abs(a.samples()[c][-1] - b.samples()[c][-1]) for c in device.channels) / a.samples()["kinetic"][0]
            for a, b in zip(*both)
        ]
        formed = [(a.samples()["formed"][-1], b.samples()["formed"][-1]) for a, b in zip(*both)]
        failures = [each.failure for each in both[1] if each.failure]
        say("equality", scene=name, apart=sorted(apart), energy=max(energy), formed=formed, failures=failures)


def same_bits(device):
    """Whether a launch gives the same bits twice."""
    ends = []
    for _ in range(2):
        many = collisions(device, 256, 64, 3000, velocity=20.0)
        device.run(many, 3000)
        ends.append([each.read().motion() for each in many])
    say("same bits", same=bool(np.array_equal(*ends)))


def speed(library, grains, counts, until, steps=1000):
    """Collisions a second against how many there are in a launch."""
    for count in counts:
        if time.monotonic() > until:
            return say("speed", grains=grains, count=count, left_out="time is up")
        many = collisions(library, grains, count, LASTING)
        timed(library, many, 200)
        seconds = [timed(library, many, steps) for _ in range(3)]
        contacts = np.mean([len(each.read().contacts()[0]) for each in many[:: max(1, count // 16)]])
        best = np.median(seconds)
        say(
            "speed",
            grains=2 * grains,
            count=count,
            seconds=seconds,
            microseconds_a_step=1e6 * best / steps,
            collisions_a_second=count / (best / steps * LASTING),
            updates_a_second=count * contacts * steps / best,
            failures=sum(each.read().failure is not None for each in many),
        )


def measure(seconds):
    until = time.monotonic() + seconds
    processor, device = Library(PROCESSOR), Library(DEVICE)
    for variant in sorted(BUILT.glob("libdevice-*x*.so")):
        say("variant", name=variant.stem)
        speed(Library(variant), 256, (264, 1056), until, 300)
    say("device", name=device.device, library=str(DEVICE))
    whole = Library(WHOLE_DEVICE)
    for library in (device, whole):
        equality(processor, library)
        same_bits(library)
    for grains in (256, 2048, 8192, 50_000):  # one collision by the whole device
        speed(whole, grains, (1,), until, 300)
    speed(device, 256, (132, 264, 528, 1056, 4224), until)
    speed(device, 2048, (132, 528), until, 300)
    speed(device, 8192, (132, 264), until, 100)
    if time.monotonic() < until:
        many = collisions(device, 256, 2112, LASTING)
        taken = timed(device, many, LASTING)
        failures = [each.read().failure for each in many]
        say("to the end", collisions=len(many), seconds=taken, failures=len(failures) - failures.count(None))


if __name__ == "__main__":
    prepare() if sys.argv[1] == "prepare" else measure(float(sys.argv[2]))
