# SPDX-License-Identifier: MIT
"""Compares what a code gives with cases.json, and samples of its aggregates with ensembles.json.

    python3 check.py RESULTS.json [--long]      a line a case, with --long one a question
    python3 check.py RESULTS.json RESULTS.json ...      a table, case against code
    python3 check.py SAMPLES.json      a line a distribution

Python alone, no packages. Ends with status 1 where something differs or is incomplete. README.md describes the files.
"""

import argparse
import json
import math
import random
import sys
from pathlib import Path
from statistics import mean, stdev

HERE = Path(__file__).resolve().parent
ROUNDING = 1e-9  # below it an error has no order
FIRST_ORDER = 0.8  # least order between any two steps of errors that fall in proportion to the step
SHUFFLES = 9999
CONVERGES = "converges, first order"


# ---- cases ----


def require(results, suite):
    """Raise ValueError where results can't be compared with a suite."""
    names = [case["id"] for case in suite["cases"]]
    for case, answer in results["cases"].items():
        if case not in names:
            raise ValueError(f"{case}: must be one of {', '.join(names)}")
        if "not modelled" in answer:
            continue
        steps = answer["steps"]
        if len(steps) < 2 or steps != sorted(set(steps), reverse=True) or steps[-1] <= 0:
            raise ValueError(f"{case}: steps {steps}: must be two or more, the longest first")
        for question, values in answer["values"].items():
            if values is not None and len(values) != len(steps):
                raise ValueError(f"{case}: {question}: {len(values)} values: must be {len(steps)}, one a step")


def suite_of(name, results):
    """cases.json or ensembles.json, which must be of the version of the results."""
    suite = json.loads((HERE / name).read_text())
    if results.get("suite") != suite["version"]:
        raise ValueError(f"version {results.get('suite')} of the suite: must be {suite['version']}")
    return suite


def compare_question(question, steps, values, suite):
    """{word, difference (relative), order (None: below rounding)} of a question's values, the longest step first."""
    if values is None:
        return dict(word="not answered", difference=None, order=None)
    exact = float(question["value"])
    scale = question.get("scale", abs(exact))
    errors = [math.nan if value is None else (value - exact) / scale for value in values]
    if not all(map(math.isfinite, errors)):
        return dict(word="does not occur", difference=math.inf, order=None)
    ratio = (steps[-2] / steps[-1]) ** question.get("order", suite["order"])
    limit = abs(errors[-1] + (errors[-1] - errors[-2]) / (ratio - 1))
    order = None
    if min(abs(errors[0]), abs(errors[-1])) > ROUNDING:
        order = math.log(abs(errors[0] / errors[-1])) / math.log(steps[0] / steps[-1])
    ratios = [(longer / shorter) ** FIRST_ORDER for longer, shorter in zip(steps, steps[1:])]
    falls = all(abs(more) >= ratio * abs(less) for more, less, ratio in zip(errors, errors[1:], ratios))
    word = "agrees" if limit <= suite["tolerance"] else CONVERGES if falls else "differs"
    return dict(word=word, difference=limit, order=order)


def compare_case(case, answer, suite):
    """{word, why, questions: {name: compare_question()}, difference: the largest} of a case.

    It agrees only where all is answered but the channels of energy, which not every code has.
    """
    if answer is None:
        return dict(word="not run", why="", questions={})
    if "not modelled" in answer:
        return dict(word="not modelled", why=answer["not modelled"], questions={})
    found, missing = {}, False
    for question in case["asked"]:
        name = question["name"]
        found[name] = compare_question(question, answer["steps"], answer["values"].get(name), suite)
        missing |= found[name]["word"] == "not answered" and question["measure"]["kind"] != "channel"
    answered = {name: one["difference"] for name, one in found.items() if one["word"] != "not answered"}
    if not answered:
        return dict(word="incomplete", why="nothing is answered", questions={})
    worst = max(answered, key=answered.get)
    words = {one["word"] for one in found.values()}
    differs = words & {"differs", "does not occur"}
    word = "differs" if differs else "incomplete" if missing else CONVERGES if CONVERGES in words else "agrees"
    share = "" if len(answered) == len(found) else f"{len(answered)} of {len(found)} answered; "
    why = f"{share}{size(answered[worst], 1)}; worst: {worst}"
    return dict(word=word, why=why, questions=found, difference=answered[worst])


