"""Writes results.md, code against case, of results/*.json and differences.json:  python3 results_page.py"""

import json
import math
from pathlib import Path

from check import CASES, verdicts

ROOM = Path(__file__).resolve().parent
CODES = ("engine", "functors", "reference_law", "lammps-newest", "lammps", "liggghts", "stock", "toy")


def cell(found):
    if "difference" not in found:
        return "–" if found["said"] == "not modelled" else found["said"]
    size = f"{found['difference']:.0e}" if math.isfinite(found["difference"]) else "all of it"
    order = "exact" if found["order"] is None else f"order {found['order']:.1f}"
    return f"{found['said']} ({size}, {order})" if found["said"] == "agrees" else f"**{size}**"


def page():
    """The text of results.md."""
    cases, why = json.loads(CASES.read_text()), json.loads((ROOM / "differences.json").read_text())
    of = {
        name: json.loads((ROOM / f"results/{name}.json").read_text())
        for name in CODES
        if (ROOM / f"results/{name}.json").exists()
    }
    found = {name: verdicts(results, cases) for name, results in of.items()}
    lines = [
        f"# {cases['suite']}, version {cases['version']}: results",
        "",
        "Made by `make conformance`; [README.md](README.md) says how.",
        f"*agrees*: every value that a case asks for is within {cases['tolerance']:.0e} of the reference when it is extrapolated in the",
        "time step with order two; in brackets the largest difference, and the median of the orders with which errors fall (*exact*: no",
        "error of the step). Bold: the largest difference of a code that differs, relative; why is said below. –: not modelled.",
        "",
        "| case | " + " | ".join(of) + " |",
        "|---|" + "---|" * len(of),
    ]
    for case in cases["cases"]:
        lines.append(f"| {case['id']} | " + " | ".join(cell(found[name][case["id"]]) for name in of) + " |")
    lines += [
        "",
        "| code | version |",
        "|---|---|",
        *(f"| {name} | {r['code']}, {r['version']} |" for name, r in of.items()),
    ]
    lines += ["", "## The cases", "", *(f"- **{case['id']}**: {case['title']}." for case in cases["cases"])]
    for name in of:
        reasons, its = why.get(name, {}), found[name]
        told = [c for c, one in its.items() if one["said"] in ("differs", "not modelled")]
        if told:
            lines += ["", f"## Why {name} differs", "", *([reasons["in short"], ""] if "in short" in reasons else [])]
        for c in told:
            one = its[c]
            size = "not modelled" if "why" in one else f"{one['difference']:.1e}, {one['worst']}"
            lines.append(f"- **{c}** ({size}): {reasons.get(c, one.get('why', 'not explained'))}.")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    (ROOM / "results.md").write_text(page())
