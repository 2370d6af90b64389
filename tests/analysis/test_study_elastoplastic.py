"""The study of elastoplastic aggregates (Arakawa et al. 2024): made runs whose answers are known, fits against closed
forms."""

import numpy as np
import pandas
import pytest
from made_collisions import DENSITY, FILLING, MODULI, OFFSET, made_run
from written_runs import RADIUS

from analysis.measures.compression import compression_and_velocity
from analysis.runs.folder import open_run
from analysis.runs.table import read_table
from analysis.studies import elastoplastic as a24
from analysis.studies.estimates import beside, estimate, estimates, mean, where
from analysis.studies.study import GALLERY
from yade_scripts.packings import cpe, moved

TRUTH = a24.Aggregates(MODULI[0], 1.0 / MODULI[1], OFFSET / RADIUS, FILLING * DENSITY)
VELOCITIES = [10 ** (0.1 * i) for i in (1, 3, 5, 7)]


def rows_of(model, scatter, sizes=(40.0, 80.0)):
    """Rows whose d_max and t_max are a model's, with a relative scatter whose mean over the pairs is 0."""
    random, found = np.random.default_rng(0), []
    for size in sizes:
        for velocity in VELOCITIES:
            d, t = model.at(size, velocity)
            away = scatter * random.normal(size=(2, 6))
            away -= away.mean(axis=1, keepdims=True)
            values = {"filling": FILLING, "radius": size, "velocity": velocity, "pair": np.arange(6) + size}
            found.append(pandas.DataFrame({**values, "d": d + size * away[0], "t": t * (1 + away[1])}))
    return pandas.concat(found, ignore_index=True)


def test_the_truth_comes_out_of_made_runs(tmp_path):
    """Three sizes at A24's velocity, four velocities at R = 80 r, four pairs that scatter by 2 %, but not in the mean.
    Pairs 1 and 2 of R = 40 r with drag too, which lets them go 5 and 4 % deeper, and pair 1 for longer, which counts
    once."""
    made = []
    for size in (40.0, 60.0, 80.0):
        for velocity in VELOCITIES if size == 80.0 else [a24.VELOCITY]:
            for seed, stretch in enumerate((1.02, 0.98, 1.01, 0.99), 1):
                path = tmp_path / f"R{size:g}-v{velocity:.3f}-s{seed}"
                made.append(made_run(path, size, velocity, seed, seed == 1, size < 60.0, stretch))
    for seed, stretch in ((1, 1.07), (2, 1.02)):
        path = tmp_path / f"drag{seed}"
        made.append(made_run(path, 40.0, a24.VELOCITY, seed, stretch=stretch, viscoelasticTime=3e-12))
    made.append(made_run(tmp_path / "longer", 40.0, a24.VELOCITY, 1, sticks=True, stretch=1.02, duration=3e-6))
    runs = a24.STUDY.runs(pandas.DataFrame([a24.STUDY.measure(open_run(path)) for path in made]))
    plain = a24.once(runs[~runs.changed])
    assert len(runs) == 27 and len(plain) == 24
    for size, velocity in ((40.0, a24.VELOCITY), (60.0, a24.VELOCITY), (80.0, VELOCITIES[0])):
        own = where(plain, radius=size, velocity=velocity)
        d, t = (estimate(mean(column), own) for column in ("d", "t"))
        assert (d.value, t.value) == pytest.approx(TRUTH.at(size, velocity), rel=5e-3) and d.pairs == 4
    *_, offset, slope, _ = estimates(a24.size_line, where(plain, velocity=a24.VELOCITY))
    expected = (TRUTH.at(80.0, a24.VELOCITY)[0] - TRUTH.at(40.0, a24.VELOCITY)[0]) / 20.0
    assert slope.value == pytest.approx(expected, rel=2e-3) and offset.value == pytest.approx(TRUTH.offset, abs=0.01)
    stress, soft = estimates(lambda r: a24.moduli(a24.papers_way(r)), plain)
    assert abs(stress.value - TRUTH.stress) < 5 * stress.error and abs(soft.value - TRUTH.compliance) < 5 * soft.error
    forty = where(plain, radius=40.0)
    change = beside(mean("d"), a24.once(where(runs, viscoelasticTime=3e-12)), forty)
    assert change.value == pytest.approx(0.045 * (TRUTH.at(40.0, a24.VELOCITY)[0] + 2 * TRUTH.offset), rel=0.02)
    assert change.pairs == 2


