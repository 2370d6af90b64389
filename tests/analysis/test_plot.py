"""Figures of a table of runs: what is counted, what is said, what is refused."""

from io import StringIO

import pandas
import pytest
from made_compressions import made_compression

from analysis import exact_interval
from analysis.__main__ import main
from analysis.report.plot import CannotPlot, plot
from analysis.report.rows import table

ENDS = {
    1.0: ("sticking", "sticking", "bouncing", "undecided: still moving"),
    3.0: ("fragmentation",) * 3 + ("sticking",),
}


@pytest.fixture
def runs():
    """A table of eight runs at two velocities, in the form of analysis.table."""
    cells = [(velocity, seed, outcome) for velocity, own in ENDS.items() for seed, outcome in enumerate(own)]
    found = pandas.DataFrame(cells, columns=["velocity", "seed", "outcome"]).assign(
        run="", kind="collision", impact=0.5, ended=True
    )
    found = found.assign(largest_fraction=[0.9, 0.7, 0.5, 0.3, 0.4, 0.2, 0.2, 0.0])
    found.attrs.update(units={"velocity": "m/s", "largest_fraction": "1"}, parameters=["velocity", "seed", "impact"])
    return found


def drawn(figure):
    """([(x, y)], [(low, high)]) of the first curve, and all that is written."""
    (axes,) = figure.axes
    bars = axes.collections[0].get_segments()
    texts = [figure._suptitle.get_text(), axes.get_title(), axes.get_xlabel(), axes.get_ylabel()]
    said = " | ".join(texts).replace("\n", " ")
    return list(zip(*axes.lines[0].get_data())), [tuple(bar[:, 1]) for bar in bars], said


def test_undecided_runs_count_either_way_in_the_bars_and_not_in_the_points(runs):
    points, bars, said = drawn(plot("sticking", runs))
    assert points == [(1.0, pytest.approx(2 / 3, rel=1e-12)), (3.0, 0.25)]
    assert bars[0] == pytest.approx((exact_interval(2, 4)[0], exact_interval(3, 4)[1]), rel=1e-12)
    assert bars[1] == pytest.approx(exact_interval(1, 4), rel=1e-12)
    assert "8 runs, 1 of them undecided or not ended (in the bars, counted either way)" in said
    assert "3 to 4 pairs" in said and "[m/s]" in said
    missed = pandas.concat([runs, runs[:1].assign(seed=9, outcome="never met")], ignore_index=True)
    missed.attrs = runs.attrs
    figure = plot("sticking", missed)
    *same, said = drawn(figure)
    assert same == [points, bars] and "9 runs, 1 that never met left out, 1 of them undecided" in said
    title = figure._suptitle.get_window_extent()
    assert 0 <= title.x0 and title.x1 <= figure.bbox.x1
    assert "9 runs, 1 of them never met, 1 of them undecided" in drawn(plot("largest", missed))[2]


def test_pairs_are_told_by_their_files(runs):
    """Aggregates from files have one seed."""
    of_files = runs.assign(seed=1, file=[f"a{seed}.npz" for seed in runs.seed], projectileFile="b.npz")
    of_files.attrs = {**runs.attrs, "parameters": [*runs.attrs["parameters"], "file", "projectileFile"]}
    for what in ("sticking", "largest"):
        points, bars, said = drawn(plot(what, of_files))
        assert points == drawn(plot(what, runs))[0] and bars[0][0] < bars[0][1] and "4 pairs" in said
    assert len(plot("largest", of_files, by="file").axes[0].get_legend_handles_labels()[1]) == 4


