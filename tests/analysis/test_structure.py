"""N(< r) of lattices and fractals that are known, and loops of contacts."""

import numpy as np
import pytest

from analysis.measures.loops import loops
from analysis.measures.structure import fractal_dimension, grains_within

# Sites within sqrt(0), sqrt(1), sqrt(2), ... of a simple cubic lattice.
SHELLS = {0.5: 1, 1.2: 7, 1.5: 19, 1.8: 27, 2.1: 33, 2.3: 57, 2.5: 81, 2.9: 93}


def lattice(cells):
    return np.stack(np.meshgrid(*3 * [np.arange(cells)]), axis=-1).reshape(-1, 3).astype(float)


def test_simple_cubic_lattice_with_images():
    """The same for any cell, also where the distance reaches over several images, and wherever the positions are."""
    for cells in (1, 2, 3, 5):
        moved = lattice(cells) + [7.25, -3.0, 0.1] + float(cells) * np.arange(cells**3)[:, None]
        for position in (lattice(cells), moved):
            assert grains_within(position, list(SHELLS), 3 * [float(cells)]).tolist() == list(SHELLS.values())


def test_open_space_few_origins_and_the_dimensions_of_plane_and_space():
    line = np.arange(101.0)[:, None] * [1, 0, 0]
    counts = grains_within(line, [2.5])
    assert counts[0] == pytest.approx((97 * 5 + 2 * 4 + 2 * 3) / 101)
    assert grains_within(line, [2.5], origins=11)[0] == pytest.approx((9 * 5 + 2 * 3) / 11)
    plane = np.stack(np.meshgrid(np.arange(60), np.arange(60), [0]), axis=-1).reshape(-1, 3).astype(float)
    distance = np.array([10.5, 25.5])
    assert fractal_dimension(distance, grains_within(plane, distance, [60, 60, 1e3]))[0] == pytest.approx(2, abs=0.05)
    space = grains_within(lattice(30), distance, 3 * [30.0], origins=5)
    assert fractal_dimension(distance, space)[0] == pytest.approx(3, abs=0.05)


def test_loops_of_a_lattice_and_what_hangs_on_it():
    """Two triangles with a common side, a square apart from them, and chains between and beside."""
    pairs = [[0, 1], [1, 2], [2, 0], [1, 3], [2, 3], [3, 4], [4, 5], [5, 6], [6, 7], [7, 8], [8, 5], [8, 9], [10, 11]]
    assert loops(12, pairs) == (3, 8)
    assert loops(12, pairs[5:6]) == (0, 0) and loops(3, []) == (0, 0)
