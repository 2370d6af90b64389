"""The study of elastoplastic aggregates (Arakawa et al. 2024): made runs whose answers are known, fits against closed forms and scipy's."""

from types import SimpleNamespace

import numpy as np
import pandas
import pytest
from made_collisions import DENSITY, FILLING, MODULI, OFFSET, made_run
from scipy.optimize import least_squares as of_scipy
from written_runs import RADIUS

from analysis.measures.compression import compression_and_velocity
from analysis.runs.table import read_table
from analysis.studies.analyse import analyse
from analysis.studies.curves import power
from analysis.studies.definition import GALLERY
from analysis.studies.elastoplastic import andrews_fit as fits
from analysis.studies.elastoplastic.andrews_fit import VELOCITY, Aggregates, fit_moduli
from analysis.studies.elastoplastic.levenberg import least_squares
from analysis.studies.elastoplastic.measure import zones_that_meet
from analysis.studies.elastoplastic.study import FREE, STUDY, in_grain_radii, once
from analysis.studies.elastoplastic.zones import zone_correlation
from analysis.studies.find import find
from yade_scripts.packings import cpe, moved

TRUTH = Aggregates(MODULI[0], 1.0 / MODULI[1], OFFSET / RADIUS, FILLING * DENSITY, RADIUS)
VELOCITIES = [10 ** (0.1 * i) for i in (1, 3, 5, 7)]


def rows_of(model, scatter, sizes=(40.0, 80.0)):
    """Rows of the study's table whose d_max and t_max are a model's, with a relative scatter whose mean over the pairs is 0."""
    random, found = np.random.default_rng(0), []
    for size in sizes:
        for velocity in VELOCITIES:
            d, t = model.at(size, velocity)
            away = scatter * random.normal(size=(2, 6))
            away -= away.mean(axis=1, keepdims=True)
            values = {"filling": FILLING, "radius": size, "velocity": velocity, "seed": range(6)}
            values |= {"grain_density": DENSITY, "grain_radius": RADIUS}
            found.append(pandas.DataFrame({**values, "d": d + size * away[0], "t_max": t * (1 + away[1])}))
    return pandas.concat(found, ignore_index=True)


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    """Three sizes at A24's velocity, four velocities at R = 80 r, four pairs that scatter by 2 %, but not in the mean; pair 1 sticks. Pairs 1
    and 2 of R = 40 r with drag too, which lets them go 5 and 4 % deeper, and pair 1 for longer."""
    folder = tmp_path_factory.mktemp("runs")
    for size in (40.0, 60.0, 80.0):
        for velocity in VELOCITIES if size == 80.0 else [VELOCITY]:
            for seed, stretch in enumerate((1.02, 0.98, 1.01, 0.99), 1):
                name = f"R{size:g}-v{velocity:.3f}-s{seed}"
                made_run(folder / name, size, velocity, seed, seed == 1, size < 60.0, stretch)
    for seed, stretch in ((1, 1.07), (2, 1.02)):
        made_run(folder / f"drag{seed}", 40.0, VELOCITY, seed, stretch=stretch, viscoelasticTime=3e-12)
    made_run(folder / "longer", 40.0, VELOCITY, 1, sticks=True, stretch=1.02, duration=3e-6)
    found = analyse(find("elastoplastic"), [folder])
    assert len(found.found.table) == 27 and not found.found.notes
    return found.results


