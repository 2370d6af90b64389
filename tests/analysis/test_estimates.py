"""Means over pairs of aggregates, what follows from them, and verdicts beside a paper. Random seeds are fixed."""

import re
from dataclasses import replace

import numpy as np
import pandas
import pytest
from refused import refused
from scipy.stats import binomtest, fisher_exact
from scipy.stats import t as student

from analysis import exact_interval
from analysis.statistics import smoothed_scatter
from analysis.studies.definition import Quantity, Results, WrongUnit
from analysis.studies.estimate import Fraction, combine, exact, mean, number_text
from analysis.studies.paper import Claim, PaperError, read_paper
from analysis.studies.predictions import predictions
from analysis.studies.runs import Runs, SeveralRuns, along, at, differences, ratios, select, together
from analysis.studies.threshold import thresholds
from analysis.studies.verdict import NO, UNTESTED, YES, judge


def pairs(values, name="p"):
    return {f"{name}{k}": value for k, value in enumerate(values)}


def test_a_means_error_is_that_of_its_values():
    """s/n^(1/2), to three standard errors of a thousand draws."""
    values = [1.0, 2.0, 6.0, 3.5]
    found = mean(pairs(values))
    assert found.value == 3.125 and found.pairs == 4
    assert found.error == pytest.approx(np.std(values, ddof=1) / 2, rel=0.07)
    assert mean({"a": 1.0}).error is None and mean({"a": 1.0}).interval() == (None, None)
    assert mean(pairs([0.3, 0.1 + 0.2, 0.3])).error == 0.0  # the same but for rounding
    assert mean(pairs([0.0] * 6)).interval() == (None, None)  # no measurement of an error of 0


def test_intervals_cover():
    """The mean of four normal numbers lies in the 95 % interval in 400 sets 95 % of the time: 91 % at least."""
    random = np.random.default_rng(5)
    inside = 0
    for k in range(400):
        low, high = mean(pairs(random.normal(size=4), f"set{k}-")).interval()
        inside += low < 0 < high
    assert 0.91 < inside / 400 < 0.99


def test_smoothed_scatter_follows_a_power_without_bias():
    """s ~ v^-1 from three seeds at eight velocities, 400 times: the mean logarithm is right to 3.3 standard errors."""
    random, v = np.random.default_rng(11), 10 ** (0.1 * np.arange(8))
    found = [smoothed_scatter(v, random.normal(size=(3, 8)).std(axis=0, ddof=1) / v, np.full(8, 3)) for _ in range(400)]
    logs = np.log(found)
    assert np.all(np.abs(logs.mean(axis=0) + np.log(v)) < 3.3 * logs.std(axis=0) / 20)
    assert np.all(np.isnan(smoothed_scatter(np.ones(3), np.zeros(3), np.full(3, 5))))


def test_what_the_same_pairs_gave_keeps_its_correlation_and_lost_draws_leave_no_error():
    first, second = mean(pairs([1.0, 3.0, 8.0])), mean(pairs([2.0, 4.0, 9.0]))
    assert (second - first).value == 1.0 and (second - first).error == 0.0
    others = mean(pairs([2.0, 4.0, 9.0], "other"))
    assert (others - first).error == pytest.approx(np.hypot(first.error, others.error), rel=0.1)
    assert (first / mean(pairs([2.0, 6.0, 16.0]))).error == 0.0 and (2 * first - first - first).error == 0.0
    assert combine(np.maximum, first, exact(100.0)).error == 0.0
    low = mean(pairs([0.1, 2.0, 3.0]))
    root = combine(lambda x: np.where(x > 1.0, np.sqrt(np.abs(x)), np.nan), low)
    assert root.value == pytest.approx(1.7**0.5) and root.error is None and repr(root) == "about 1.3"


def made(values):
    """Runs of {(size, velocity): {seed: value}}."""
    rows = [(n, v, s, x) for (n, v), own in values.items() for s, x in own.items()]
    return pandas.DataFrame(rows, columns=["grains", "velocity", "seed", "value"])


