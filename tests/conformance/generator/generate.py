# SPDX-License-Identifier: MIT
"""Writes cases.json: every scene, and what it must give, by mpmath.

/usr/bin/python3 tests/conformance/generator/generate.py
"""

import json
import re
import sys
from pathlib import Path

from bond_cases import bond_bending, bond_break, bond_shear, bond_tension, bond_torsion
from law import MATERIALS
from normal_cases import collision, equilibrium, hysteresis, linear_drag, oscillation, plane, sticking, viscous_drag
from tangential_cases import (
    free_rotation,
    rolling,
    sliding,
    turning_slip,
    twisting,
    two_at_once,
    under_load,
    unlike_materials,
    unlike_radii,
)

FILE = Path(__file__).resolve().parents[1] / "cases.json"
HEAD = dict(
    suite="JKR-Wada conformance: two grains", version="1.1.0", licence="CC0-1.0", units="SI", tolerance=1e-6, order=2
)
MAKERS = (
    *(equilibrium, hysteresis, collision, sticking, oscillation, linear_drag, viscous_drag),
    *(sliding, rolling, twisting, two_at_once, under_load, turning_slip, unlike_radii, unlike_materials),
    *(bond_tension, bond_shear, bond_bending, bond_torsion, bond_break, plane, free_rotation),
)


def cases(names=()):
    """Those of these names, or all, as they stand in the file."""
    made = (maker() for maker in MAKERS if not names or maker.__name__.replace("_", "-") in names)
    return list(made)


if sys.argv[1:]:
    print(json.dumps(cases(sys.argv[1:])))
else:
    text = json.dumps({**HEAD, "materials": MATERIALS, "cases": cases()}, indent=1)
    vectors_in_a_line = re.sub(r"\[\s+([-+\d.e,\s]+?)\s+\]", lambda m: "[" + " ".join(m[1].split()) + "]", text)
    FILE.write_text(vectors_in_a_line + "\n")