def test_the_truth_comes_out_of_made_runs(results):
    """Means without scatter are Andrews's to what sampling takes; moduli of four pairs to five errors."""
    for size, velocity in ((40.0, VELOCITY), (60.0, VELOCITY), (80.0, VELOCITIES[0])):
        d, t = TRUTH.at(size, velocity)
        assert results["d_max"].at(filling=FILLING, radius=size, velocity=velocity).value == pytest.approx(d, rel=2e-3)
        contact = fits.time_of_contact(TRUTH.offset, velocity, RADIUS)
        at = results["t_max"].at(filling=FILLING, radius=size, velocity=velocity)
        assert at.value == pytest.approx(t, rel=5e-3) and at.value > contact and at.error > 0 and at.pairs == 4
    velocities = np.array(VELOCITIES)
    since = TRUTH.at(80.0, velocities)[1] - fits.time_of_contact(TRUTH.offset, velocities, RADIUS)
    found = results["trend"].at(filling=FILLING, radius=80.0, fit="A24's way")
    assert found.value == pytest.approx(power(velocities, since), abs=0.02) and found.pairs == 4
    ratio = (TRUTH.at(80.0, VELOCITY)[0] - TRUTH.at(40.0, VELOCITY)[0]) / 20.0
    line = {n: results["line"].at(filling=FILLING, number=n) for n in ("δ_max/R*", "δ_offset")}
    assert line["δ_max/R*"].value == pytest.approx(ratio, rel=2e-3)
    assert line["δ_offset"].value == pytest.approx(TRUTH.offset, abs=0.01)
    for name, truth in (("stress", TRUTH.stress), ("compliance", TRUTH.compliance), ("offset", TRUTH.offset)):
        fitted = results[name].at(filling=FILLING, fit=FREE)
        assert abs(fitted.value - truth) < 5 * fitted.error
    e = results["andrews"].at(filling=FILLING, velocity=VELOCITY, fit="A24's σ, E*", of="e")
    assert e.value == pytest.approx(0.7676, abs=1e-4)


def test_pairs_count_once_and_changed_ones_apart(results):
    where = {"filling": FILLING, "radius": 40.0, "velocity": VELOCITY}
    assert len(once(in_grain_radii(results.table[results.table.viscoelasticTime == 0]))) == 24
    change = results["d_max_change"].at(**where, changed="drag, T_vis = 3 ps")
    depth = TRUTH.at(40.0, VELOCITY)[0] + 2 * TRUTH.offset
    assert change.value == pytest.approx(0.045 * depth, rel=0.02) and change.pairs == 2
    assert repr(results["sticking"].at(**where, duration=3e-6)) == "1 of 1"
    for name, expected in (("sticking", "0 of 4 (1 undecided)"), ("in_one_piece", "1 of 4")):
        assert repr(results[name].at(filling=FILLING, radius=80.0, velocity=VELOCITY)) == expected


def test_lines_and_exponents_are_closed_forms():
    assert fits.offset_of_line(0.0566, 0.527) == pytest.approx(fits.PRINTED[0.4][2], abs=5e-4)  # A24 eqs 14, 18
    grain = SimpleNamespace(grain_density=1000.0, grain_radius=1e-7)
    for filling, (*_, offset, ratio) in fits.PRINTED.items():
        d, _ = fits.printed(filling, grain).at(60.0, VELOCITY)
        assert d + 2 * offset == pytest.approx(ratio * 0.5 * (60.0 + offset), rel=3e-3)
    rows = rows_of(TRUTH, 0.01)
    rows = rows[rows.velocity == VELOCITY]
    c1, c2, offset, ratio, at_60 = fits.size_line(rows, np.ones((1, len(rows))))[0]
    assert (c1, -c2) == pytest.approx(tuple(np.polyfit(rows.radius, rows.d, 1))) and ratio == 2 * c1
    assert at_60 == pytest.approx(60 * c1 - c2) and offset == pytest.approx(TRUTH.offset, abs=1e-6)
    for compliance, stress, expected in ((0.0, 2e6, 0.0), (5e-8, 1e12, -0.2)):
        velocity = np.array([1.0, 2.0, 4.0])
        _, time = Aggregates(stress, compliance, 0.1, 400.0, RADIUS).at(80.0, velocity)
        assert power(velocity, time - fits.time_of_contact(0.1, velocity, RADIUS)) == pytest.approx(expected, abs=1e-6)