def test_groups_and_populations():
    """Pair 1 of one size is not pair 1 of another; a pair that ran twice counts once."""
    runs = made({(500, 1.0): {1: 1.0, 2: 3.0}, (500, 10**1.7): {1: 2.0, 2: 4.0}, (2000, 1.0): {1: 1.0, 2: 3.0}})
    runs = pandas.concat([runs, made({(500, 1.0): {1: 3.0}})], ignore_index=True)
    series = Runs(runs, population=("grains",)).estimates("value", ("grains", "velocity"))
    assert at(series, grains=500, velocity=1.0).value == 2.5 and at(series, grains=500, velocity=50.1).value == 3.0
    assert at(series, grains=500, velocity=7.0) is None
    of_500, of_2000 = select(series, velocity=1.0, grains=500), select(series, velocity=1.0, grains=2000)
    assert not np.array_equal(of_500.iloc[0].draws[0], of_2000.iloc[0].draws[0])
    faster = differences(select(series, velocity=50.1), select(series, velocity=1.0))
    assert faster.index.to_list() == [500] and faster.iloc[0].value == 0.5
    assert ratios(series, series).map(lambda e: e.value).eq(1.0).all()
    both = together({"a": series, "b": series * 2}, "what")
    assert at(both, grains=2000, velocity=1.0, what="b").value == 4.0
    with pytest.raises(ValueError, match="2 estimates"):
        at(series, grains=500)


def test_the_same_pairs_stand_beside_each_other():
    """At 1 m/s pairs 1 and 2 ran with both sizes, at 2 m/s no pair did: there all count, and no ratio over what may be 0."""
    of_500 = {(500, 1.0): {1: 2.0, 2: 4.0, 3: 100.0}, (500, 2.0): {1: 1.0, 2: -1.0}}
    runs = Runs(made({**of_500, (2000, 1.0): {1: 3.0, 2: 5.0}, (2000, 2.0): {3: 5.0, 4: 7.0}}))
    more, over = (runs.beside("grains", 500, "value", ("velocity",), by) for by in (differences, ratios))
    slow, fast = dict(grains=2000, velocity=1.0), dict(grains=2000, velocity=2.0)
    assert (at(more, **slow).value, at(more, **slow).error) == (1.0, 0.0)
    assert at(more, **fast).value == 6.0 and at(more, **fast).error > 0
    assert at(over, **slow).value == pytest.approx(4 / 3) and at(over, **fast) is None


OFFSETS = tuple(k / 12 for k in range(13))


def of_offsets(cells):
    """Runs of {seed: {offset: value}}."""
    rows = [(s, x, y) for s, own in cells.items() for x, y in own.items()]
    return Runs(pandas.DataFrame(rows, columns=["seed", "square", "value"]))


def test_the_same_pairs_with_one_thing_changed():
    """Pair 3 has run without the change alone, and doesn't count; populations keep pair 1 of a and that of b apart."""
    drag, y = [0, 6, 0, 6, 0, 0, 6], [1, 2, 3, 6, 9, 4, 2.0]
    columns = dict(size=[*"aaaaabb"], seed=[1, 1, 2, 2, 3, 1, 1], drag=drag, y=y)
    runs = Runs(pandas.DataFrame(columns), population=("size",))
    found = runs.beside("drag", 0, "y", ("size",), ratios, same_pairs=True)
    assert [(e.value, e.pairs) for e in found] == [(2.0, 2), (0.5, 1)] and found.iloc[0].error == 0.0
    assert list(found.index) == [("a", 6), ("b", 6)]
    assert len(runs.beside("drag", 7, "y", ("size",), ratios, same_pairs=True)) == 0
    assert len(runs.where(drag=0).beside("drag", 0, "y", ("size",), ratios)) == 0  # nothing changed


def test_pairs_whose_offsets_are_not_all_there_with_a_change_do_not_count():
    """Pair 2 lacks an offset with drag: what it gave without is left out, too."""
    own = {(1, 0): (1.0, 3.0), (1, 6): (2.0, 6.0), (2, 0): (50.0, 70.0), (2, 6): (90.0,)}
    rows = [(pair, drag, x, y) for (pair, drag), values in own.items() for x, y in enumerate(values)]
    runs = Runs(pandas.DataFrame(rows, columns=["seed", "drag", "square", "y"])).over("square", (0, 1))
    found = at(runs.beside("drag", 0, "y", (), differences, same_pairs=True), drag=6)
    assert (found.value, found.pairs) == (2.0, 1)