def test_lines_and_exponents_are_closed_forms():
    for filling, (*_, offset, ratio) in a24.PRINTED.items():
        d, _ = a24.printed(filling).at(60.0, a24.VELOCITY)
        assert d + 2 * offset == pytest.approx(ratio * 0.5 * (60.0 + offset), rel=3e-3)
    assert a24.printed(0.4).returned(a24.VELOCITY) == pytest.approx(0.7676**2, abs=1e-4)
    rows = where(rows_of(TRUTH, 0.01), velocity=VELOCITIES[2])
    c1, c2, offset, ratio, at_60 = a24.size_line(rows)
    assert (c1, -c2) == pytest.approx(tuple(np.polyfit(rows.radius, rows.d, 1))) and ratio == 2 * c1
    assert at_60 == pytest.approx(60 * c1 - c2) and offset == pytest.approx(TRUTH.offset, abs=1e-6)
    # A24 eqs 14, 18, with their numbers
    line = pandas.DataFrame({"radius": [40.0, 80.0], "d": [0.0566 * 40 - 0.527, 0.0566 * 80 - 0.527]})
    assert a24.size_line(line)[2] == pytest.approx(a24.PRINTED[0.4][2], abs=5e-4)
    for compliance, stress, expected in ((0.0, 2e6, 0.0), (5e-8, 1e12, -0.2)):
        model = a24.Aggregates(stress, compliance, a24.PRINTED[FILLING][2], 400.0)
        assert a24.power_of(rows_of(model, 0.0, (80.0,)), "velocity") == pytest.approx(expected, abs=1e-6)


def test_moduli_are_found_up_to_the_rigid_plastic_limit():
    for model in (TRUTH, a24.Aggregates(2e6, 0.0, 0.1, 400.0)):
        rows = rows_of(model, 1e-5)
        stress, compliance = a24.moduli(a24.fit_moduli(rows, model.offset))
        assert stress == pytest.approx(model.stress, rel=2e-3)
        assert compliance == pytest.approx(model.compliance, rel=1e-2, abs=2e-9)
        assert a24.moduli(a24.papers_way(rows))[0] == pytest.approx(model.stress, rel=5e-3)
    assert np.isnan(a24.fit_moduli(rows_of(TRUTH, 0.0), 0.25)).all()  # no scatter, no weights
    assert np.isnan(a24.papers_way(rows_of(TRUTH, 0.01, sizes=(40.0,)))).all()


def test_correlation_with_the_zones_is_that_about_the_means():
    random = np.random.default_rng(3)
    rows = pandas.DataFrame({"radius": np.repeat([40.0, 80.0], 20), "zone_filling": 1 + 0.03 * random.normal(size=40)})
    rows["d"] = 0.05 * rows.radius - 0.2 * rows.radius * (rows.zone_filling - 1) + 0.1 * random.normal(size=40)
    sizes = rows.assign(x=rows.radius * rows.zone_filling).groupby("radius")[["x", "d"]]
    away = sizes.transform(lambda own: own - own.mean())
    assert a24.zone_correlation(rows) == pytest.approx(np.corrcoef(away.x, away.d)[0, 1])


def test_packings_made_again_are_those_of_the_runs():
    """d(0) and the filling of the zones that meet of runs in the gallery, from their seeds."""
    table = read_table(GALLERY / "elastoplastic" / "runs.csv", a24.STUDY.columns)[0]
    for row in table[table.radius < 4.5e-6].drop_duplicates(["filling"]).itertuples():
        reach, found = row.radius + row.grain_radius, []
        for index, side in ((0, -1.0), (1, 1.0)):
            packing = cpe(row.filling, row.radius, row.grain_radius, row.overlap, row.seed, index)
            found.append(moved(packing, (side * reach, 0.0, 0.0)).position)
        position, aggregate = np.concatenate(found), np.repeat([0, 1], [len(own) for own in found])
        d, _ = compression_and_velocity(position[:, 0], 0 * position[:, 0], row.radius)
        assert d + 2 * row.grain_radius == pytest.approx(row.offset, abs=1e-9 * row.grain_radius)
        zones = a24.zones_that_meet(position, aggregate, row.radius, row.grain_radius)
        assert zones == pytest.approx(row.zone_filling)
