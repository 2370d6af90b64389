# SPDX-License-Identifier: MIT
"""Writes cases.json: every scene, and what it must give, by mpmath.

/usr/bin/python3 tests/conformance/generator/generate.py [CASE ...]      of some cases: printed
"""

import json
import re
import sys
from pathlib import Path

import bond_cases
import normal_cases
import tangential_cases
from law import MATERIALS

FILE = Path(__file__).resolve().parents[1] / "cases.json"
HEAD = dict(suite="JKR-Wada conformance: two grains", version="1.1.0", licence="CC0-1.0", units="SI")
HEAD.update(tolerance=1e-6, order=2)
CASES = {
    normal_cases: "equilibrium hysteresis collision sticking oscillation linear-drag viscous-drag",
    tangential_cases: "sliding rolling twisting two-at-once under-load turning-slip unlike-radii unlike-materials",
    bond_cases: "bond-tension bond-shear bond-bending bond-torsion bond-break",
}
LAST = ((normal_cases, "plane"), (tangential_cases, "free-rotation"))


def cases(names=()):
    """Those of these names, or all, as they stand in the file."""
    every = [(module, name) for module, words in CASES.items() for name in words.split()] + list(LAST)
    return [getattr(module, name.replace("-", "_"))() for module, name in every if not names or name in names]


if __name__ == "__main__":
    if sys.argv[1:]:
        print(json.dumps(cases(sys.argv[1:])))
    else:
        text = json.dumps({**HEAD, "materials": MATERIALS, "cases": cases()}, indent=1)
        vectors_in_a_line = re.sub(r"\[\s+([-+\d.e,\s]+?)\s+\]", lambda m: "[" + " ".join(m[1].split()) + "]", text)
        FILE.write_text(vectors_in_a_line + "\n")
