"""N(< r) of lattices and fractals that are known, loops of contacts, how many axes a periodic network
reaches across, and how many grains are where aggregates meet."""

import numpy as np
import pandas
import pytest
from written_runs import cubic_lattice

from analysis.arrays import numbers, pairs
from analysis.measures.conduction import conductivity
from analysis.measures.network import loops, spanned_axes
from analysis.measures.structure import fractal_dimension, grains_within, zone_filling

# Sites within sqrt(0), sqrt(1), sqrt(2), ... of a simple cubic lattice.
SHELLS = {0.5: 1, 1.2: 7, 1.5: 19, 1.8: 27, 2.1: 33, 2.3: 57, 2.5: 81, 2.9: 93}


def test_simple_cubic_lattice_with_images():
    """The same for any cell, also where the distance reaches over several images, and wherever the positions are."""
    for cells in (1, 2, 3, 5):
        lattice, _ = cubic_lattice(cells)
        moved = lattice + [7.25, -3.0, 0.1] + float(cells) * np.arange(cells**3)[:, None]
        for position in (lattice, moved):
            assert grains_within(position, list(SHELLS), 3 * [float(cells)]).tolist() == list(SHELLS.values())


def test_open_space_few_origins_and_the_dimensions_of_plane_and_space():
    line = np.arange(101.0)[:, None] * [1, 0, 0]
    counts = grains_within(line, [2.5])
    assert counts[0] == pytest.approx((97 * 5 + 2 * 4 + 2 * 3) / 101)
    assert grains_within(line, [2.5], origins=11)[0] == pytest.approx((9 * 5 + 2 * 3) / 11)
    plane = np.stack(np.meshgrid(np.arange(60), np.arange(60), [0]), axis=-1).reshape(-1, 3).astype(float)
    distance = np.array([10.5, 25.5])
    assert fractal_dimension(distance, grains_within(plane, distance, [60, 60, 1e3]))[0] == pytest.approx(2, abs=0.05)
    space = grains_within(cubic_lattice(30)[0], distance, 3 * [30.0], origins=5)
    assert fractal_dimension(distance, space)[0] == pytest.approx(3, abs=0.05)


def test_loops_of_a_lattice_and_what_hangs_on_it():
    """Two triangles with a common side, a square apart from them, and chains between and beside."""
    pairs = [[0, 1], [1, 2], [2, 0], [1, 3], [2, 3], [3, 4], [4, 5], [5, 6], [6, 7], [7, 8], [8, 5], [8, 9], [10, 11]]
    assert loops(12, pairs) == (3, 8)
    assert loops(12, pairs[5:6]) == (0, 0) and loops(3, []) == (0, 0)


def test_lattices_connected_along_some_axes_and_a_diagonal_chain():
    """Wherever the grains are: the same network. The chain crosses all three boundaries, and bears a load along its own
    direction alone."""
    cell = np.full(3, 4.0)
    for axes in ((), (0,), (1, 2), (0, 1, 2)):
        position, pairs = cubic_lattice(4, axes)
        image = np.random.default_rng(1).integers(-2, 3, position.shape)
        assert spanned_axes(position, pairs, cell) == len(axes)
        assert spanned_axes(position + image * cell, pairs[:, ::-1], cell) == len(axes)
    assert spanned_axes(np.arange(4)[:, None] * np.ones(3), [(k, (k + 1) % 4) for k in range(4)], cell) == 1


def test_pieces_are_not_added_up_and_a_free_cluster_spans_nothing():
    """Two chains that cross without touching, along x and along y: no piece spans two directions."""
    along = np.arange(4.0)
    x = np.stack([along, np.zeros(4), np.zeros(4)], axis=1)
    y = np.stack([np.full(4, 2.0), along, np.full(4, 2.0)], axis=1)
    ring = np.array([(k, (k + 1) % 4) for k in range(4)])
    both = np.concatenate([ring, ring + 4])
    assert spanned_axes(np.concatenate([x, y]), both, np.full(3, 4.0)) == 1
    # One contact between them makes a network of two directions.
    assert spanned_axes(np.concatenate([x, y]), np.concatenate([both, [(2, 4)]]), np.full(3, 4.0)) == 2
    assert spanned_axes(np.eye(3), [(0, 1), (1, 2), (2, 0)], np.full(3, 9.0)) == 0


