# SPDX-License-Identifier: MIT
"""Writes cases.json: every scene, and what it must give, by mpmath.

/usr/bin/python3 tests/conformance/generator/generate.py [CASE ...]      of some cases: printed
"""

import json
import re
import sys
from pathlib import Path

import bond_cases as bond
import normal_cases as normal
import tangential_cases as tangential
from law import MATERIALS

FILE = Path(__file__).resolve().parents[1] / "cases.json"
HEAD = dict(suite="JKR-Wada conformance: two grains", version="1.1.0", licence="CC0-1.0", units="SI")
HEAD.update(tolerance=1e-6, order=2)
CASES = [
    *(normal.equilibrium, normal.hysteresis, normal.collision, normal.sticking, normal.oscillation),
    *(normal.linear_drag, normal.viscous_drag),
    *(tangential.sliding, tangential.rolling, tangential.twisting, tangential.two_at_once, tangential.under_load),
    *(tangential.turning_slip, tangential.unlike_radii, tangential.unlike_materials),
    *(bond.bond_tension, bond.bond_shear, bond.bond_bending, bond.bond_torsion, bond.bond_break),
    *(normal.plane, tangential.free_rotation),
]


def cases(names=()):
    """Those of these names, or all, as they stand in the file."""
    return [made() for made in CASES if not names or made.__name__.replace("_", "-") in names]


if __name__ == "__main__":
    if sys.argv[1:]:
        print(json.dumps(cases(sys.argv[1:])))
    else:
        text = json.dumps({**HEAD, "materials": MATERIALS, "cases": cases()}, indent=1)
        vectors_in_a_line = re.sub(r"\[\s+([-+\d.e,\s]+?)\s+\]", lambda m: "[" + " ".join(m[1].split()) + "]", text)
        FILE.write_text(vectors_in_a_line + "\n")
