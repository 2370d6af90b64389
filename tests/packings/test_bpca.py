"""Aggregates by ballistic particle-cluster aggregation (A22 section 2.4): geometry, size, isotropy, unlike grains."""

import numpy as np
import pytest
from of_ice import ICE, OVERLAP, RADIUS
from scipy.spatial import cKDTree
from scipy.stats import kstest

from yade_scripts import packings
from yade_scripts.materials import pair_constants
from yade_scripts.packings import aggregate
from yade_scripts.packings.aggregate import AggregateParameters
from yade_scripts.packings.packing import touching_distance
from yade_scripts.parameters import ParameterError

UNLIKE = {
    "two": dict(sizes="two", sizeRatio=2.5, sizeFraction=0.3),
    "lognormal": dict(sizes="lognormal", sizeSpread=0.4),
}


def unlike(name, grains):
    """(parameters, radii (grains,)) of grains of unlike size."""
    parameters = AggregateParameters.parse(dict(UNLIKE[name], packing="bpca", grains=grains))
    return parameters, aggregate.radii(parameters, 0)


def distances_over_rest(packing):
    """(pairs (M, 2), distance over that at rest (M,)) of the pairs nearer than the largest diameter."""
    radius = packing.radius
    pairs = cKDTree(packing.position).query_pairs(2 * radius.max(), output_type="ndarray")
    distance = np.linalg.norm(packing.position[pairs[:, 0]] - packing.position[pairs[:, 1]], axis=1)
    rest = touching_distance(radius[pairs[:, 0]], radius[pairs[:, 1]], RADIUS, OVERLAP)
    return pairs, distance / rest


def require_ballistic(packing):
    """No overlap beyond that of rest, and each grain touches one that came before it."""
    pairs, relative = distances_over_rest(packing)
    assert relative.min() > 1 - 1e-12
    touching = np.sort(pairs[np.abs(relative - 1) < 1e-11], axis=1)
    assert np.array_equal(np.unique(touching[:, 1]), np.arange(1, packing.grains))
    return touching


@pytest.mark.parametrize("grains, seed", [(2, 1), (300, 2), (5000, 3)])
def test_every_grain_rests_against_one_that_came_before(grains, seed):
    packing = packings.bpca(grains, RADIUS, OVERLAP, seed)
    # A grain that touches two at once has probability zero.
    assert len(require_ballistic(packing)) == grains - 1
    assert packing.grains == grains and np.all(packing.radius == RADIUS)
    assert np.abs(packing.position.mean(axis=0)).max() < 1e-12 * packings.extent(packing)


@pytest.mark.parametrize("name", UNLIKE)
@pytest.mark.parametrize("make_one", [packings.bpca, packings.bcca], ids=["bpca", "bcca"])
def test_grains_of_unlike_size(name, make_one):
    grains = 1000
    radii = unlike(name, grains)[1]
    packing = make_one(grains, RADIUS, OVERLAP, 4, radii=radii)
    assert np.array_equal(packing.radius, radii)
    pairs, relative = distances_over_rest(packing)
    assert relative.min() > 1 - 1e-12
    assert np.count_nonzero(np.abs(relative - 1) < 1e-11) == grains - 1
    mass = radii**3
    assert np.abs(mass @ packing.position / mass.sum()).max() < 1e-12 * packings.extent(packing)
    if make_one is packings.bpca:
        require_ballistic(packing)


def test_single_pairs_by_hand():
    """Two grains at +-d/2: r_gyr = d/2; unlike ones with masses m, M at the distance d: r_gyr = d (m M)^(1/2)/(m +
    M)."""
    for first, second in ((1e-7, 1e-7), (1e-7, 3e-7), (0.5e-7, 4e-7)):
        expected = first + second - pair_constants(ICE, (first, second))["equilibriumOverlap"]
        assert touching_distance(first, second, RADIUS, OVERLAP) == pytest.approx(expected, rel=1e-13)
    pair = packings.bpca(2, RADIUS, OVERLAP, 1)
    assert packings.gyration_radius(pair) == pytest.approx((2 * RADIUS - OVERLAP) / 2, rel=1e-12)
    assert packings.characteristic_radius(pair) == pytest.approx((5 / 3) ** 0.5 * (2 * RADIUS - OVERLAP) / 2, rel=1e-12)
    pair = packings.bpca(2, RADIUS, OVERLAP, 1, radii=[RADIUS, 2 * RADIUS])
    distance = touching_distance(RADIUS, 2 * RADIUS, RADIUS, OVERLAP)
    assert packings.gyration_radius(pair) == pytest.approx(distance * 8**0.5 / 9, rel=1e-12)


