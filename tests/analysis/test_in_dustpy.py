"""The atlas in real DustPy (make test-dustpy), with tables of which the answer is known."""

import warnings
from math import pi

import numpy as np
import pytest

from analysis.atlas.adapters.dustpy import fragments_of, use_atlas
from analysis.atlas.outcome_table import PROBABILITIES, Axis, OutcomeTable
from analysis.atlas.query import outcomes_file
from analysis.atlas.variables import GROWN
from analysis.theory import ICE, interaction_energies, pair_constants

dustpy = pytest.importorskip("dustpy", reason="DustPy is not installed; make test-dustpy has it")
pytestmark = pytest.mark.filterwarnings("ignore:use_atlas")  # the tables made here begin with 60 grains
BREAK = interaction_energies(pair_constants(ICE, 1e-7))["break"]


@pytest.fixture
def sim():
    """Five radial cells of ice grains with a filling of 0.3, masses of two grains to a milligram."""
    sim = dustpy.Simulation(verbosity=0)
    sim.ini.grid.Nr, sim.ini.grid.rmin, sim.ini.grid.rmax = 5, 5 * dustpy.constants.au, 60 * dustpy.constants.au
    sim.ini.grid.mmin, sim.ini.grid.mmax, sim.ini.dust.rhoMonomer = 1e-14, 1e-3, 1.0
    sim.initialize()
    sim.writer = None
    sim.dust.fill[...] = 0.3
    sim.update()
    return sim


def table_of(probabilities, speeds=20, inside=1.0, touching=1.0):
    """OutcomeTable of probabilities(v, n, q, f) of PROBABILITIES; v is over v_break."""
    axes = (
        Axis("velocity", "log10", 0.01 * 1e4 ** np.linspace(0, 1, speeds) ** 1.5),
        Axis("grains", "log10", np.array([60.0, 500.0, 4000.0])),
        Axis("mass_ratio", "log10", np.array([0.02, 0.2, 1.0])),
        Axis("filling", "linear", np.array([0.05, 0.3, 0.5])),
    )
    grid = np.meshgrid(*(axis.nodes for axis in axes), indexing="ij")
    columns = dict(zip(PROBABILITIES, probabilities(*grid)))
    columns |= {"p_touching": touching, "gain_mass_transfer": 0.4, "loss_erosion": 1.0, "largest_fragmentation": 0.3}
    columns |= {"fragment_index": 2.0, "inside": inside}
    values = np.stack(np.broadcast_arrays(*columns.values(), grid[0])[:-1], -1)
    return OutcomeTable(axes, tuple(columns), values)


def smooth(v, n, q, f):
    breaks = v / (v + 10) * (1 - 0.3 * q)
    bounces = (1 - breaks) * f * np.log10(n) / 8
    return 1 - breaks - bounces, bounces, 0.5 * breaks, 0.3 * breaks, 0.2 * breaks


def test_a_threshold_gives_dustpys_own_probabilities(sim):
    """All stick below 1 m/s and break above: what DustPy has by default, but for the distance of the table's speeds."""
    threshold = 1.0 / np.sqrt(BREAK / (4 / 3 * pi * 1e-21 * 1000))
    own = np.array(sim.dust.p.frag), np.array(sim.dust.p.stick)
    use_atlas(sim, table_of(lambda v, *_: (v < threshold, 0, 0, 0, v >= threshold), speeds=1001))
    assert own[0][1:-1].min() < 1e-9 and own[0].max() > 0.5
    np.testing.assert_allclose(sim.dust.p.frag, own[0], atol=0.01)
    np.testing.assert_allclose(sim.dust.p.stick, own[1], atol=0.01)


