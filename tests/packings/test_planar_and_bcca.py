"""Planar packings, and aggregates by ballistic cluster-cluster aggregation (S17 section 4)."""

from functools import cache

import numpy as np
import pytest
from of_ice import OVERLAP, RADIUS, SPACING
from scipy.spatial import cKDTree
from scipy.stats import kstest

from analysis.measures.fragments import fragment_labels
from analysis.measures.structure import geodesic_radius
from yade_scripts import packings
from yade_scripts.packings import bcca


@pytest.mark.parametrize("filling, relative_radius, grains", [(0.6, 20, 240), (0.9, 25, 562), (0.3, 10, 30)])
def test_planar_cpe_is_a_hexagonal_lattice_in_a_circle(filling, relative_radius, grains):
    packing = packings.cpe(filling, relative_radius * RADIUS, RADIUS, OVERLAP, 3, planar=True)
    assert packing.grains == grains == round(filling * relative_radius**2) and np.all(packing.position[:, 2] == 0)
    assert np.linalg.norm(packing.position, axis=1).max() <= relative_radius * RADIUS * (1 + 1e-12)
    nearest = cKDTree(packing.position).query(packing.position, 2)[0][:, 1]
    assert nearest.min() == pytest.approx(SPACING, rel=1e-9)
    pairs = packings.contacts(packing)
    distance = np.linalg.norm(np.diff(packing.position[pairs], axis=1)[:, 0], axis=1)
    assert np.allclose(distance, SPACING, rtol=1e-9) and np.bincount(pairs.ravel()).max() <= 6


def test_planar_packings_have_the_limit_and_the_coordination_of_the_lattice():
    assert packings.maximum_filling(1.0, 0.0, True) == pytest.approx(np.pi / (2 * np.sqrt(3)))
    message = "filling = 0.95: more than the lattice holds; must be at most 0.916"
    with pytest.raises(packings.PackingError, match=message):
        packings.cpe(0.95, 20 * RADIUS, RADIUS, OVERLAP, 1, planar=True)
    filling = 0.5
    made = [packings.cpe(filling, 60 * RADIUS, RADIUS, OVERLAP, seed, planar=True) for seed in range(8)]
    found = [2 * len(packings.contacts(packing)) / packing.grains for packing in made]
    expected = 6 * filling / packings.maximum_filling(RADIUS, OVERLAP, True)
    assert 0.95 * expected - 4 * np.std(found) / np.sqrt(8) < np.mean(found) < expected


@pytest.mark.parametrize("planar", [False, True])
@pytest.mark.parametrize("grains", [2, 7, 256])
def test_bcca_is_one_cluster_whose_grains_touch_and_never_overlap_more(planar, grains):
    packing = bcca(grains, RADIUS, OVERLAP, 5, planar=planar)
    assert packing.grains == grains and fragment_labels(grains, packings.contacts(packing)).max() == 0
    assert np.allclose(packing.position.mean(axis=0), 0, atol=1e-9 * RADIUS)
    nearest = cKDTree(packing.position).query(packing.position, 2)[0][:, 1]
    assert np.allclose(nearest.min(), SPACING, rtol=1e-9) and np.all(nearest < SPACING * (1 + 1e-9))
    assert len(packings.contacts(packing)) >= grains - 1
    if planar:
        assert np.all(packing.position[:, 2] == 0)


@pytest.mark.parametrize("planar", [False, True])
def test_clusters_meet_anywhere_on_their_cross_section(planar):
    """Two grains, along x: the square of the impact parameter is uniform in space, itself in a plane; of fixed
    seeds."""
    apart = np.array(
        [np.diff(bcca(2, RADIUS, OVERLAP, seed, planar=planar).position, axis=0)[0] for seed in range(500)]
    )
    impact = np.linalg.norm(apart[:, 1:], axis=1) / SPACING
    assert kstest(impact if planar else impact**2, "uniform").pvalue > 1e-3


@cache
def aggregates(planar):
    """Twelve of 64 and twelve of 1024 grains."""
    return [[bcca(grains, RADIUS, OVERLAP, seed, planar=planar) for seed in range(12)] for grains in (64, 1024)]


def exponent(measure, planar=False):
    """(n, standard error) of measure(packing) ~ N^n, by means of its logarithm."""
    small, large = np.log([[measure(packing) for packing in of_size] for of_size in aggregates(planar)])
    error = np.hypot(np.std(small, ddof=1), np.std(large, ddof=1)) / np.sqrt(12)
    return (large.mean() - small.mean()) / np.log(16), error / np.log(16)


@pytest.mark.parametrize("planar, dimension", [(True, 1.5), (False, 1.9)])
def test_bcca_has_the_fractal_dimension_of_cluster_cluster_aggregates(planar, dimension):
    """Gyration radius ~ N^(1/D): D = 1.48 to 1.55 in a plane and 1.8 to 1.95 in space (Meakin 1991); within 4 standard
    errors and 0.15 (small clusters)."""
    slope, error = exponent(packings.gyration_radius, planar)
    assert abs(slope - 1 / dimension) < 4 * error + 0.15 / dimension**2, (1 / slope, error)


def test_ways_along_contacts_of_bcca_are_as_long_as_published():
    """R_geo ~ N^(0.710 +- 0.013) (Arakawa et al. 2019)."""
    slope, error = exponent(lambda packing: geodesic_radius(packing.position, packings.contacts(packing)))
    assert error < 0.02 and abs(slope - 0.710) < 3 * np.hypot(error, 0.013), (slope, error)
