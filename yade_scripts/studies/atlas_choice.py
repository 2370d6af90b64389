"""Which collisions the atlas holds from row CHOSEN_FROM on: for each row that of CANDIDATES, drawn at random, of which a model of the runs so far is the least sure.

The choices stand in atlas-chosen.txt, a digit a row, so that the table follows from the repository. Rows that are held out take their first candidate,
and so stay a sample of the whole space."""

import os

import numpy as np
import pandas

from analysis.atlas.columns import breaking_velocity
from analysis.atlas.model import Model
from analysis.atlas.variables import touching
from analysis.runs.write import write_text
from analysis.theory import MATERIALS

CANDIDATES = 8
FILE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "atlas-chosen.txt")
WIDTH = 100  # digits a line


def chosen():
    """Indices (rows,) of the candidates of the rows from CHOSEN_FROM on."""
    with open(FILE) as file:
        return [int(digit) for digit in file.read() if not digit.isspace()]


def append(digits):
    """Add the choices of the next rows to FILE."""
    text = "".join(map(str, [*chosen(), *digits]))
    write_text(FILE, "".join(text[i : i + WIDTH] + "\n" for i in range(0, len(text), WIDTH)))


def least_sure(scenes, table, radius):
    """Indices (rows,) of that of each row's scenes (rows, CANDIDATES) for which the squared error of the probabilities, summed over the outcomes, is largest.

    table: DataFrame of the runs so far; radius: of the grains [m]."""
    filling = {name: _filling(runs) for name, runs in touching(table).groupby("structure")}
    points = [_point(scene, filling[scene.structure], radius) for of_row in scenes for scene in of_row]
    _, error = Model(table).probabilities(pandas.DataFrame(points))
    return (error**2).sum(axis=1).reshape(len(scenes), -1).argmax(axis=1)


def _filling(runs):
    """Coefficients of a power law of a structure's filling in its grains: what ballistic aggregates have before they are made."""
    return np.polyfit(np.log(runs.grains_target), np.log(runs.filling_target), 1)


def _point(scene, filling, radius):
    """The scene as a row of analysis.atlas.variables."""
    large, small = scene.grains
    return {
        "velocity": scene.velocity / breaking_velocity(MATERIALS[scene.material], radius),
        "grains": large,
        "mass_ratio": small / large,
        "filling": scene.filling or np.exp(np.polyval(filling, np.log(large))),
        "impact_square": scene.impact**2,
    }
