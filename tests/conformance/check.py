# SPDX-License-Identifier: MIT
"""Compares what a code gives with cases.json, and samples of its aggregates with ensembles.json.

    python3 check.py RESULTS.json [--long]      a line a case, with --long one a question
    python3 check.py RESULTS.json RESULTS.json ...      a table, case against code
    python3 check.py SAMPLES.json      a line a distribution

Python alone, no packages. Ends with status 1 where something differs or is incomplete. README.md describes the files.
"""

import json
import math
import random
import sys
from pathlib import Path
from statistics import mean, stdev

HERE = Path(__file__).resolve().parent
ROUNDING = 1e-9  # below it an error has no order
SHUFFLES = 9999


def refuse(what, must):
    sys.exit(f"check.py: {what}: must be {must}")


# ---- cases ----


def require(results, suite):
    """End with a line where results can't be compared with a suite."""
    if results.get("suite") != suite["version"]:
        refuse(f"results are of version {results.get('suite')} of the suite", suite["version"])
    questions = {case["id"]: [question["name"] for question in case["asked"]] for case in suite["cases"]}
    for case, answer in results["cases"].items():
        if case not in questions:
            refuse(case, f"one of {', '.join(questions)}")
        if "not modelled" in answer:
            continue
        steps = answer["steps"]
        if len(steps) < 2 or not all(a > b for a, b in zip([math.inf, *steps], [*steps, 0])):
            refuse(f"{case}: steps {steps}", "two or more, the longest first")
        for question, values in answer["values"].items():
            if question not in questions[case]:
                refuse(f"{case}: {question}", f"one of {', '.join(questions[case])}")
            if values is not None and len(values) != len(steps):
                refuse(f"{case}: {question}: {len(values)} values", f"{len(steps)}, one a step")


def checked(question, steps, values, suite):
    """{difference (relative), order (None: below rounding), word} of a question's values, the longest step first."""
    if values is None:
        return dict(difference=None, order=None, word="not answered")
    exact = float(question["value"])
    scale = question.get("scale", abs(exact))
    errors = [math.nan if v is None else (v - exact) / scale for v in values]
    if not all(map(math.isfinite, errors)):
        return dict(difference=math.inf, order=None, word="does not occur")
    falls = (steps[-2] / steps[-1]) ** question.get("order", suite["order"])
    limit = errors[-1] + (errors[-1] - errors[-2]) / (falls - 1)
    order = None
    if min(abs(errors[0]), abs(errors[-1])) > ROUNDING:
        order = math.log(abs(errors[0] / errors[-1])) / math.log(steps[0] / steps[-1])
    return dict(difference=abs(limit), order=order, word="agrees" if abs(limit) <= suite["tolerance"] else "differs")