def test_what_follows_from_what_is_drawn_apart_needs_no_choice(runs):
    """The ratio of sizes, where it is one, and the projectile's grains, where both have as many."""
    grown = runs.assign(grains=[16, 30] * 4, projectileGrains=[16, 30] * 4)
    grown.attrs = {**runs.attrs, "parameters": [*runs.attrs["parameters"], "grains", "projectileGrains"]}
    assert len(plot("largest", grown, by="grains").axes[0].get_legend_handles_labels()[1]) == 2
    sizes = runs.assign(sizes=["two", "equal"] * 4, sizeRatio=[3.0, None] * 4)
    sizes.attrs = {**runs.attrs, "parameters": [*runs.attrs["parameters"], "sizes", "sizeRatio"]}
    assert len(plot("largest", sizes, by="sizes").axes[0].get_legend_handles_labels()[1]) == 2
    sizes.loc[0, "sizeRatio"] = 2.0
    with pytest.raises(CannotPlot, match="^the runs differ in sizeRatio too"):
        plot("largest", sizes, by="sizes")


def test_runs_of_a_kind_without_what_is_drawn_are_left_out(runs):
    cells = {"run": "", "kind": "compression", "ended": True, "seed": [1, 2], "finalFilling": [0.3, 0.4], "time": 1.0}
    both = pandas.concat([runs.assign(time=2.0), pandas.DataFrame(cells)], ignore_index=True)
    both.attrs = {**runs.attrs, "parameters": [*runs.attrs["parameters"], "finalFilling"]}
    *same, said = drawn(plot("sticking", both))
    assert (
        same == list(drawn(plot("sticking", runs))[:2]) and "8 runs, 2 of the kind compression left out, 1 of" in said
    )
    assert drawn(plot("time", both, x="finalFilling"))[0] == [(0.3, 1.0), (0.4, 1.0)]
    with pytest.raises(CannotPlot, match="^the runs are of the kinds collision, compression: choose where kind$"):
        plot("time", both, x="seed")


def test_compressions_of_several_clusters(tmp_path):
    """Each starts from a filling of its own; energies are over the boundaries' work; of a stretched one the strength is told."""
    pressure = lambda filling: 4.7e5 * filling**3
    for seed in (1, 2):
        made_compression(
            tmp_path / str(seed), seed, pressure, low=0.002 * seed, initialFilling=0.002 * seed, stretched=True
        )
    found = table(tmp_path)
    assert len(plot("energy", found, x="strainRate").axes[0].lines) > 3
    assert "2 runs" in drawn(plot("final_filling", found, x="strainRate"))[2]
    lost = (found.rollingDissipation_at_end + found.twistingDissipation_at_end).tolist()
    assert lost == pytest.approx((-found.boundaryWork_at_end).tolist(), rel=1e-6) and lost[0] == pytest.approx(1.0)
    assert (found.tensile_strength > 1e4).all() and (found.tensile_filling > 0.4).all()


def test_runs_that_cannot_be_drawn_are_counted(runs):
    """Without a value in what tells curves apart, and bounds of d_max; what a table from a file differs in is told too."""
    ends = runs.assign(d_max=1.0, maximum_inside=[False, *[True] * 7], finalPressure=[None, *[5.0] * 7])
    ends.attrs = {**runs.attrs, "parameters": [*runs.attrs["parameters"], "finalPressure"]}
    *_, said = drawn(plot("sticking", ends, by="finalPressure"))
    assert "7 runs, 1 without finalPressure left out" in said
    ends.loc[0, ["d_max", "finalPressure"]] = 9.0, 5.0
    points, _, said = drawn(plot("d_max", ends))
    assert [y for _, y in points] == [1.0, 1.0] and "7 runs, 1 whose d_max is only a bound left out" in said
    assert "1 whose d_max is only a bound left out" in drawn(plot("largest", ends, x="d_max"))[2]
    *_, said = drawn(plot("restitution", ends.assign(restitution=[None, *[0.5] * 7])))
    assert "7 runs, 1 without restitution left out" in said
    twice = pandas.concat([ends, ends[:2].assign(kind="compression", seed=9)]).assign(
        restitution=[0.5] * 8 + [None] * 2
    )
    twice.attrs = ends.attrs
    assert "2 of the kind compression left out" in drawn(plot("restitution", twice))[2]
    columns = ["run", *ends.attrs["parameters"], "kind", "outcome", "ended", "largest_fraction"]
    again = pandas.read_csv(StringIO(ends.assign(impact=[0.0, 0.5] * 4)[columns].to_csv()))
    with pytest.raises(CannotPlot, match="^the runs differ in impact too"):
        plot("largest", again)