def test_a_mean_over_points_counts_pairs_that_have_all_of_them():
    """Two whose means are 0.5, though every offset differs by 1, have the error of 13 independent points."""
    whole = {seed: {x: seed * x for x in OFFSETS} for seed in (1, 2, 3)}
    runs = of_offsets({**whole, 4: {x: 100.0 for x in OFFSETS[::2]}})
    weights = lambda points: np.where((points == 0) | (points == 1), 0.5, 1.0)
    found = runs.over("square", OFFSETS, weights).estimates("value", ()).iloc[0]
    assert found.pairs == 3 and found.value == pytest.approx(2.0 * 0.5)
    assert runs.over("square", OFFSETS[::2]).estimates("value", ()).iloc[0].pairs == 4
    up = {x: float(k % 2) for k, x in enumerate(OFFSETS)}
    down = {x: 1 - y for x, y in up.items()}
    found = of_offsets({1: up, 2: down}).over("square", OFFSETS).estimates("value", ()).iloc[0]
    expected = (13 * (1 / 13) ** 2 * 0.5 / 2) ** 0.5
    assert found.error == pytest.approx(expected, rel=0.15)
    alike = of_offsets({1: up, 2: up}).over("square", OFFSETS).estimates("value", ()).iloc[0]
    assert alike.error == 0.0


def test_fits_along_a_level():
    """A line through three velocities: its slope has the error of the difference of the ends."""
    runs = Runs(made({(1, v): {1: v, 2: 2.0 * v, 3: 3.5 * v} for v in (1.0, 2.0, 4.0)}))
    series = runs.estimates("value", ("grains", "velocity"))
    slope = along(series, "velocity", lambda x, y: (y @ (x - x.mean())) / ((x - x.mean()) ** 2).sum()).iloc[0]
    ends = (at(series, grains=1, velocity=4.0) - at(series, grains=1, velocity=1.0)) / 3.0
    assert slope.value == pytest.approx(ends.value) and slope.error == pytest.approx(ends.error)


def test_fits_to_all_runs_have_the_errors_of_least_squares():
    """Slope of 40 pairs, one run each: the textbook's error to 15 %."""
    random = np.random.default_rng(2)
    x = random.uniform(0, 1, 40)
    runs = pandas.DataFrame(dict(seed=np.arange(40), x=x, value=3 * x + 0.2 * random.normal(size=40)))

    def line(rows, weights):
        w, x, y = weights / weights.sum(axis=1, keepdims=True), rows.x.to_numpy(), rows.value.to_numpy()
        mx, my = w @ x, w @ y
        slope = (w @ (x * y) - mx * my) / (w @ x**2 - mx**2)
        return np.stack([slope, my - slope * mx], axis=1)

    found = Runs(runs).fit(line, ("slope", "height"))
    residual = runs.value - np.polyval(np.polyfit(x, runs.value, 1), x)
    textbook = np.sqrt(residual.var(ddof=2) / (40 * x.var()))
    assert at(found, number="slope").value == pytest.approx(np.polyfit(x, runs.value, 1)[0])
    slope = at(found, number="slope")
    assert slope.error == pytest.approx(textbook, rel=0.15)
    assert slope.freedom == (slope - mean(pairs(residual))).freedom == 38 and (slope + exact(1.0)).freedom == 38
    low, high = slope.interval()
    assert high - low == pytest.approx(2 * slope.error * student.ppf(0.975, 38))


