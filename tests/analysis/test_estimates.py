"""Numbers of runs with errors, and a paper's beside them: the jackknife and the words against closed forms."""

import math

import numpy as np
import pandas
import pytest

from analysis.studies.comparison import END, START, Row, as_text, counted, filled
from analysis.studies.estimates import *


def runs_of(values, **more):
    return pandas.DataFrame({"pair": range(len(values)), "y": values, **more})


def test_the_error_of_a_mean_is_that_of_independent_pairs():
    values = np.random.default_rng(1).normal(size=7)
    found = estimate(mean("y"), runs_of(values))
    assert (found.value, found.pairs) == (pytest.approx(values.mean()), 7)
    assert found.error == pytest.approx(values.std(ddof=1) / math.sqrt(7), rel=1e-12)


def test_a_difference_of_the_same_pairs_has_no_error_from_what_they_share():
    one, other = runs_of([5.1, 0.9, 9.6]), runs_of([4.0, 0.0, 8.0, 77.0])
    found = beside(mean("y"), one, other)
    assert (found.value, found.pairs) == (pytest.approx(1.2), 3) and found.error == pytest.approx(math.sqrt(0.13 / 3))
    apart = beside(mean("y"), one, other.assign(pair=other.pair + 10), np.divide)
    assert apart.value == pytest.approx(5.2 / 22.25) and apart.error > 0.1


def test_a_ratio_has_the_error_of_the_delta_method():
    random = np.random.default_rng(2)
    x, y = 5 + 0.1 * random.normal(size=(2, 400))
    found = estimate(lambda r: r.y.mean() / r.x.mean(), runs_of(y, x=x))
    assert found.error == pytest.approx((y / x).std() / 20, rel=0.05)


def test_without_a_second_pair_or_a_value_there_is_no_error():
    assert estimate(mean("y"), runs_of([3.0])) == Estimate(3.0, None, 1)
    assert estimate(mean("y"), runs_of([2.0, 2.0])).error is None
    assert math.isnan(estimate(mean("y"), runs_of([])).value)


def test_fractions_count_decided_runs_of_pairs_that_met():
    outcomes = ["sticking", "sticking", "bouncing", "undecided", "never met"]
    found = ending(runs_of([0.0] * 5, outcome=outcomes), "sticking")
    assert found.value == pytest.approx(3 / 5) and found.error == pytest.approx(math.sqrt(0.6 * 0.4 / 3))
    assert str(found) == "0.60 ± 0.28 (2 of 3, 1 undecided)"


def test_a_threshold_is_where_lines_between_points_first_fall_through_0_and_power_laws_are_fitted_exactly():
    speeds = np.array([10.0, 20.0, 30.0, 40.0])
    assert threshold(speeds, 25.0 - speeds) == pytest.approx(25.0)
    assert threshold(speeds, [1.0, -1.0, 1.0, -1.0]) == pytest.approx(15.0)
    assert math.isnan(threshold(speeds, speeds)) and math.isnan(threshold(speeds, -speeds))
    assert exponent(speeds, 3 * speeds**1.7) == pytest.approx(1.7, rel=1e-12)


@pytest.mark.parametrize(
    "value, error, pairs, paper, runs, word",
    [
        (10.0, 1.0, 4, 11.5, None, "agrees"),
        (10.0, 1.0, 4, 12.5, None, "unclear"),
        (10.0, 1.0, 4, 13.5, None, "differs"),
        (10.0, 1.0, 4, 13.5, 1, "agrees"),  # one run of the paper's scatters by 2: the combined error is 2.2
        (10.0, 4.0, 4, 11.5, None, "unclear"),  # imprecise
        (0.0, 0.02, 4, (-0.05, 0.05), None, "agrees"),
        (0.0, 0.03, 4, (-0.05, 0.05), None, "unclear"),
        (0.3, 0.1, 4, (0.0, None), None, "agrees"),
        (0.1, 0.1, 4, (0.0, None), None, "unclear"),
        (-0.4, 0.1, 4, (0.0, None), None, "differs"),
        (0.3, None, 1, (0.0, None), None, "unclear"),
        (10.0, 0.0, 0, (9.0, 11.0), None, "agrees"),  # a closed form
        (12.0, 0.0, 0, (9.0, 11.0), None, "differs"),
        (10.0, 1.0, 4, None, None, "unclear"),  # a phrase
        (math.nan, None, 0, 11.5, None, "not run"),
    ],
)
def test_the_word_of_a_comparison(value, error, pairs, paper, runs, word):
    assert Row("q", Estimate(value, error, pairs), paper, "printed", runs=runs).word == word


def test_differences_are_in_combined_errors_with_their_sign():
    assert Row("q", Estimate(10.0, 1.0, 4), 13.0, "13", runs=4).difference == pytest.approx(-3 / math.sqrt(2))
    assert Row("q", Estimate(10.0, 1.0, 4), (5, 8), "5 to 8").difference == 2.0
    assert Row("q", Estimate(6.0, 1.0, 4), (5, 8), "5 to 8").difference == 0.0


def test_a_page_has_its_table_filled_and_every_number_in_its_words_checked():
    rows = [Row("d|max", Estimate(2.0, 0.1, 4), 2.1, "2.1"), Row("ours alone", Estimate(3.0, 0.2, 5))]
    text = f"It is 2.00 ± 0.10.\n{START}\n| quantity | paper |\n|---|---|\n| ours alone | x |\n{END}\nEnd\n"
    page = filled("README.md", text, rows, "pairs")
    assert "| ours alone |  | 3.00 ± 0.20 (5) |  |  |" in page and page.endswith(f"{END}\nEnd\n")
    assert filled("README.md", page, rows, "pairs") == page and "1 agrees" in counted(rows)
    for old, new, words in (("2.00", "2.01", "no study has this number"), ("alone", "lone", "its table has")):
        with pytest.raises(ValueError, match=words):
            filled("README.md", text.replace(old, new), rows, "pairs")
    assert list(as_text(rows))[1][3:] == ("-1.0", "agrees")