def test_moduli_are_found_up_to_the_rigid_plastic_limit():
    one = np.ones((1, 48))
    for model in (TRUTH, Aggregates(2e6, 0.0, 0.1, 400.0, RADIUS)):
        stress, compliance, offset = fit_moduli(rows_of(model, 1e-5), one)[0]
        assert (stress, offset) == pytest.approx((model.stress, model.offset), rel=2e-3)
        assert compliance == pytest.approx(model.compliance, rel=1e-2, abs=2e-9)
        assert fits.papers_way(rows_of(model, 1e-5), one)[0, 0] == pytest.approx(model.stress, rel=5e-3)
    assert np.isnan(fit_moduli(rows_of(TRUTH, 0.0), one)).all()  # no scatter, no weights
    assert np.isnan(fits.papers_way(rows_of(TRUTH, 0.01, sizes=(40.0,)), one[:, :24])).all()


def test_the_search_agrees_with_scipys():
    """Ten sets of a curve with three parameters at once, one of them held in half of the sets."""
    x, random = np.linspace(0.0, 3.0, 12), np.random.default_rng(5)
    curve = lambda p: p[..., :1] * np.exp(-p[..., 1:2] * x) + p[..., 2:]
    data = curve(np.array([2.0, 1.0, 0.3])) + 0.05 * random.normal(size=(10, 12))
    low, high = np.tile([-9.0, 0.0, -9.0], (10, 1)), np.full((10, 3), 9.0)
    low[::2, 2] = high[::2, 2] = 0.25
    found, chi_square = least_squares(lambda p: curve(p) - data, np.ones((10, 3)), low, high)
    for k in range(10):
        own = (lambda p: curve(np.append(p, 0.25)) - data[k]) if k % 2 == 0 else (lambda p: curve(p) - data[k])
        end = of_scipy(own, np.ones(2 + k % 2), xtol=1e-12)
        assert found[k, : 2 + k % 2] == pytest.approx(end.x, rel=1e-3)
        assert chi_square[k] == pytest.approx(2 * end.cost, rel=1e-5)


def test_correlation_with_the_zones_is_that_about_the_means():
    random = np.random.default_rng(3)
    rows = pandas.DataFrame({"radius": np.repeat([40.0, 80.0], 20), "zone_filling": 1 + 0.03 * random.normal(size=40)})
    rows["d"] = 0.05 * rows.radius - 0.2 * rows.radius * (rows.zone_filling - 1) + 0.1 * random.normal(size=40)
    sizes = rows.assign(x=rows.radius * rows.zone_filling).groupby("radius")[["x", "d"]]
    away = sizes.transform(lambda own: own - own.mean())
    correlation, slope, explained = zone_correlation(rows, np.ones((1, 40)))[0]
    assert correlation == pytest.approx(np.corrcoef(away.x, away.d)[0, 1])
    assert slope == pytest.approx(np.polyfit(away.x, away.d, 1)[0]) and -0.25 < slope < -0.15
    assert 0 < explained < correlation**2


def test_packings_made_again_are_those_of_the_runs():
    """d(0) and the filling of the zones that meet of runs in the gallery, from their seeds."""
    table = read_table(GALLERY / "elastoplastic" / "runs.csv", STUDY.columns)[0]
    for row in table[table.radius < 4.5e-6].drop_duplicates(["filling"]).itertuples():
        reach, found = row.radius + row.grain_radius, []
        for index, side in ((0, -1.0), (1, 1.0)):
            packing = cpe(row.filling, row.radius, row.grain_radius, row.overlap, row.seed, index)
            found.append(moved(packing, (side * reach, 0.0, 0.0)).position)
        position, aggregate = np.concatenate(found), np.repeat([0, 1], [len(own) for own in found])
        offset = compression_and_velocity(position[:, 0], position[:, 0], row.radius)[0] + 2 * row.grain_radius
        assert offset == pytest.approx(row.offset, abs=1e-9 * row.grain_radius)
        assert zones_that_meet(position, aggregate, row.radius, row.grain_radius) == pytest.approx(row.zone_filling)