def test_fractions():
    four = {0: "sticks", 1: "undecided", 2: "bounces", 3: "bounces"}
    runs = made({(1, 1.0): dict.fromkeys(range(10), "sticks"), (1, 2.0): four})
    found = Runs(runs).fractions(lambda t: t.value == "sticks", ("velocity",), lambda t: t.value == "undecided")
    assert found.iloc[0].interval() == pytest.approx((0.6915, 1.0), abs=1e-4)
    assert found.iloc[1].counts == (1, 2) and found.iloc[1].undecided == 1
    assert found.iloc[1].interval()[1] > Fraction(1, 4).interval()[1]
    assert Fraction(0, 5).chance(1.0, 1.0, 5) == pytest.approx(2 / 252) and Fraction(5, 10).chance(0.5, 0.5) == 1.0
    # one-sided; of undecided runs every number may be the one, also what agrees
    assert Fraction(0, 10).chance(0.5, 1.0, 5) == pytest.approx(fisher_exact([[0, 10], [2, 3]], "less")[1])
    assert Fraction(10, 10).chance(0.0, 0.5, 5) == Fraction(0, 10).chance(0.5, 1.0, 5)
    assert Fraction(3, 10).chance(0.0, 0.1) == pytest.approx(binomtest(3, 10, 0.1, "greater").pvalue)
    assert Fraction(0, 30, 30).chance(0.5, 1.0, 5) == 1.0 and Fraction(1, 10, 8).chance(0.5, 0.5) == 1.0
    # beside a value of 5 runs: of the difference, with the ends of both intervals
    own, theirs = exact_interval(40, 100), exact_interval(2, 5)
    widths = np.hypot(0.4 - own[0], theirs[1] - 0.4), np.hypot(own[1] - 0.4, 0.4 - theirs[0])
    assert Fraction(40, 100).interval(runs=5, value=0.4) == pytest.approx((0.4 - widths[0], 0.4 + widths[1]))
    with pytest.raises(SeveralRuns, match="several runs"):
        Runs(pandas.concat([runs, runs])).fractions("seed", ("velocity",))


def of_mean(scatter, n=4):
    """Results with one quantity q: the mean of n pairs with that value and standard error."""
    values = np.linspace(-1, 1, n) * scatter[1] * np.sqrt(n) / np.std(np.linspace(-1, 1, n), ddof=1) + scatter[0]
    series = Runs(made({(1, 1.0): dict(enumerate(values))})).estimates("value", ("grains",))
    return Results(None, {"q": Quantity("q", "made", series)})


def claim(**given):
    return Claim("q", "made", "", "", **{"where": {"grains": 1}, "runs": 4, **given})


@pytest.mark.parametrize(
    "ours, given, verdict",
    [
        ((10.0, 0.3), dict(value=10.0, margin=0.5, runs=100), UNTESTED + ": .* pairs would decide"),
        ((10.0, 0.3), dict(value=10.0, margin=0.5, runs=1), UNTESTED + ": .*no number of pairs"),
        ((10.0, 0.1), dict(value=10.2, margin=1.0), YES),
        ((10.0, 0.1), dict(value=12.0, margin=1.0), NO),
        ((10.0, 0.1), dict(value=10.2, margin=0.1), UNTESTED),  # no difference is no agreement
        ((10.0, 1.0), dict(value=12.0, margin=1.0, runs=1), UNTESTED),  # the paper's one run scatters as ours
        ((10.0, 0.1), dict(low=9.0), YES),
        ((10.0, 0.1), dict(low=9.9), UNTESTED),
        ((10.0, 0.1), dict(low=9.6), YES + ": 95 % interval"),
        ((10.0, 0.1), dict(low=9.6, looks=3), UNTESTED + ": 98.3 % interval"),  # each look counts
        ((10.0, 0.1), dict(high=9.0, runs=100), NO),
        ((10.0, 0.1), dict(high=9.0, runs=100, looks=100), UNTESTED),
        ((10.0, 0.1), dict(low=9.0, high=9.5, margin=1.0, runs=100), YES),
        ((10.0, 0.1), dict(value=12.0, margin=1.0, test=False), UNTESTED),
        ((10.0, 0.1), dict(value=12.0, margin=1.0, where={"grains": 50000}), UNTESTED),  # tested at the claim's size alone
        ((10.0, 0.1), dict(value=10.5, margin=0.45, runs=10_000), UNTESTED),  # beyond the margin, not surely
    ],
)  # fmt: skip
def test_verdicts(ours, given, verdict):
    (found,) = judge([claim(**given)], of_mean(ours))
    assert found.why and re.match(verdict, f"{found.verdict}: {found.why}")


def test_a_closed_form_of_what_was_not_run_contradicts_nothing():
    of = Quantity("q", "made", pandas.Series({1: exact(np.nan)}).rename_axis("grains"))
    assert judge([claim(low=1.0)], Results(None, {"q": of}))[0].state == "not run"


def test_fractions_have_no_unit():
    with refused(WrongUnit, "quantity q: fractions are counts of runs; must be without the unit %"):
        Quantity("q", "made", pandas.Series({1: Fraction(3, 4)}), "%")


