"""In YADE: scenes that change in mid-run, written as a run folder: own_scenes.py sinter|appended out=FOLDER."""

import os
import sys

import numpy as np
from scenes import *
from yade import utils  # noqa: F401
from yade.wrapper import *  # noqa: F403

import contact_law

what, out = sys.argv[1], sys.argv[2].partition("=")[2]
os.makedirs(f"{out}/states")
new_scene(0.05 * unit, mover="fused", subSteps=2)
converging(27, 1, *KINDS["unlike"], speed=20.0)
rows = []
for k in range(100):
    if k == 40 and what == "sinter":
        contact_law.sinter(0.5)
    if k == 40 and what == "appended":
        for x in (-1.2e-6, 1.2e-6):
            grain((x, 1e-8, 0), 1e-7, ice(), (-x / abs(x) * 20, 0, 0))
    O.step()
    rows.append([energies()[name] for name in CHANNELS])
    if k % 20 == 19:
        state = contact_law.snapshot()
        arrays = {name: state[name] for name in ("position", "velocity", "angular_velocity", "contact_pairs")}
        np.savez(f"{out}/states/{k:06d}.npz", **arrays)
np.savez(f"{out}/history.npz", **dict(zip(CHANNELS, np.array(rows).T)))
sys.exit(0)
