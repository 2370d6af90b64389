"""Growth efficiency of larger aggregates, extrapolated from tables of runs that follow f_inf + c N^-p."""

import numpy as np
import pandas
import pytest

from analysis.studies.viscous.results import make_results
from analysis.studies.viscous.size_dependence import extrapolate, size_section

VELOCITIES = (40.0, 50.0, 63.0)
SQUARES = (0.0, 0.5, 1.0)


def law(grains, velocity):
    """<f_gro> of the made runs: N^-1/2, and 0 at 50 m/s for endless aggregates."""
    return 2.0 * np.log(50.0 / velocity) - 3.0 * grains**-0.5


def table(sizes, seeds=(1, 2, 3, 4), noise=0.0):
    rows = []
    for grains in sizes:
        for seed in seeds:
            own = noise * np.random.default_rng((grains, seed)).normal()
            for velocity in VELOCITIES:
                for square in SQUARES:
                    row = {"grains": grains, "seed": seed, "velocity": velocity, "impact": square**0.5}
                    growth = law(grains, velocity) + own
                    rows.append({**row, "growth": growth, "viscoelasticTime": 0.0, "sticking_velocity": 6.0})
    made = pandas.DataFrame(rows)
    return made.assign(fragments="1x1", largest=1.0, characteristic_radius=1.0, grain_radius=1.0)


def test_the_law_that_the_runs_follow_is_found_again():
    growth = make_results(table((500, 2000))).growth
    velocities, mean, resamples = extrapolate(growth[500, 0.0], growth[2000, 0.0], 10_000, 0.5)
    assert velocities.tolist() == list(VELOCITIES)
    expected = [law(10_000, velocity) for velocity in VELOCITIES]
    assert mean == pytest.approx(expected) and resamples == pytest.approx(np.tile(expected, (len(resamples), 1)))


def test_section_tells_the_right_exponent_from_the_wrong_one():
    found = size_section(make_results(table((20, 200, 50_000), noise=0.005)))
    of_largest = [row for row in found.records if row["grains"] == 50_000]
    rows = [row for row in of_largest if row["quantity"].startswith("<f_gro>")]
    assert len(rows) == len(VELOCITIES)
    assert all(abs(row["extrapolated_p1/2_difference"]) < 4 for row in rows)
    assert all(row["extrapolated_p1/3_difference"] < -4 for row in rows)
    threshold = next(row for row in of_largest if row["quantity"].startswith("v_fra"))
    assert threshold["measured"] == pytest.approx(threshold["extrapolated_p1/2"], rel=0.02)
    # Errors: of the sum of independent pairs with their weights, 0.005/2 each.
    weight = (200**-0.5 - 50_000**-0.5) / (20**-0.5 - 200**-0.5)
    expected = 0.0025 * np.hypot(1 + weight, weight)
    assert 0.3 * expected < rows[0]["extrapolated_p1/2_error"] < 3 * expected


def test_one_seed_has_no_error_and_one_size_no_section():
    alone = size_section(make_results(table((500, 2000), seeds=(1,))))
    assert {row["extrapolated_p1/2_error"] for row in alone.records} == {None}
    assert {row["grains"] for row in alone.records} == {10_000, 50_000}
    assert size_section(make_results(table((500,)))) is None
