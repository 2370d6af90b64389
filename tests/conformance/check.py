# SPDX-License-Identifier: MIT
"""Compares a code's results with cases.json:  python3 check.py RESULTS.json [--long]

Python alone, no packages. Ends with status 1 where a case differs or is incomplete. README.md describes both files.
"""

import json
import math
import sys
from pathlib import Path

CASES = Path(__file__).with_name("cases.json")
ROUNDING = 1e-9  # below it an error has no order


def refuse(what, must):
    sys.exit(f"check.py: {what}: must be {must}")


def require(results, suite):
    """Ends with a line where results can't be compared with a suite."""
    if results.get("suite") != suite["version"]:
        refuse(f"results are of version {results.get('suite')} of the suite", suite["version"])
    asked = {case["id"]: [question["name"] for question in case["asked"]] for case in suite["cases"]}
    for case, answer in results["cases"].items():
        if case not in asked:
            refuse(case, f"one of {', '.join(asked)}")
        if "not modelled" in answer:
            continue
        steps = answer["steps"]
        if len(steps) < 2 or not all(a > b for a, b in zip([math.inf, *steps], [*steps, 0])):
            refuse(f"{case}: steps {steps}", "two or more, the longest first")
        for question, values in answer["values"].items():
            if question not in asked[case]:
                refuse(f"{case}: {question}", f"one of {', '.join(asked[case])}")
            if values is not None and len(values) != len(steps):
                refuse(f"{case}: {question}: {len(values)} values", f"{len(steps)}, one a step")


def checked(question, steps, values, suite):
    """{difference (relative), order (None: not seen), said} of a question's values at some steps, the longest first."""
    if values is None:
        return dict(difference=None, order=None, said="not answered")
    exact = float(question["value"])
    scale = question.get("scale", abs(exact))
    errors = [math.nan if v is None else (v - exact) / scale for v in values]
    if not all(map(math.isfinite, errors)):
        return dict(difference=math.inf, order=None, said="does not occur")
    falls = (steps[-2] / steps[-1]) ** question.get("order", suite["order"])
    limit = errors[-1] + (errors[-1] - errors[-2]) / (falls - 1)
    order = None
    if min(abs(errors[0]), abs(errors[-1])) > ROUNDING:
        order = math.log(abs(errors[0] / errors[-1])) / math.log(steps[0] / steps[-1])
    return dict(difference=abs(limit), order=order, said="agrees" if abs(limit) <= suite["tolerance"] else "differs")


def verdict(case, answer, suite):
    """{said, difference, order, worst} of a case: of its worst question; answered: how many of how many; questions: all of them.
    It agrees only where all is answered but what codes without a ledger can't."""
    if answer is None:
        return dict(said="not run")
    if "not modelled" in answer:
        return dict(said="not modelled", why=answer["not modelled"])
    found = {q["name"]: checked(q, answer["steps"], answer["values"].get(q["name"]), suite) for q in case["asked"]}
    known = {name: one for name, one in found.items() if one["difference"] is not None}
    if not known:
        return dict(said="incomplete", why="nothing is answered")
    missing = any(q["measure"]["kind"] != "channel" for q in case["asked"] if q["name"] not in known)
    wrong = any(one["said"] != "agrees" for one in known.values())
    said = "differs" if wrong else "incomplete" if missing else "agrees"
    worst = max(known, key=lambda name: known[name]["difference"])
    orders = sorted(one["order"] for one in known.values() if one["order"] is not None)
    order = orders[len(orders) // 2] if orders else None
    of_worst = dict(difference=known[worst]["difference"], order=order, worst=worst)
    return dict(said=said, answered=(len(known), len(found)), questions=found, **of_worst)


def verdicts(results, cases=None):
    cases = cases or json.loads(CASES.read_text())
    require(results, cases)
    return {c["id"]: verdict(c, results["cases"].get(c["id"]), cases) for c in cases["cases"]}


def in_words(found):
    if "difference" not in found:
        return found["said"] + (f": {found['why']}" if "why" in found else "")
    order = "" if found["order"] is None else f", order {found['order']:.1f}"
    by = "something does not occur" if math.isinf(found["difference"]) else f"{found['difference']:.1e}"
    some = "" if found["answered"][0] == found["answered"][1] else "{} of {} answered; ".format(*found["answered"])
    return f"{found['said']} ({some}{by}{order}; worst: {found['worst']})"


def main(path, *options):
    try:
        results = json.loads(Path(path).read_text())
        found = verdicts(results)
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        sys.exit(f"check.py: {path}: {error!r}: must be a results file (README.md)")
    for name, one in found.items():
        print(f"{name:18}{in_words(one)}")
        if "--long" in options:
            for question, its in one.get("questions", {}).items():
                size = "" if its["difference"] is None else f" {its['difference']:.1e}"
                order = "" if its["order"] is None else f", order {its['order']:.2f}"
                print(f"    {its['said']:16}{question}{size}{order}")
    if all(one["said"] == "not run" for one in found.values()):
        sys.exit(f"check.py: {path}: no case of these; must have one or more")
    return 1 if any(one["said"] in ("differs", "incomplete") for one in found.values()) else 0


if __name__ == "__main__":
    sys.exit(print(__doc__) if "--help" in sys.argv else main(*sys.argv[1:]) if len(sys.argv) > 1 else __doc__)
