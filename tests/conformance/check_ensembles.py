# SPDX-License-Identifier: MIT
"""Compares samples of a code with ensembles.json:  python3 check_ensembles.py SAMPLES.json

SAMPLES.json: {"code": ..., "suite": version, "samples": {distribution: [value of each run]}}, as many of them as there are.
Python alone, no packages. Ends with status 1 where a distribution differs.
"""

import json
import math
import random
import sys
from pathlib import Path
from statistics import NormalDist, mean, stdev

ENSEMBLES = Path(__file__).with_name("ensembles.json")
SHUFFLES, POWER = 9999, 0.9


def distance(values, first):
    """Integral of the squared difference of two empirical distributions: of (value, label) in order, `first` of label 1."""
    found, ahead, second = 0.0, 0.0, len(values) - first
    for (value, label), (following, _) in zip(values, values[1:]):
        ahead += 1 / first if label else -1 / second
        found += ahead**2 * (following - value)
    return found


def p_value(sample, reference):
    """Probability that two samples of one distribution are as far apart (Cramer's distance), by shuffling the labels."""
    pooled = sorted([(x, 1) for x in sample] + [(x, 0) for x in reference])
    values, labels, draw = [x for x, _ in pooled], [label for _, label in pooled], random.Random(1)
    observed, as_far = distance(pooled, len(sample)) * (1 - 1e-12), 0
    for _ in range(SHUFFLES):
        draw.shuffle(labels)
        as_far += distance(list(zip(values, labels)), len(sample)) >= observed
    return (as_far + 1) / (SHUFFLES + 1)


def found_shift(reference, level, runs):
    """Shift of the mean that a sample of so many runs shows with a probability POWER (normal distributions)."""
    z = NormalDist().inv_cdf(1 - level / 2) + NormalDist().inv_cdf(POWER)
    return z * stdev(reference) * (1 / runs + 1 / len(reference)) ** 0.5


def compared(samples, suite):
    """{distribution: {said, p, mean, reference, shift}} of those that are there."""
    given = {d["id"]: d["values"] for d in suite["distributions"]}
    if unknown := sorted(set(samples) - set(given)):
        sys.exit(f"check_ensembles.py: {unknown[0]}: must be one of {', '.join(given)}")
    found, level = {}, suite["level"] / len(given)
    for name, values in samples.items():
        least = next(n for n in range(2, 1000) if 1 / math.comb(n + len(given[name]), n) < level)
        if len(values) < least:
            sys.exit(f"check_ensembles.py: {name}: {len(values)} runs: must be {least} or more, which can differ")
        if not all(map(math.isfinite, values)):
            sys.exit(f"check_ensembles.py: {name}: all values must be finite numbers")
        p = p_value(values, given[name])
        shift = found_shift(given[name], level, len(values))
        said = "differs" if p < level else "not told apart"
        found[name] = dict(said=said, p=p, mean=mean(values), reference=mean(given[name]), shift=shift)
    return found


def main(path):
    try:
        suite, results = json.loads(ENSEMBLES.read_text()), json.loads(Path(path).read_text())
        samples = {name: [float(x) for x in values] for name, values in results["samples"].items()}
        version = results["suite"]
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        sys.exit(f"check_ensembles.py: {path}: {error!r}: must be a file of samples (README.md)")
    if version != suite["version"]:
        sys.exit(f"check_ensembles.py: samples are of version {version}: must be {suite['version']}")
    found = compared(samples, suite)
    for name, one in found.items():
        seen = f"mean {one['mean']:.4g}, reference {one['reference']:.4g}; shifts of {one['shift']:.2g} are found by {POWER:.0%}"
        print(f"{name:22}{one['said']} (p {one['p']:.4f}; {seen})")
    return 1 if any(one["said"] == "differs" for one in found.values()) else 0


if __name__ == "__main__":
    sys.exit(print(__doc__) if "--help" in sys.argv else main(*sys.argv[1:]) if len(sys.argv) == 2 else __doc__)