def verdict(case, answer, suite):
    """{word, difference, order, worst} of a case: of its worst question; answered: how many of how many; questions.

    It agrees only where all is answered but what codes without a ledger can't.
    """
    if answer is None:
        return dict(word="not run")
    if "not modelled" in answer:
        return dict(word="not modelled", why=answer["not modelled"])
    found = {q["name"]: checked(q, answer["steps"], answer["values"].get(q["name"]), suite) for q in case["asked"]}
    known = {name: one for name, one in found.items() if one["difference"] is not None}
    if not known:
        return dict(word="incomplete", why="nothing is answered")
    missing = any(q["measure"]["kind"] != "channel" for q in case["asked"] if q["name"] not in known)
    wrong = any(one["word"] != "agrees" for one in known.values())
    word = "differs" if wrong else "incomplete" if missing else "agrees"
    worst = max(known, key=lambda name: known[name]["difference"])
    orders = sorted(one["order"] for one in known.values() if one["order"] is not None)
    order = orders[len(orders) // 2] if orders else None
    of_worst = dict(difference=known[worst]["difference"], order=order, worst=worst)
    return dict(word=word, answered=(len(known), len(found)), questions=found, **of_worst)


def verdicts(results):
    """{case: verdict} of a results file."""
    suite = json.loads((HERE / "cases.json").read_text())
    require(results, suite)
    return {case["id"]: verdict(case, results["cases"].get(case["id"]), suite) for case in suite["cases"]}


def in_words(found):
    if "difference" not in found:
        return found["word"] + (f": {found['why']}" if "why" in found else "")
    order = "" if found["order"] is None else f", order {found['order']:.1f}"
    by = "something does not occur" if math.isinf(found["difference"]) else f"{found['difference']:.1e}"
    some = "" if found["answered"][0] == found["answered"][1] else "{} of {} answered; ".format(*found["answered"])
    return f"{found['word']} ({some}{by}{order}; worst: {found['worst']})"


def in_lines(found, long):
    for name, one in found.items():
        yield f"{name:18}{in_words(one)}"
        for question, its in one.get("questions", {}).items() if long else ():
            by = "" if its["difference"] is None else f" {its['difference']:.1e}"
            order = "" if its["order"] is None else f", order {its['order']:.2f}"
            yield f"    {its['word']:16}{question}{by}{order}"


def in_a_table(found):
    """Lines of Markdown, case against code: agrees, or by how much it differs. found: {code: {case: verdict}}"""
    size = lambda x: f"{x:.0e}" if math.isfinite(x) else "does not occur"
    cell = lambda one: size(one["difference"]) if one["word"] == "differs" else one["word"]
    rows = [["case", *found], ["---"] * (1 + len(found))]
    rows += [[case, *(cell(its[case]) for its in found.values())] for case in next(iter(found.values()))]
    return ["| " + " | ".join(row) + " |" for row in rows]


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


def compared(results):
    """{distribution: {word, p, mean, reference}} of a file of samples."""
    suite = json.loads((HERE / "ensembles.json").read_text())
    if results.get("suite") != suite["version"]:
        refuse(f"samples are of version {results.get('suite')}", suite["version"])
    given, found = {d["id"]: d["values"] for d in suite["distributions"]}, {}
    for name, values in results["samples"].items():
        if name not in given:
            refuse(name, f"one of {', '.join(given)}")
        level = suite["level"] / len(given)
        least = next(n for n in range(2, 1000) if 1 / math.comb(n + len(given[name]), n) < level)
        if len(values) < least or not all(map(math.isfinite, values)):
            refuse(f"{name}: {len(values)} runs", f"{least} or more, which can differ, all finite numbers")
        p = p_value(values, given[name])
        found[name] = dict(word="differs" if p < level else "not told apart", p=p, of=values, reference=given[name])
    return found


def of_mean(values):
    return f"{mean(values):.4g} ± {stdev(values) / len(values) ** 0.5:.2g}"


def read(path):
    """{case or distribution: verdict} of a file, and whether it is of cases."""
    try:
        results = json.loads(Path(path).read_text())
        found = compared(results) if "samples" in results else verdicts(results)
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        sys.exit(f"check.py: {path}: {error!r}: must be a results file (README.md)")
    if all(one["word"] == "not run" for one in found.values()):
        sys.exit(f"check.py: {path}: no case of these; must have one or more")
    return found, "samples" not in results


def main(*arguments):
    long, of_cases, every = "--long" in arguments, {}, []
    for path in (argument for argument in arguments if argument != "--long"):
        found, cases = read(path)
        every += [one["word"] for one in found.values()]
        if cases:
            of_cases[Path(path).stem] = found
            continue
        for name, one in found.items():
            means = f"mean {of_mean(one['of'])}, reference {of_mean(one['reference'])}"
            print(f"{name:22}{one['word']} (p {one['p']:.4f}; {means})")
    if len(of_cases) > 1:
        lines = in_a_table(of_cases)
    else:
        lines = [line for found in of_cases.values() for line in in_lines(found, long)]
    for line in lines:
        print(line)
    return 1 if {"differs", "incomplete"} & {*every} else 0


if __name__ == "__main__":
    sys.exit(print(__doc__) if "--help" in sys.argv else main(*sys.argv[1:]) if len(sys.argv) > 1 else __doc__)
