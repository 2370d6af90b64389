"""Means over the offsets of A22's collisions: which pairs of aggregates count, their errors, and what stands beside the paper."""

import numpy as np
import pandas
import pytest

from analysis.report.beside_paper import Line
from analysis.statistics import student_chance
from analysis.studies.viscous import comparison, fragment_lines, growth_lines, lines, loss_lines, paper
from analysis.studies.viscous.beside_one_pair import beside_range
from analysis.studies.viscous.curves import difference
from analysis.studies.viscous.figures.common import time_colours
from analysis.studies.viscous.figures.growth import collapse_figure, thresholds_figure
from analysis.studies.viscous.impact_mean import Draws
from analysis.studies.viscous.measure import sizes_text
from analysis.studies.viscous.offset_shift import offset_shift_sections
from analysis.studies.viscous.results import by_time, make_results
from analysis.studies.viscous.size_dependence import fewer_offsets_sections, predicted_section, size_section
from analysis.studies.viscous.size_distribution import size_distribution

TWELFTHS, EVERY_SECOND = range(13), range(0, 13, 2)
VELOCITIES = tuple(10 ** (0.1 * i) for i in (16, 17, 18, 19))
V_FRA = 55.0
PEAK = 0.6  # f_gro head-on beyond what its neighbours have


def growth_of(grains, seed, velocity, twelfths):
    """f_gro of the made runs: linear in B_off^2 but for a peak at 0, with a mean of its own for each pair."""
    pair = 0.03 * np.random.default_rng((grains, seed)).normal()
    return (1 - twelfths / 12) * np.log(V_FRA / velocity) + pair + (PEAK if twelfths == 0 else 0.0)


def table(pairs, grains=2000, velocities=VELOCITIES, times=(0.0,), sticking=6.0):
    """Runs of pairs {seed: twelfths}."""
    rows = []
    for seed, offsets in pairs.items():
        for time in times:
            for velocity in velocities:
                for twelfths in offsets:
                    growth = growth_of(grains, seed, velocity, twelfths)
                    row = {"grains": grains, "seed": seed, "velocity": velocity, "impact": (twelfths / 12) ** 0.5}
                    row |= {"growth": growth, "viscoelasticTime": time, "sticking_velocity": sticking, "closure": 1e-4}
                    rows.append({**row, "met": True, "formed": np.nan, "broken": np.nan})
    return pandas.DataFrame(rows).assign(
        fragments="1x10 1x2", largest=10.0, characteristic_radius=1.0, grain_radius=1.0
    )


def lines_of(groups):
    """{quantity: Line} of what a group of lines yields."""
    return {line.quantity: line for _, found, _ in groups for line in found}


def test_a_pair_that_has_run_head_on_only_tells_no_error():
    whole = make_results(table({1: TWELFTHS})).growth[2000, 0.0]
    results = make_results(table({1: TWELFTHS, 2: (0,)}))
    growth = results.growth[2000, 0.0]
    assert growth.mean == pytest.approx(whole.mean) and growth.v_fra == pytest.approx(whole.v_fra)
    assert np.isnan(growth.error).all() and growth.v_fra_error is None and growth.pairs == 1
    # The head-on collisions themselves are of both.
    assert results.head_on[2000, 0.0].pairs == 2 and results.head_on[2000, 0.0].has_errors
    said = list(comparison.remarks(results))
    assert any("4 of 56 runs are of pairs without all 13 offsets" in line for line in said)
    assert any("one seed at every B_off" in line for line in said)


def test_errors_come_from_whole_pairs():
    """Three whole pairs and one with every second offset: as without the last."""
    three = make_results(table(dict.fromkeys((1, 2, 3), TWELFTHS))).growth[2000, 0.0]
    four = make_results(table({**dict.fromkeys((1, 2, 3), TWELFTHS), 4: EVERY_SECOND})).growth[2000, 0.0]
    assert four.mean == pytest.approx(three.mean) and four.pairs == three.pairs == 3
    scatter = [np.mean([growth_of(2000, seed, V_FRA, 12)]) for seed in (1, 2, 3)]
    expected = np.std(scatter, ddof=1) / 3**0.5
    assert four.error == pytest.approx(np.full(4, expected), rel=0.15) and len(four.offsets) == 13