def test_filling_of_the_zone_that_is_hit_is_one_in_the_mean_and_zero_with_a_hole():
    """40 random packings of 1,000 points in a sphere: 1 to four standard errors of their mean."""
    random, found = np.random.default_rng(2), []
    for _ in range(40):
        x = random.normal(size=(1000, 3))
        x *= (random.uniform(size=1000) ** (1 / 3) / np.linalg.norm(x, axis=1))[:, None] * 5.0
        found.append(zone_filling(x + [3.0, 0, 0], [3.0, 0, 0], 5.0, -1.0))
    assert np.mean(found) == pytest.approx(1.0, abs=4 * np.std(found) / 40**0.5)
    hole = x[~((x[:, 0] < -3.75) & (np.hypot(x[:, 1], x[:, 2]) < 1.25))]
    left, right = (zone_filling(hole, np.zeros(3), 5.0, side) for side in (-1.0, 1.0))
    assert left == 0.0 < right


def test_arrays_of_numbers_and_pairs_are_converted_or_refused_by_name():
    wrong = [None, "x", True, 1j, [None], [[1], [2, 3]], {}, pandas.NA, [1.0, np.nan], [np.inf, 1], [-1.0]]
    for value in (*wrong, np.zeros((2, 2)), np.ma.masked_array([1.0, 2.0], [0, 1]), [1.0, np.ma.masked]):
        with pytest.raises(ValueError, match="^radius: [^\n]*$"):
            numbers("radius", value, (None,), positive=True)
    assert numbers("x", [1, 2], (2,)).dtype == float and numbers("n", [1.0, 2.0], whole=True).dtype == np.intp
    assert np.isnan(numbers("d", [1.0, np.nan], gaps=True)[1]) and numbers("p", [], (None, 3)).shape == (0, 3)
    assert pairs("contact_pairs", [], 5).shape == (0, 2) and pairs("contact_pairs", [[0, 4]], 5).tolist() == [[0, 4]]
    for wrong in ([[0, 5]], [[-1, 0]], [[0.5, 1]], [[0, 1, 2]]):
        with pytest.raises(ValueError, match="^contact_pairs: "):
            pairs("contact_pairs", wrong, 5)


# ---- conduction of heat ----


def test_a_chain_of_unequal_contacts_conducts_as_resistors_in_series():
    """And no heat crosses where nothing leads through the cell; grains beside the way change nothing."""
    chain = np.array([[0.0, 0, 0], [1.9, 0.3, 0], [4.0, 0, 0.2], [1.9, 2.2, 0]])
    radii = np.array([0.1, 0.3, 0.2, 0.4])
    found = conductivity(chain, [[0, 1], [1, 2], [2, 0], [1, 3]], radii, [6.0, 5.0, 8.0])
    through = 1 / np.sum(1 / (2 * radii[:3]))
    assert found == pytest.approx([through * 6.0 / 40.0, 0, 0], rel=1e-12, abs=1e-15)


def test_a_cubic_lattice_conducts_as_its_closed_form_and_not_without_a_layer():
    """k = H/d along each axis, also with grains moved off their sites, which changes no contact."""
    side, d = 4, 2.0
    number = np.arange(side**3).reshape(3 * (side,))
    pairs = np.concatenate([np.stack([number, np.roll(number, -1, axis)], -1).reshape(-1, 2) for axis in range(3)])
    position = d * np.stack(np.meshgrid(*3 * [np.arange(side)], indexing="ij"), -1).reshape(-1, 3)
    moved = position + np.random.default_rng(1).normal(size=position.shape) * 0.2
    for place in (position, moved):
        assert conductivity(place, pairs, np.full(len(pairs), 0.1), 3 * [side * d]) == pytest.approx(0.2 / d, rel=1e-12)
    kept = pairs[~((pairs[:, 0] // side**2 == 3) & (pairs[:, 1] // side**2 == 0))]  # without contacts across one plane
    found = conductivity(position, kept, np.full(len(kept), 0.1), 3 * [side * d])
    assert found == pytest.approx([0, 0.2 / d, 0.2 / d], abs=1e-12)
