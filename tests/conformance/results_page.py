"""Writes results.md, code against case, of results/*.json and differences.json:  python3 results_page.py"""

import json
import math
from pathlib import Path

from check import CASES, verdicts

ROOM = Path(__file__).resolve().parent
CODES = ("engine", "functors", "reference_law", "lammps-newest", "lammps", "liggghts", "stock", "toy")
HEAD = """# {suite}, version {version}: results

Made by `make conformance`; [README.md](README.md) says how.
*Agrees*: every value that a case asks for is within {tolerance:.0e} of the reference when it is extrapolated in the time step with order two.
In brackets stand the largest difference, and the median of the orders with which errors fall (*exact*: the step leaves none).
Bold: the largest difference of a code that differs, relative; why is said below. –: not modelled.
"""


def cell(found):
    if "difference" not in found:
        return "–" if found["said"] == "not modelled" else found["said"]
    size = f"{found['difference']:.0e}" if math.isfinite(found["difference"]) else "does not occur"
    order = "exact" if found["order"] is None else f"order {found['order']:.1f}"
    return f"agrees ({size}, {order})" if found["said"] == "agrees" else f"**{size}**"


def explained(name, found, why):
    """Lines on the cases in which a code differs. `as`: the code that it is like, but for the reasons of its own."""
    own = why.get(name, {})
    lines = ["", f"## Why {name} differs", "", own["in short"], ""] if "in short" in own else []
    for case, one in found.items():
        like = case not in own and case in why.get(own.get("as"), {})
        if one["said"] == "differs" and not like:
            lines.append(f"- **{case}** ({cell(one).strip('*')}, {one['worst']}): {own.get(case, 'not explained')}.")
    missing = [(case, one["why"]) for case, one in found.items() if one["said"] == "not modelled"]
    for reason in dict.fromkeys(reason for _, reason in missing if lines):
        lines.append(f"- Not modelled, {', '.join(case for case, its in missing if its == reason)}: {reason}.")
    return lines


def page():
    """The text of results.md."""
    suite, why = json.loads(CASES.read_text()), json.loads((ROOM / "differences.json").read_text())
    files = {name: ROOM / f"results/{name}.json" for name in CODES}
    of = {name: json.loads(path.read_text()) for name, path in files.items() if path.exists()}
    found = {name: verdicts(results, suite) for name, results in of.items()}
    lines = [HEAD.format(**suite), "| case | " + " | ".join(of) + " |", "|---|" + "---|" * len(of)]
    for case in suite["cases"]:
        lines.append(f"| {case['id']} | " + " | ".join(cell(its[case["id"]]) for its in found.values()) + " |")
    lines += ["", "| column | code |", "|---|---|"]
    lines += [f"| {name} | {results['code']}, {results['version']} |" for name, results in of.items()]
    lines += ["", "## The cases", "", *(f"- **{case['id']}**: {case['title']}." for case in suite["cases"])]
    return "\n".join(lines + [line for name in of for line in explained(name, found[name], why)]) + "\n"


if __name__ == "__main__":
    (ROOM / "results.md").write_text(page())