def test_a_velocity_with_one_pair_leaves_the_threshold_without_error():
    made = table(dict.fromkeys((1, 2, 3), TWELFTHS))
    made = made[(made.seed == 1) | (made.velocity < 70)]
    growth = make_results(made).growth[2000, 0.0]
    assert growth.numbers.tolist() == [3, 3, 3, 1] and np.isfinite(growth.error[:3]).all()
    assert growth.v_fra is not None and growth.v_fra_error is None


def test_runs_of_unlike_pairs_count_as_one():
    """No pair has offsets from 0 to 1, all together have: a mean without error."""
    growth = make_results(table({1: (0, 6), 2: (6, 12)})).growth[2000, 0.0]
    assert growth.pairs == 1 and np.isnan(growth.error).all() and len(growth.offsets) == 3


def test_fewer_offsets_are_said_and_never_stand_beside_all():
    pairs = dict.fromkeys((1, 2, 3), TWELFTHS)
    large = table(dict.fromkeys((1, 2), EVERY_SECOND), grains=10_000)
    results = make_results(pandas.concat([table(pairs, 500), table(pairs, 2000), large], ignore_index=True))
    found = lines_of(growth_lines.thresholds(results))
    names = [name for name in found if name.startswith("v_fra,")]
    assert [name.endswith(", 7 offsets") for name in names] == [False, False, True]
    assert found[names[-1]].paper is None and found[names[-1]].ours > 60
    of_large = [row for row in size_section(results).records if row["grains"] == 10_000]
    assert all(row["measured"] is None for row in of_large if row["quantity"].startswith(("<f_gro>", "v_fra")))
    assert predicted_section(results) is not None
    section, of_predicted = fewer_offsets_sections(results)
    assert all(row["quantity"].endswith("7 offsets") for row in (*section.records, *of_predicted.records))
    # The peak has the weight 1/12 of seven offsets at every size, 1/24 of thirteen: no difference is made by it.
    at = next(row for row in section.records if row["quantity"].startswith("<f_gro> at 50.1"))
    assert at["measured"] == pytest.approx(
        np.mean([growth_of(10_000, s, VELOCITIES[1], 6) for s in (1, 2)]) + PEAK / 12
    )
    (shift,) = offset_shift_sections(results)
    rows = {(row["grains"], row["quantity"]): row for row in shift.records}
    row = rows[2000, "<f_gro> at 50.1 m/s"]
    assert row["shift"] == pytest.approx(PEAK / 12 - PEAK / 24) and row["error"] == pytest.approx(0, abs=1e-12)
    assert rows[10_000, "<f_gro> at 50.1 m/s, predicted"]["shift"] == pytest.approx(PEAK / 24)
    assert rows[500, "v_fra [m/s]"]["shift"] > 0


def test_differences_are_of_the_same_offsets():
    made = pandas.concat([table({1: TWELFTHS}), table({1: EVERY_SECOND}, times=(6e-12,))], ignore_index=True)
    growth = make_results(made).growth
    assert difference(growth[2000, 6e-12], growth[2000, 0.0], VELOCITIES[1]) is None


@pytest.mark.parametrize("value, end", [(55.0, None), (61.0, 60.0), (48.0, 50.0)])
def test_beside_a_range_the_nearer_end_counts(value, end):
    line = beside_range("v_fra", "m/s", value, 1.0, 4, *paper.V_FRA)
    assert line.paper == end
    if end is None:
        assert line.chance is None
    else:
        # The paper's one pair scatters as one of ours: 2 m/s.
        assert line.chance == pytest.approx(student_chance((value - end) / 5**0.5, 3))


def test_pairs_are_the_unit():
    """A pair that ran twice is one pair."""
    made = pandas.DataFrame({"viscoelasticTime": [0.0] * 3, "seed": [1, 1, 2]})
    assert by_time(made, [1.0, 3.0, 4.0]) == [(0.0, 3.0, 1.0, 2)]


def test_head_on_means_name_their_velocities():
    made = pandas.concat(
        [table({1: (0,), 2: (0,)}, 500, [10 ** (0.1 * i) for i in range(13, 21)]), table({1: (0,), 2: (0,)}, 2000)],
        ignore_index=True,
    )
    found = lines_of(growth_lines.head_on(make_results(made)))
    assert list(found) == [
        "f_gro, B_off = 0, 20 to 100 m/s, T_vis = 0 ps, 500 grains",
        "f_gro, B_off = 0, 39.8 to 79.4 m/s, T_vis = 0 ps, 2000 grains",
    ]
    expected = np.mean([growth_of(500, s, 10 ** (0.1 * i), 0) for s in (1, 2) for i in range(13, 21)])
    assert next(iter(found.values())).ours == pytest.approx(expected)


