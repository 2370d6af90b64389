"""Close-packed and extracted aggregates are what A24 section 3 says, exactly."""

import time
from functools import partial

import numpy as np
import pytest
from of_ice import OVERLAP, RADIUS, SPACING
from refused import refused

from analysis.measures.fragments import fragment_labels
from yade_scripts import packings


def ice(filling=0.4, relative_radius=20, seed=1, index=0):
    return packings.cpe(filling, relative_radius * RADIUS, RADIUS, OVERLAP, seed, index)


bpca, bcca = (partial(make, 400, RADIUS, OVERLAP) for make in (packings.bpca, packings.bcca))


@pytest.mark.parametrize(
    "filling, relative_radius, grains",
    [(0.4, 20, 3200), (0.3, 20, 2400), (0.4, 4, 26), (0.35, 10.3, 382), (0.7, 12, 1210)],
)
def test_number_of_grains_is_filling_times_the_cubed_radius(filling, relative_radius, grains):
    packing = ice(filling, relative_radius)
    assert packing.grains == grains == round(filling * relative_radius**3)
    assert packing.position.shape == (grains, 3) and np.all(packing.radius == RADIUS)


@pytest.mark.parametrize("make", [ice, bpca, bcca])
def test_same_seed_and_index_same_aggregate(make):
    one = make(seed=5, index=0).position
    assert np.array_equal(one, make(seed=5, index=0).position)
    for other in (dict(seed=6, index=0), dict(seed=5, index=1)):
        assert not np.allclose(one[1:], make(**other).position[1:])


def test_streams_are_those_that_a_seed_sequence_spawns():
    for index, spawned in enumerate(np.random.SeedSequence(7).spawn(2)):
        expected = np.random.default_rng(spawned).random(5)
        assert np.array_equal(packings.random_stream(7, index).random(5), expected)


def test_all_centres_lie_in_the_sphere_of_two_hundred_thousand_in_seconds():
    for seed in range(5):
        distance = np.linalg.norm(ice(seed=seed).position, axis=1)
        assert distance.max() <= 20 * RADIUS * (1 + 1e-14)
        assert distance.max() > 19 * RADIUS
    start = time.process_time()
    packing = ice(relative_radius=79.37)
    assert packing.grains == 200000
    assert time.process_time() - start < 10


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
    """12 filling/maximum (A24 eq 39) to 3.9 standard errors of 40 seeds, of grains whose twelve neighbouring sites all lie in the sphere.

    One aggregate's mean scatters by at least sqrt(24 p (1-p)^2/N), p = filling/maximum, for pairs of sites occupied independently.
    """
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


def test_packings_apart_and_overlapping():
    first, second = ice(seed=1, relative_radius=8), ice(seed=1, index=1, relative_radius=8)
    packings.require_apart(first, packings.moved(second, (18 * RADIUS, 0, 0)))
    with pytest.raises(packings.PackingError, match="overlap: [0-9]+ pairs of grains, by .* must be none"):
        packings.require_apart(first, packings.moved(second, (12 * RADIUS, 0, 0)))


def test_filling_above_what_the_lattice_or_this_sphere_holds():
    with refused(packings.PackingError, "filling = 0.76: ", "at most 0.7519 (A24"):
        ice(filling=0.76)
    with refused(packings.PackingError, "asks for 48 grains, but the lattice has"):
        [ice(filling=0.75, relative_radius=4, seed=seed) for seed in range(20)]  # some are too small for it


def test_the_largest_piece_is_what_hangs_together():
    packing = ice(filling=0.3)
    piece = packings.largest_piece(packing)
    assert 0 < piece.parameters["dropped"] == packing.grains - piece.grains < 0.02 * packing.grains
    rows = {tuple(position) for position in packing.position}
    assert all(tuple(position) in rows for position in piece.position)
    assert fragment_labels(piece.grains, packings.contacts(piece)).max() == 0
    assert packings.largest_piece(piece).grains == piece.grains