def test_to_contradict_takes_more_pairs_in_a_larger_family():
    beyond = claim(value=11.0, margin=0.5, runs=1000)
    needed = [int(re.search(r"some (\d+) pairs", judge([beyond] * n, of_mean((10.0, 0.3)))[0].why)[1]) for n in (1, 20)]
    assert 4 < needed[0] < needed[1] - 4


@pytest.mark.parametrize(
    "given, says",
    [
        (dict(where={"grain": 1}), "made: where: q: no level grain (did you mean grains?); must be one of grains"),
        (dict(quantity="r"), "made: quantity: no quantity r; must be one of q"),
        (dict(), "made: value, low or high: 95 of a fraction: must be 0 to 1"),
    ],
)
def test_a_claim_of_what_there_is_not(given, says):
    """Of another level or quantity, or a fraction in percent."""
    of = Quantity("q", "made", pandas.Series({1: Fraction(3, 4)}).rename_axis("grains"))
    with refused(ValueError, says):
        judge([replace(claim(value=95.0), **given)], Results(None, {"q": of}))


def threshold(*curve, name="p"):
    """The Threshold of a curve at 10, 100 ... m/s, from a row of pairs at each."""
    index = pandas.Index([10.0 ** (k + 1) for k in range(len(curve))], name="velocity")
    return thresholds(pandas.Series([mean(pairs(row, name)) for row in curve], index)).iloc[0]


def test_a_threshold_has_the_bounds_that_its_curve_has():
    """None above, where every pair falls through 0 before the last velocity, and the curve there isn't told from 0."""
    rising, fallen = (1.0, 1.2, 1.1), (-0.1, -0.9, -0.5)
    open_end = threshold(rising, fallen)
    low, high = open_end.interval()
    assert open_end.error < 20 and low == pytest.approx(22.7, rel=0.05) and high == np.inf
    assert open_end.text == f"48.7 (95 %: above {number_text(low)}; 3)"
    closed = threshold(rising, fallen, (-2.0, -2.1, -1.9))
    assert closed.value == open_end.value and 100 < closed.interval()[1] < 200
    results = lambda own: Results(None, {"q": Quantity("q", "made", pandas.Series({1: own}).rename_axis("grains"))})
    within = dict(low=20.0, high=300.0, runs=np.inf)
    verdicts = [judge([claim(**within)], results(own))[0] for own in (open_end, closed)]
    assert [found.verdict for found in verdicts] == [UNTESTED, YES] and "one side" in verdicts[0].why
    assert judge([claim(low=900.0, runs=np.inf)], results(closed))[0].verdict == NO
    assert threshold(rising, rising).text == "- (3)" and threshold((1.0,), (-1.0,)).text == "31.6 (1)"


def test_thresholds_intervals_hold_it():
    """95 % of the intervals, or more: their ends are linear between velocities, where errors are smaller; p is that of t."""
    random, held, chances = np.random.default_rng(3), 0, []
    for k in range(300):
        found = threshold(*(random.normal(mean, size=4) for mean in (2.0, -1.0)), name=f"set{k}-")
        low, high = found.interval()
        held += low is None or low <= 10 ** (1 + 2 / 3) <= high
        chances.append(found.chance(*2 * (10 ** (1 + 2 / 3),)) or 1.0)
    assert 0.93 < held / 300 and np.mean(np.array(chances) < 0.05) < 0.08


def test_a_family_is_corrected_together():
    """One difference at p = 0.02 stands alone, and not among ten tests (Holm)."""
    results, one = of_mean((10.0, 0.1), 30), claim(value=10.45, runs=30, margin=0.1)
    (alone,) = judge([one], results)
    family = judge([one] + [claim(value=10.0, runs=30, margin=2.0)] * 9, results)
    assert 0.005 < alone.p < 0.02 and alone.verdict == NO and family[0].verdict == UNTESTED
    assert family[0].corrected == pytest.approx(10 * alone.p) and family[1].verdict == YES


