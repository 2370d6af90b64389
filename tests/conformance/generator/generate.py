# SPDX-License-Identifier: MIT
"""Writes cases.json, every scene and what it must give, by mpmath: /usr/bin/python3 generator/generate.py"""

import json
import re
from pathlib import Path

import bond_cases as bond
import normal_cases as normal
import tangential_cases as tangential
from law import MATERIALS

FILE = Path(__file__).resolve().parents[1] / "cases.json"
HEAD = dict(suite="JKR-Wada conformance", version="1.2.0", licence="CC0-1.0", units="SI")
HEAD.update(tolerance=1e-6, order=2)
CASES = [
    *(normal.equilibrium, normal.hysteresis, normal.collision, normal.sticking, normal.oscillation),
    *(normal.linear_drag, normal.viscous_drag),
    *(tangential.sliding, tangential.rolling, tangential.twisting, tangential.two_at_once, tangential.under_load),
    *(tangential.turning_slip, tangential.unlike_radii, tangential.unlike_materials),
    *(bond.bond_tension, bond.bond_shear, bond.bond_bending, bond.bond_torsion, bond.bond_break),
    *(normal.plane, tangential.free_rotation, tangential.chain),
]


def suite():
    """cases.json as a dictionary."""
    return {**HEAD, "materials": MATERIALS, "cases": [made() for made in CASES]}


if __name__ == "__main__":
    text = json.dumps(suite(), indent=1)
    vectors_in_a_line = re.sub(r"\[\s+([-+\d.e,\s]+?)\s+\]", lambda m: "[" + " ".join(m[1].split()) + "]", text)
    FILE.write_text(vectors_in_a_line + "\n")
