"""Speed of the fused engine beside the functors and YADE's stock loop, measured in one run; part of make bench.

Writes results/speed.json and results/speed.md with commit and machine. Every number of a round is measured before the next round starts, so that
ratios are taken within a round; the table has their medians and ranges.
"""
import json
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

from measured_on import HERE, RESULTS, machine

SECONDS = {"fused1": 3, "fused2": 3, "functors": 6, "stock": 6}
ROUNDS = 3
RADII = (20, 40, 80)
SLOW_MOVERS_UP_TO = 40  # grain radii; beyond, the functors' and YADE's loop take minutes to start and change little


def measure(mover, radius):
    """Contact updates a second of one mover (speed_case.py), in a YADE of its own."""
    with tempfile.TemporaryDirectory() as folder:
        answer = Path(folder) / "answer.json"
        command = ["yade", "-n", "-x", "-j1", str(HERE / "speed_case.py"), mover, str(radius), str(SECONDS[mover]), str(answer)]
        done = subprocess.run(command, capture_output=True, text=True)
        if not answer.exists():
            raise RuntimeError(f"{mover} at radius {radius} failed:\n{done.stdout[-2000:]}\n{done.stderr[-2000:]}")
        return json.loads(answer.read_text())


def run_rounds():
    """{radius: {mover: [result of each round]}}"""
    results = {radius: {} for radius in RADII}
    for turn in range(ROUNDS):
        for radius in RADII:
            for mover in SECONDS:
                if radius > SLOW_MOVERS_UP_TO and not mover.startswith("fused"):
                    continue
                result = measure(mover, radius)
                results[radius].setdefault(mover, []).append(result)
                print(f"round {turn + 1}/{ROUNDS}  R = {radius}  {mover:9s} {result['rate'] / 1e6:7.2f} million contact updates/s  ({result['contacts']} contacts)", flush=True)
    return results


def ratio(results, mover, to):
    """'median (least - most)' of the rounds' ratios."""
    ratios = [a["rate"] / b["rate"] for a, b in zip(results[mover], results[to])]
    return f"{statistics.median(ratios):.1f} ({min(ratios):.1f} - {max(ratios):.1f})"


def table(results, about):
    lines = [f"Million contact updates a second; {about['cpu']}, {about['cores']} cores, commit {about['commit']}. Best of {ROUNDS} rounds; ratios: median (range) of the rounds.", "",
             "| R_agg | contacts | fused, 1 thread | 2 threads | functors | YADE's stock cohesive loop | fused 1 / stock | fused 1 / functors | fused 2 / fused 1 |", "|---:|---:|---:|---:|---:|---:|---:|---:|---:|"]
    for radius, movers in results.items():
        best = {mover: f"{max(r['rate'] for r in rounds) / 1e6:.2f}" for mover, rounds in movers.items()}
        lines.append(f"| {radius} | {movers['fused1'][0]['contacts']} | {best['fused1']} | {best['fused2']} | {best.get('functors', '-')} | {best.get('stock', '-')} | "
                     + " | ".join(ratio(movers, a, b) if a in movers and b in movers else "-" for a, b in (("fused1", "stock"), ("fused1", "functors"), ("fused2", "fused1"))) + " |")
    return "\n".join(lines) + "\n"


def main():
    RESULTS.mkdir(exist_ok=True)
    about, results = machine(), run_rounds()
    text = table(results, about)
    (RESULTS / "speed.json").write_text(json.dumps({"machine": about, "results": results}, indent=1))
    (RESULTS / "speed.md").write_text(text)
    print(text)


if __name__ == "__main__":
    sys.exit(main())