def compare_cases(results):
    """{case: compare_case()} of a results file."""
    suite = suite_of("cases.json", results)
    require(results, suite)
    return {case["id"]: compare_case(case, results["cases"].get(case["id"]), suite) for case in suite["cases"]}


def size(difference, digits=0):
    return f"{difference:.{digits}e}" if math.isfinite(difference) else "does not occur"


def print_cases(cases, long):
    for name, case in cases.items():
        print(f"{name:18}{case['word']}" + (f" ({case['why']})" if case["why"] else ""))
        for question, one in case["questions"].items() if long else ():
            difference = "" if one["difference"] is None else f" {one['difference']:.1e}"
            order = "" if one["order"] is None else f", order {one['order']:.2f}"
            print(f"    {one['word']:24}{question}{difference}{order}")


def print_table(of_codes):
    """Print Markdown, case against code: agrees, or by how much it differs. of_codes: {code: {case: verdict}}"""
    print("| " + " | ".join(["case", *of_codes]) + " |")
    print("| " + " | ".join(["---"] * (1 + len(of_codes))) + " |")
    for name in next(iter(of_codes.values())):
        row = [cases[name] for cases in of_codes.values()]
        cells = [size(case["difference"]) if case["word"] == "differs" else case["word"] for case in row]
        print("| " + " | ".join([name, *cells]) + " |")


# ---- aggregates ----


def distance(values, first):
    """Integral of the squared difference of two distributions: of (value, label) in order, `first` of label 1."""
    found, ahead, second = 0.0, 0.0, len(values) - first
    for (value, label), (following, _) in zip(values, values[1:]):
        ahead += 1 / first if label else -1 / second
        found += ahead**2 * (following - value)
    return found


def p_value(sample, reference):
    """Probability that samples of one distribution are as far apart (Cramer's distance), by shuffling the labels."""
    pooled = sorted([(x, 1) for x in sample] + [(x, 0) for x in reference])
    values, labels, draw = [x for x, _ in pooled], [label for _, label in pooled], random.Random(1)
    observed, as_far = distance(pooled, len(sample)) * (1 - 1e-12), 0
    for _ in range(SHUFFLES):
        draw.shuffle(labels)
        as_far += distance(list(zip(values, labels)), len(sample)) >= observed
    return (as_far + 1) / (SHUFFLES + 1)


def compare_samples(results):
    """{distribution: {word, why}} of a file of samples."""
    suite = suite_of("ensembles.json", results)
    references, found = {d["id"]: d["values"] for d in suite["distributions"]}, {}
    level = suite["level"] / len(references)
    for name, values in results["samples"].items():
        if name not in references:
            raise ValueError(f"{name}: must be one of {', '.join(references)}")
        reference = references[name]
        least = next(n for n in range(2, 1000) if 1 / math.comb(n + len(reference), n) < level)
        if len(values) < least or not all(map(math.isfinite, values)):
            raise ValueError(f"{name}: {len(values)} runs: must be {least} or more, all finite numbers")
        p = p_value(values, reference)
        why = f"p {p:.4f}; mean {mean_and_error(values)}, reference {mean_and_error(reference)}"
        found[name] = dict(word="differs" if p < level else "no difference found", why=why, questions={})
    return found


def mean_and_error(values):
    return f"{mean(values):.4g} ± {stdev(values) / len(values) ** 0.5:.2g}"


# ---- files ----


def main(*words):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", nargs="+", type=Path)
    parser.add_argument("--long", action="store_true", help="a line a question")
    given = parser.parse_args(words)
    of_codes, words = {}, set()
    for path in given.results:
        try:
            results = json.loads(path.read_text())
            found = compare_samples(results) if "samples" in results else compare_cases(results)
        except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
            sys.exit(f"check.py: {path}: must be a results file (README.md): {error!r}")
        words |= {one["word"] for one in found.values()}
        if "samples" in results or len(given.results) == 1:
            print_cases(found, given.long)
        else:
            of_codes[path.stem] = found
    if of_codes:
        print_table(of_codes)
    return 1 if words & {"differs", "incomplete"} else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