def test_equal_curves_stand_beside_each_other(runs):
    both = pandas.concat([runs.assign(impact=impact, run=runs.run + str(impact)) for impact in (0.0, 0.5)])
    both.attrs = runs.attrs
    (axes,) = plot("sticking", both, by="impact").axes
    joined, others = (next(line for line in axes.lines if line.get_linestyle() == style) for style in ("-", "--"))
    assert joined.get_xydata().tolist() == others.get_xydata().tolist()
    shift = others.get_transform().transform((1.0, 0.5)) - joined.get_transform().transform((1.0, 0.5))
    assert shift.tolist() == pytest.approx([5.0 * axes.figure.dpi / 72, 0.0], abs=1e-6)


def test_a_mean_has_the_error_of_its_pairs(runs):
    points, bars, _ = drawn(plot("largest", runs))
    assert points == [(1.0, pytest.approx(0.6, rel=1e-12)), (3.0, pytest.approx(0.2, rel=1e-12))]
    spread = runs.largest_fraction[:4].std() / 2
    assert 0.5 * (bars[0][1] - bars[0][0]) == pytest.approx(spread, rel=0.1)  # by bootstrap


def test_what_cannot_be_drawn_is_refused_in_one_line(runs):
    runs.loc[0, "impact"] = 0.0
    with pytest.raises(CannotPlot, match=r"^the runs differ in impact too: .* \(impact is 0, 0.5\)$"):
        plot("sticking", runs)
    with pytest.raises(CannotPlot, match="by = velocity: must be another column"):
        plot("sticking", runs, by="velocity")
    runs.loc[1, "ended"] = False
    assert "7 runs, 2 of them undecided or" in drawn(plot("sticking", runs, where={"impact": 0.5}))[2]
    assert "6 runs, 1 of them undecided" in drawn(plot("largest", runs, where={"impact": 0.5, "ended": True}))[2]


def test_steps_that_were_chosen_by_their_error_need_no_choice(runs):
    chosen = runs.assign(stepFraction=0.05 * runs.velocity, tolerance=1e-4, unusual=1)
    chosen.attrs = {**runs.attrs, "parameters": [*runs.attrs["parameters"], "stepFraction", "tolerance"]}
    assert "8 runs" in drawn(plot("largest", chosen))[2]
    with pytest.raises(CannotPlot, match="^the runs differ in stepFraction too"):
        plot("largest", chosen.assign(tolerance=None, stepFraction=[0.1, 0.2] * 4))


@pytest.mark.parametrize(
    "what, x", [("sticking", "velocity"), ("energy", "velocity"), ("fragments", "largest_filling_factor")]
)
def test_the_command_writes_a_picture_and_prints_its_path_last(cluster_folder, tmp_path, capsys, what, x):
    file = tmp_path / "new" / "a.png"
    assert main(["plot", what, str(cluster_folder), "--x", x, "--where", "velocity=1", "--out", str(file)]) == 0
    assert capsys.readouterr().out.splitlines()[-1] == str(file) and file.read_bytes().startswith(b"\x89PNG")


def test_a_column_is_chosen_once(cluster_folder, tmp_path, capsys):
    file = tmp_path / "a.png"
    twice = ["--where", "velocity=1", "--where", "velocity=3"]
    assert main(["plot", "largest", str(cluster_folder), *twice, "--out", str(file)]) == 2
    assert "--where: must be given once for a column" in capsys.readouterr().err and not file.exists()
