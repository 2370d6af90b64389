"""Close-packed and extracted aggregates are what A24 section 3 says, exactly."""

from functools import partial

import numpy as np
import pytest
from of_ice import OVERLAP, RADIUS, SPACING
from scipy.stats import ks_2samp

from analysis.measures.fragments import fragment_labels
from yade_scripts import packings
from yade_scripts.packings.aggregate import AggregateParameters, make


def ice(filling=0.4, relative_radius=20, seed=1, index=0):
    return packings.cpe(filling, relative_radius * RADIUS, RADIUS, OVERLAP, seed, index)


bpca, bcca = (partial(grown, 400, RADIUS, OVERLAP) for grown in (packings.bpca, packings.bcca))


@pytest.mark.parametrize(
    "filling, relative_radius, grains", [(0.4, 20, 3200), (0.4, 4, 26), (0.35, 10.3, 382), (0.7, 12, 1210)]
)
def test_number_of_grains_is_filling_times_the_cubed_radius(filling, relative_radius, grains):
    packing = ice(filling, relative_radius)
    assert packing.grains == grains == round(filling * relative_radius**3)
    assert packing.position.shape == (grains, 3) and np.all(packing.radius == RADIUS)
    reach = relative_radius * RADIUS
    assert reach - RADIUS < packings.extent(packing) <= reach * (1 + 1e-14)


def of_parameters(seed, index):
    cells = dict(packing="bpca", grains=200, seed=seed, sizes="two", sizeRatio=2, sizeFraction=0.25)
    return make(AggregateParameters.parse(cells), OVERLAP, index)


@pytest.mark.parametrize("make_one", [ice, bpca, bcca, of_parameters])
def test_same_seed_and_index_same_aggregate(make_one):
    one, again = (make_one(seed=5, index=0) for _ in range(2))
    assert np.array_equal(one.position, again.position) and np.array_equal(one.radius, again.radius)
    for other in (dict(seed=6, index=0), dict(seed=5, index=1)):
        assert not np.allclose(one.position[1:], make_one(**other).position[1:])


def test_contacts_are_the_touching_pairs_which_overlap_by_the_equilibrium_overlap():
    packing = ice(relative_radius=40)
    pairs = packings.contacts(packing)
    distance = np.linalg.norm(packing.position[pairs[:, 0]] - packing.position[pairs[:, 1]], axis=1)
    assert np.abs(distance / SPACING - 1).max() < 1e-12
    packing = ice(relative_radius=8)
    distance = np.linalg.norm(packing.position[:, None] - packing.position[None], axis=2)
    first, second = np.nonzero(np.triu(distance <= 2 * RADIUS, 1))
    assert np.array_equal(packings.contacts(packing), np.column_stack([first, second]))


def test_sites_are_those_of_a_face_centred_cubic_lattice():
    """Distances squared, in units of the spacing, are whole; full shells have 12, 6, 24, 12, 24 sites."""
    packing = ice(filling=0.745, relative_radius=12)
    steps = np.linalg.norm(packing.position[:, None] - packing.position[None], axis=2) ** 2 / SPACING**2
    assert np.abs(steps - steps.round()).max() < 1e-10
    inner = np.linalg.norm(packing.position, axis=1) < 12 * RADIUS - np.sqrt(5.1) * SPACING
    shells = [np.count_nonzero(steps[inner].round() == k, axis=1).max() for k in (1, 2, 3, 4, 5)]
    assert shells == [12, 6, 24, 12, 24]


@pytest.mark.parametrize("filling", [0.15, 0.4, 0.6])
def test_mean_coordination_of_inner_grains(filling):
    """12 filling/maximum (A24 eq 39) to 3.9 standard errors of 40 seeds, of grains whose neighbouring sites all lie
    inside.

    One aggregate's mean scatters by at least sqrt(24 p (1-p)^2/N), p = filling/maximum, for sites occupied
    independently."""
    expected = 12 * filling / packings.maximum_filling(RADIUS, OVERLAP)
    means = []
    for seed in range(40):
        packing = ice(filling, 20, seed)
        inner = np.linalg.norm(packing.position, axis=1) <= 20 * RADIUS - SPACING
        neighbours = np.bincount(packings.contacts(packing).ravel(), minlength=packing.grains)
        means.append(neighbours[inner].mean())
    p = expected / 12
    error = np.std(means, ddof=1) / np.sqrt(len(means))
    assert np.std(means, ddof=1) > 0.5 * np.sqrt(24 * p * (1 - p) ** 2 / packing.grains)
    assert error < 0.02
    assert abs(np.mean(means) - expected) < 3.9 * error


def test_the_largest_piece_is_what_hangs_together():
    packing = ice(filling=0.3)
    piece = packings.largest_piece(packing)
    assert 0 < piece.parameters["dropped"] == packing.grains - piece.grains < 0.02 * packing.grains
    rows = {tuple(position) for position in packing.position}
    assert all(tuple(position) in rows for position in piece.position)
    assert fragment_labels(piece.grains, packings.contacts(piece)).max() == 0
    assert packings.largest_piece(piece).grains == piece.grains


# ---- orientation and place of the lattice are uniform: tests at 99.9 % confidence each, of fixed seeds ----


def test_orientation_is_uniform():
    """x^4 + y^4 + z^4 of each axis in the lattice's own frame is distributed as that of random directions.

    That is the lowest function that sees the orientation of a cubic lattice whichever of its 24 equal orientations is
    counted. From the six directions of contacts, u = (1, +/-1, 0)/sqrt 2 and so on: the sum of (u.e)^4 is (3 - that)/2.
    """
    found = 3 - 2 * np.array([(_bond_directions(seed) ** 4).sum(axis=0) for seed in range(1500)])
    random = np.random.default_rng(1).normal(size=(3, 100_000))
    expected = (random**4).sum(axis=0) / (random**2).sum(axis=0) ** 2
    p_values = [ks_2samp(of_axis, expected).pvalue for of_axis in found.T]
    assert min(p_values) > 1e-3 / len(p_values)


def _bond_directions(seed):
    """The six directions (6,3) along which grains touch."""
    packing = ice(0.5, 5, seed)
    pairs = packings.contacts(packing)
    directions = (packing.position[pairs[:, 1]] - packing.position[pairs[:, 0]]) / SPACING
    distinct = []
    for direction in directions:
        if all(abs(direction @ other) < 0.9 for other in distinct):
            distinct.append(direction)
    assert len(distinct) == 6
    return np.array(distinct)