@pytest.mark.parametrize("filling", ["same", "of each radius"])
def test_probabilities_are_those_of_the_table(sim, filling):
    if filling != "same":
        sim.dust.fill[...] = np.linspace(0.1, 0.4, 5)[:, None]
        sim.update()
    table = table_of(smooth, touching=0.8)
    use_atlas(sim, table, speeds="rms")
    frag, stick = np.asarray(sim.dust.p.frag), np.asarray(sim.dust.p.stick)
    grain = 4 / 3 * pi * 1e-21 * 1000  # kg
    mass = np.asarray(sim.grid.m) * 1e-3
    larger, smaller = np.maximum.outer(mass, mass), np.minimum.outer(mass, mass)
    for r in range(1, 4):
        found = table.lookup(
            velocity=np.asarray(sim.dust.v.rel.tot)[r] / 100 / np.sqrt(BREAK / grain),
            grains=larger / grain,
            mass_ratio=smaller / larger,
            filling=float(np.asarray(sim.dust.fill)[r, 0]),
        )
        transfer = found["p_mass_transfer"]
        np.testing.assert_allclose(stick[r], 0.8 * (found["p_sticking"] + 0.7 * transfer), atol=1e-9)
        np.testing.assert_allclose(1 - stick[r] - frag[r], 0.8 * found["p_bouncing"] + 0.2, atol=1e-9)
    for p in (frag, stick):
        assert not p[[0, -1]].any() and np.array_equal(p, p.swapaxes(1, 2)) and p.min() >= 0
    assert (frag + stick).max() <= 1


@pytest.mark.parametrize("inside", [0.0, 1.0])
def test_outside_of_the_data_dustpy_decides(sim, inside):
    own = np.array(sim.dust.p.frag), np.array(sim.dust.p.stick)
    atlas = use_atlas(sim, table_of(smooth, inside=inside), outside="dustpy", speeds="rms")
    query = atlas._query(sim)
    within = inside * np.all([axis.beyond(query[axis.name]) == 0 for axis in atlas.table.axes], axis=0)
    frag, stick = (np.asarray(p)[1:-1, atlas.smaller, atlas.larger] for p in (sim.dust.p.frag, sim.dust.p.stick))
    for p, theirs in zip((frag, stick), own):
        same = np.isclose(p, theirs[1:-1, atlas.smaller, atlas.larger], atol=1e-12)
        assert same[within == 0].all() and (not inside or not same[within == 1].any())
    report = atlas.report(sim)
    assert report["collisions"] == pytest.approx(1 - np.average(within, weights=atlas.outside(sim)[0]))
    assert report["stick"] + report["frag"] + report["bounce"] == pytest.approx(1)


@pytest.mark.parametrize("atlas", [False, True])
def test_mass_is_conserved(sim, atlas):
    """Where nothing drifts and diffuses, each radial cell keeps its mass, with the atlas as without."""
    if atlas:
        use_atlas(sim, table_of(smooth), fragment_index=True)
    for field in (sim.dust.v.rad, sim.dust.D):
        field[...] = 0.0
        field.updater = None
    before = np.asarray(sim.dust.Sigma)[1:-1].copy()
    sim.t.snapshots = np.array([100.0]) * dustpy.constants.year
    sim.run()
    after = np.asarray(sim.dust.Sigma)[1:-1]
    assert np.abs((after - before) / before.sum(axis=1, keepdims=True)).max() > 1e-3
    np.testing.assert_allclose(after.sum(axis=1), before.sum(axis=1), rtol=1e-10)


def test_fragments_of_dustpys_index_are_dustpys(sim):
    np.testing.assert_allclose(fragments_of(sim.grid.m, 11 / 6), sim.dust.coagulation.phi, rtol=1e-12)


@pytest.mark.parametrize("options", [{}, {"material": "silicate"}, {"grain_radius": 1e-5}])
def test_grains_of_another_size_than_meant_give_a_warning(sim, options):
    """Of 1e-5, 0.1 um in cm, or of silicate by default, all aggregates of the start would be less than one grain."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        use_atlas(sim, outcomes_file(GROWN, averaged=True), **options)
    lines = [str(each.message) for each in caught if "use_atlas" in str(each.message)]
    assert len(lines) == bool(options) and all("of the collisions are at present outside" in line for line in lines)