def test_sizes_of_grains_are_distributed_as_their_parameters_say():
    two = unlike("two", 1000)[1]
    assert np.count_nonzero(two == 2.5 * RADIUS) == 300 and np.count_nonzero(two == RADIUS) == 700
    logarithm = np.log(unlike("lognormal", 20000)[1] / RADIUS)
    assert np.abs(logarithm).max() <= 0.4 * aggregate.WIDEST
    # the standard deviation of a normal distribution cut off at 2.5 of it is 0.9545 of it
    assert logarithm.std() == pytest.approx(0.4 * 0.9545, rel=0.02) and abs(logarithm.mean()) < 4 * 0.4 / 20000**0.5


def test_sizes_of_a_power_law_and_of_a_file(tmp_path):
    """Volumes of a power law against its closed form, and a file's radii in another order, or drawn."""
    radii_of = lambda **given: aggregate.radii(AggregateParameters.parse({"packing": "bpca", **given}), 0)
    power = dict(sizes="powerlaw", smallest=0.5e-7, largest=5e-7, grains=20000)
    for exponent, mean in ((-3.5, 0.80954e-7), (-1.0, 4.5e-7 / np.log(10))):
        found = radii_of(**power, sizeExponent=exponent)
        assert found.min() >= 0.5e-7 and found.max() <= 5e-7
        assert abs(found.mean() - mean) < 4 * found.std() / 20000**0.5
    np.savetxt(tmp_path / "radii.txt", np.linspace(1e-7, 2e-7, 50))
    file = dict(sizes="file", sizesFile=str(tmp_path / "radii.txt"))
    assert np.array_equal(np.sort(radii_of(**file, grains=50)), np.loadtxt(tmp_path / "radii.txt"))
    assert set(radii_of(**file, grains=70)) <= set(np.loadtxt(tmp_path / "radii.txt"))
    (tmp_path / "radii.txt").write_text("0.1\n0.2\n")  # in micrometres
    with pytest.raises(ParameterError, match="sizesFile = .*: not radii of 1e-09 to 0.001 m; must be"):
        radii_of(**file, grains=50)


def test_characteristic_radius_is_that_of_a22():
    """72.29 and 72.25 grain radii for two aggregates of 50,000 grains (A22 section 2.4). One aggregate's scatters by a
    fraction that falls as N^(-1/2): known from many of 2,000."""
    small = [packings.characteristic_radius(packings.bpca(2000, RADIUS, OVERLAP, seed)) for seed in range(16)]
    scatter = np.std(small, ddof=1) / np.mean(small) * (2000 / 50000) ** 0.5
    assert 0.001 < scatter < 0.01
    large = packings.characteristic_radius(packings.bpca(50000, RADIUS, OVERLAP, 1)) / RADIUS
    assert abs(large / 72.27 - 1) < 4 * scatter * (1 + 1 / 2) ** 0.5


def test_isotropy():
    """Directions of first contacts are uniform on the sphere, and so are the aggregates' longest axes: each component
    uniform in [-1, 1] (Archimedes), at 99.9 % confidence together, of fixed seeds."""
    first, longest = [], []
    for seed in range(300):
        position = packings.bpca(60, RADIUS, OVERLAP, seed).position
        first.append((position[1] - position[0]) / np.linalg.norm(position[1] - position[0]))
        axis = np.linalg.eigh(position.T @ position)[1][:, 2]
        longest.append(axis * np.random.default_rng(seed).choice([-1, 1]))
    p_values = [kstest(c, "uniform", args=(-1, 2)).pvalue for axes in (first, longest) for c in np.transpose(axes)]
    assert min(p_values) > 1e-3 / len(p_values)
