# SPDX-License-Identifier: MIT
"""What all adapters share: every scene at every step, measured, into a results file."""

import json
import sys
from pathlib import Path

ROOM = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOM))
from measure import NotModelled, measured

SUITE = json.loads((ROOM / "cases.json").read_text())
MATERIALS = SUITE["materials"]


def answer(case, series_of, levels=3):
    """A case's entry of a results file, with so many of its steps. series_of(scene, materials, steps): a series (measure.py), or
    raises NotModelled."""
    scenes, values = case["scenes"], {question["name"]: [] for question in case["asked"]}
    try:
        for level in range(levels):
            series = {name: series_of(scene, MATERIALS, scene["steps"][level]) for name, scene in scenes.items()}
            for question in case["asked"]:
                values[question["name"]].append(measured(question, series, scenes))
    except NotModelled as reason:
        return {"not modelled": str(reason)}
    first = next(iter(scenes.values()))
    reported = {name: found if None not in found else None for name, found in values.items()}
    return {"steps": [first["duration"] / n for n in first["steps"][:levels]], "values": reported}


def main(code, version, series_of, path, names=()):
    """Writes the results file of a code; names: of cases, or all."""
    chosen = [case for case in SUITE["cases"] if not names or case["id"] in names]
    cases = {case["id"]: answer(case, series_of) for case in chosen}
    lines = ",\n".join(f"{json.dumps(name)}: {json.dumps(found)}" for name, found in cases.items()).replace(
        "NaN", "null"
    )
    head = json.dumps({"code": code, "version": version, "suite": SUITE["version"], "cases": {}})
    Path(path).write_text(f"{head[:-2]}\n{lines}\n}}}}\n")
