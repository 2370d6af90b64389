"""Writes results.md, code against case, of results/*.json and differences.json:  python3 results_page.py"""

import json
import math
import random
from pathlib import Path
from statistics import mean, stdev

import check_ensembles
from check import CASES, verdicts

ROOM = Path(__file__).resolve().parent
CODES = ("engine", "functors", "reference_law", "lammps-newest", "lammps", "liggghts", "stock", "toy")
HEAD = """# {suite}, version {version}: results

Made by `make conformance`; [README.md](README.md) says how.
*Agrees*: every value that a case asks for is within {tolerance:.0e} of the reference when it is extrapolated in the time step with order two (one where a question says so).
In brackets stand the largest difference, and the median of the orders with which errors fall (*exact*: the step leaves none).
Bold: the largest difference of a code that differs, relative; why is said below. –: not modelled; not tried: the code has an option that was not used.
"""

ENSEMBLES = """
## Aggregates

Distributions of `ensembles.json` beside samples of new aggregates: mean ± standard error (runs), and the probability of a distance as large by chance.
Bold: differs (p below {level:.4f}); otherwise the two are not told apart, which is not agreement: the README says what shifts are found.
In brackets: the mean difference from the engine's run with the same aggregates, and the probability of one as large by chance, by exchanging the two within pairs. Bold: differs; same aggregates tell more than two samples do.
{alike}
"""
ALIKE = "lammps and lammps-newest give the same for {same} of {all} aggregates: in effect one sample."
NOT_TRIED = "not tried: "


def stored(folder):
    """{code: what its file in a folder holds}"""
    files = {name: folder / f"{name}.json" for name in CODES}
    return {name: json.loads(path.read_text()) for name, path in files.items() if path.exists()}


def cell(found):
    if found["said"] not in ("agrees", "differs"):
        not_tried = found.get("why", "").startswith(NOT_TRIED)
        return "not tried" if not_tried else "–" if found["said"] == "not modelled" else found["said"]
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
    lines += [f"- **aggregates**: {own['aggregates']}."] if "aggregates" in own else []
    missing = [(case, one["why"]) for case, one in found.items() if one["said"] == "not modelled"]
    for reason in dict.fromkeys(reason for _, reason in missing if lines):
        said = "Not tried" if reason.startswith(NOT_TRIED) else "Not modelled"
        these = ", ".join(case for case, its in missing if its == reason)
        lines.append(f"- {said}, {these}: {reason.removeprefix(NOT_TRIED)}.")
    return lines


def of_mean(values):
    return f"{mean(values):.3f} ± {stdev(values) / len(values) ** 0.5:.3f}"


def paired_p(differences):
    """Probability that the two values of pairs differ as much in the mean, by exchanging them within pairs."""
    draw, observed = random.Random(1), abs(sum(differences)) * (1 - 1e-12)
    sums = (sum(draw.choice((x, -x)) for x in differences) for _ in range(check_ensembles.SHUFFLES))
    return (sum(abs(one) >= observed for one in sums) + 1) / (check_ensembles.SHUFFLES + 1)


def of_sample(values, own, found, level):
    """A code's cell of a distribution, beside the engine's own values for the same aggregates."""
    if values is None:
        return "–"
    said = f"{of_mean(values)} ({len(values)})"
    said = (f"**{said}**" if found["said"] == "differs" else said) + f", p {found['p']:.2g}"
    if values == own:
        return said
    differences = [one - other for one, other in zip(values, own)]
    p, change = paired_p(differences), of_mean(differences)
    return f"{said} [{f'**{change}**' if p < level else change}, p {p:.2g}]"


def ensembles():
    """Lines of the table of aggregates, distribution against code."""
    suite = json.loads(check_ensembles.ENSEMBLES.read_text())
    samples = {name: results["samples"] for name, results in stored(ROOM / "results/ensembles").items()}
    found = {name: check_ensembles.compared(its, suite) for name, its in samples.items()}
    columns, level = ["distribution", "suite", *samples], suite["level"] / len(suite["distributions"])
    pairs = [pair for name, values in samples["lammps"].items() for pair in zip(values, samples["lammps-newest"][name])]
    alike = ALIKE.format(same=sum(one == other for one, other in pairs), all=len(pairs))
    lines = [ENSEMBLES.format(level=level, alike=alike), row(columns), row(["---"] * len(columns))]
    for given in suite["distributions"]:
        name, own = given["id"], samples["engine"].get(given["id"])
        cells = [of_sample(samples[code].get(name), own, found[code].get(name), level) for code in samples]
        if own:
            lines.append(row([name, f"{of_mean(given['values'])} ({len(given['values'])})", *cells]))
    return lines


def row(cells):
    return "| " + " | ".join(cells) + " |"


def page():
    """The text of results.md."""
    suite, why = json.loads(CASES.read_text()), json.loads((ROOM / "differences.json").read_text())
    of = stored(ROOM / "results")
    found = {name: verdicts(results, suite) for name, results in of.items()}
    lines = [HEAD.format(**suite), row(["case", *of]), "|---|" + "---|" * len(of)]
    for case in suite["cases"]:
        lines.append(row([case["id"], *(cell(its[case["id"]]) for its in found.values())]))
    lines += ["", "| column | code |", "|---|---|"]
    lines += [f"| {name} | {results['code']}, {results['version']} |" for name, results in of.items()]
    lines += ensembles()
    lines += ["", "## The cases", "", *(f"- **{case['id']}**: {case['title']}." for case in suite["cases"])]
    return "\n".join(lines + [line for name in of for line in explained(name, found[name], why)]) + "\n"


if __name__ == "__main__":
    (ROOM / "results.md").write_text(page())