PRINTED = "[[claim]]\nquantity = 'q'\nlabel = 'l'\nprinted = ''\nsource = ''\n"
UNUSABLE = {
    "[page]\nfigur = 'x'": "figur",
    "[[claim]]\nquantity = 'q'": "label",
    PRINTED: "must have value, low or high",
    (PRINTED + "value = 1\nrow = true\n") * 9: "must be 8 at most",
    "[[claim]": "paper.toml",
    "[other]\na = 1": "other",
    "[[claim]]\nwhere = { v = [1, 2] }\nvalue = [1, 2, 3]": "value has 3 values: must be 2",
    "[claim]\nquantity = 'q'": "must have one [page] at most, and [[claim]] above each claim",
    "[page]\nruns = 0": "[page]: runs = 0: must be a whole number >= 1, or inf",
    PRINTED.replace("'l'", "'at {w}'") + "where = { v = 1 }": "label: what it has in {} must be of where: v",
}
# What claim 1 (l) says besides, and what must be instead.
WRONG = {
    "value = '0.95'": "value = '0.95': must be a finite number",
    "value = true": "value = True: must be a finite number",
    "value = nan": "value = nan: must be a finite number",
    "value = inf": "value = inf: must be a finite number",
    "low = nan": "low = nan: must be a number or -inf",
    "low = 2\nhigh = 1": "low = 2: must be at most high, 1",
    "low = -inf\nhigh = inf": "is tested, and has no number: must have value, low or high",
    "value = 1\nmargin = inf": "margin = inf: must be a finite number >= 0",
    "value = 1\nmargin = -0.1": "margin = -0.1: must be a finite number >= 0",
    "value = 1\nruns = 1.5": "runs = 1.5: must be a whole number >= 1, or inf",
    "value = 1\nruns = 0": "runs = 0: must be a whole number >= 1, or inf",
    "value = 1\nruns = '5'": "runs = '5': must be a whole number >= 1, or inf",
    "value = 1\nrow = 1": "row = 1: must be true or false",
    "value = 1\nnote = 1": "note = 1: must be text",
    "value = 1\nwhere = []": "where = []: must be a table of levels, or a list of such tables",
    "value = 1\nwhere = 'grains'": "where = grains: must be a table of levels, or a list of such tables",
}
UNUSABLE |= {PRINTED + text: f"paper.toml: claim 1 (l): {says}" for text, says in WRONG.items()}


@pytest.mark.parametrize("text", UNUSABLE)
def test_a_paper_that_cannot_be_used_is_one_line(tmp_path, text):
    (tmp_path / "paper.toml").write_text(text)
    with refused(PaperError, UNUSABLE[text]):
        read_paper(tmp_path)


def test_a_claim_of_several_set_ups(tmp_path):
    """Lists in `where` make a claim for each combination, with its own of what is a list; runs of the page are those of every claim that doesn't
    say; a note is no test."""
    head = PRINTED.replace("'l'", "'at {v}, {s}'") + "sentence = 'x'\n"
    texts = (
        "where = { v = [1, 2], s = ['a', 'b'], w = 3 }\nlow = 1\nmargin = [1, 2, 3, 4]\n",
        "where = { v = 7, s = 'a' }\nnote = 'vague'\nruns = 2\n",
    )
    (tmp_path / "paper.toml").write_text("[page]\nruns = 5\n" + "".join(head + text for text in texts))
    *four, vague = read_paper(tmp_path)[1]
    assert [c.label for c in four] == ["at 1, a", "at 1, b", "at 2, a", "at 2, b"]
    assert [c.where for c in four][2] == {"v": 2, "s": "a", "w": 3} and [c.sentence for c in four] == ["x", "", "", ""]
    assert [c.margin for c in four] == [1, 2, 3, 4]
    assert {c.runs for c in four} == {5} and vague.runs == 2 and all(c.test for c in four) and not vague.test


def test_predictions_are_held_against_the_runs(tmp_path):
    head = "what,quantity,where,low,high,expected,commit,run,held\n"
    rows = [
        "above,q,grains=1,11,,,abc,,",
        "about,q,grains=1,9,11,,abc,,",
        "larger,q,grains=7,9,11,,abc,,",
        "old,,,,,two,abc,three,no",
    ]
    (tmp_path / "predictions.csv").write_text(head + "\n".join(rows) + "\n")
    found = predictions(tmp_path, of_mean((10.0, 0.1)))
    assert [p["held"] for p in found] == ["no", "yes", "not run", "no"] and found[0]["expected"] == "at least 11"
    (tmp_path / "predictions.csv").write_text(head + "x,none,grains=1,1,,,abc,,\n")
    with pytest.raises(PaperError, match="no quantity none"):
        predictions(tmp_path, of_mean((10.0, 0.1)))


def test_what_is_no_number_is_a_dash():
    assert number_text(float("nan")) == "-"