def test_fits_are_in_the_papers_ranges():
    """N_cum = N from 100 grains on, and below it single grains alone: both are found, each in its range."""
    numbers = np.arange(100, 2000)
    sizes = np.append(
        np.repeat(numbers, np.random.default_rng(1).poisson(100 / numbers)), np.ones(100 * 100, dtype=int)
    )
    # Of 100 runs together: the scale does not matter to the exponents.
    made = pandas.DataFrame({"impact": [0.0, 0.5**0.5, 1.0], "grains": 2000, "seed": 1, "fragments": sizes_text(sizes)})
    found = size_distribution(made, Draws([1], 10))
    assert found.large_law.exponent == pytest.approx(1.0, abs=0.03) and found.power_law.exponent > 1.8
    assert found.large_share[0] == pytest.approx(_section(sizes[sizes > 200]) / _section(sizes), abs=0.02)
    short = size_distribution(made.assign(grains=500), Draws([1], 10))
    assert short.large_law.exponent is None  # 100 to 500 grains tell no power


def _section(sizes):
    return np.sum(sizes ** (2 / 3))


def test_full_size_fragments_of_one_over_n():
    """Three pairs whose fragments are of f(N) = 1/N: N_cum(<= N) = N."""
    random, rows = np.random.default_rng(3), []
    for seed in (1, 2, 3):
        number = random.poisson(1 / np.arange(1, 20_001))
        sizes = np.repeat(np.arange(1, 20_001), number)
        sizes = np.append(sizes, 2 * paper.GRAINS - sizes.sum())
        row = table({seed: (3,)}, paper.GRAINS, (paper.VELOCITY,), (6e-12,)).iloc[0].to_dict()
        rows.append({**row, "fragments": sizes_text(sizes)})
    found = lines_of(fragment_lines.full_size(make_results(pandas.DataFrame(rows))))
    alpha = found["alpha"]
    assert abs(alpha.ours - 1) < 4 * alpha.error < 1.5 and alpha.chance is None
    assert found["N_cum(<= 1000)"].paper == 1000 and 300 < found["N_cum(<= 1000)"].ours < 3000
    assert found["Z_cum(>= 10)"].paper == pytest.approx(np.log(1e4))


def test_ratios_with_and_without_drag_are_of_pairs():
    runs = pandas.DataFrame({"viscoelasticTime": [0.0, 0.0, 6e-12, 6e-12, 6e-12], "seed": [1, 2, 1, 2, 3]})
    (line,) = loss_lines._with_over_without(runs, "sliding", pandas.Series([2.0, 4.0, 1.0, 2.4, 9.0]))
    assert line.ours == pytest.approx(0.55) and line.error == pytest.approx(0.05) and "2 pairs" in line.note


def test_every_viscous_time_has_a_colour_of_its_own():
    times = np.arange(9) * 1e-12
    colours = time_colours(pandas.DataFrame({"viscoelasticTime": times}))
    assert len(colours) == 9 and len({tuple(np.atleast_1d(colour)) for colour in colours.values()}) == 9


def test_grains_that_always_stick():
    """v_stick beyond the paper's chart, and none at all: on the chart, and said."""
    pairs = dict.fromkeys((1, 2), TWELFTHS)
    parts = [table(pairs, times=(t,), sticking=v) for t, v in ((0.0, 6.0), (8e-12, 200.7), (12e-12, np.inf))]
    results = make_results(pandas.concat(parts, ignore_index=True))
    found = lines_of(lines._collapse(results))
    line = found["v_fra/v_stick, T_vis = 12 ps, 2000 grains"]
    assert isinstance(line, Line) and line.ours is None and "always stick" in line.note
    ratio = lines_of(growth_lines.thresholds(results))["v_fra(12 ps)/v_fra(0 ps), 2000 grains"]
    assert "two grains always stick at 12 ps" in ratio.note
    (axes,) = thresholds_figure(results).axes
    assert axes.get_ylim()[1] > 200.7 and any("always" in text.get_text() for text in axes.texts)
    assert collapse_figure(results) is not None
