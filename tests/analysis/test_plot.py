"""Figures of a table of runs: what is counted, what errors bars have, what is refused."""

import pandas
import pytest
from made_compressions import made_compression

from analysis.__main__ import main
from analysis.report.rows import table
from analysis.studies.plot import CannotPlot, plot

ENDS = {1.0: ("sticking", "sticking", "bouncing", "undecided"), 3.0: ("fragmentation",) * 3 + ("sticking",)}


@pytest.fixture
def runs():
    """A table of eight runs at two velocities, in the form of analysis.table."""
    cells = [(velocity, seed, outcome) for velocity, own in ENDS.items() for seed, outcome in enumerate(own)]
    found = pandas.DataFrame(cells, columns=["velocity", "seed", "outcome"])
    found = found.assign(run="", kind="collision", impact=0.5, ended=True)
    found = found.assign(largest_fraction=[0.9, 0.7, 0.5, 0.3, 0.4, 0.2, 0.2, 0.0])
    found.attrs.update(units={"velocity": "m/s", "largest_fraction": "1"}, parameters=["velocity", "seed", "impact"])
    return found


def drawn(figure):
    """([(x, y)], [(low, high)]) of the first curve, and all that is written."""
    (axes,) = figure.axes
    bars = axes.collections[0].get_segments()
    texts = [figure._suptitle.get_text(), axes.get_title(), axes.get_xlabel(), axes.get_ylabel()]
    text = " | ".join(texts).replace("\n", " ")
    return list(zip(*axes.lines[0].get_data())), [tuple(bar[:, 1]) for bar in bars], text


def test_undecided_runs_and_those_that_never_met_are_left_out_of_fractions_and_counted(runs):
    points, bars, text = drawn(plot("sticking", runs))
    assert points == [(1.0, pytest.approx(3 / 5)), (3.0, pytest.approx(2 / 6))]
    assert 0.5 * (bars[0][1] - bars[0][0]) == pytest.approx((0.6 * 0.4 / 3) ** 0.5)
    assert "7 runs of 4 pairs, 1 left out" in text and "[m/s]" in text
    missed = pandas.concat([runs, runs[:1].assign(seed=9, outcome="never met")], ignore_index=True)
    missed.attrs = runs.attrs
    *same, text = drawn(plot("sticking", missed))
    assert same == [points, bars] and "7 runs of 4 pairs, 2 left out" in text


def test_a_mean_has_the_standard_error_of_its_pairs_which_files_tell_apart_too(runs):
    points, bars, _ = drawn(plot("largest", runs))
    assert points == [(1.0, pytest.approx(0.6, rel=1e-12)), (3.0, pytest.approx(0.2, rel=1e-12))]
    assert 0.5 * (bars[0][1] - bars[0][0]) == pytest.approx(runs.largest_fraction[:4].std() / 2, rel=1e-12)
    of_files = runs.assign(seed=1, file=[f"a{seed}.npz" for seed in runs.seed])
    of_files.attrs = {**runs.attrs, "parameters": [*runs.attrs["parameters"], "file"]}
    assert drawn(plot("largest", of_files))[:2] == (points, bars)


def test_runs_that_cannot_be_drawn_are_left_out_and_counted(runs):
    cells = {"run": "", "kind": "compression", "ended": True, "seed": [1, 2], "finalFilling": [0.3, 0.4], "time": 1.0}
    both = pandas.concat([runs.assign(time=2.0), pandas.DataFrame(cells)], ignore_index=True)
    both.attrs = {**runs.attrs, "parameters": [*runs.attrs["parameters"], "finalFilling"]}
    assert drawn(plot("sticking", both))[:2] == drawn(plot("sticking", runs))[:2]
    assert drawn(plot("time", both, x="finalFilling"))[0] == [(0.3, 1.0), (0.4, 1.0)]
    ends = runs.assign(d_max=[9.0, *[1.0] * 7], maximum_inside=[False, *[True] * 7])
    points, _, text = drawn(plot("d_max", ends))
    assert [y for _, y in points] == [1.0, 1.0] and "7 runs of 4 pairs, 1 left out" in text


def test_energies_of_compressions_are_parts_of_the_work_of_the_boundaries(tmp_path):
    for seed in (1, 2):
        made_compression(tmp_path / str(seed), seed, lambda filling: 4.7e5 * filling**3, initialFilling=0.002 * seed)
    found = table(tmp_path)
    assert len(plot("energy", found, x="strainRate").axes[0].lines) > 3
    lost = (found.rollingDissipation_at_end + found.twistingDissipation_at_end).tolist()
    assert lost == pytest.approx((-found.boundaryWork_at_end).tolist(), rel=1e-6) and lost[0] == pytest.approx(1.0)


@pytest.mark.parametrize(
    "how, words",
    [
        ({"what": "stiking"}, "did you mean sticking"),
        ({"what": "largest", "x": "outcome"}, "outcome: holds words"),
        ({"by": "velocity"}, "by = velocity: must be another column"),
        ({"where": {"velocity": 1000}}, "where velocity = 1000: no run is left"),
        ({"where": {"velocity": "fast"}}, "where velocity = fast: must be a number"),
        ({"logarithmic": "z"}, "logarithmic = z"),
    ],
)
def test_what_cannot_be_drawn_is_refused_in_one_line(runs, how, words):
    with pytest.raises(CannotPlot, match=f"^[^\n]*{words}[^\n]*$"):
        plot(**{"what": "sticking", "runs": runs, **how})


def test_runs_that_differ_in_something_else_are_refused_unless_it_follows_from_what_is_drawn(runs):
    with pytest.raises(CannotPlot, match=r"^the runs differ in impact too: .* \(impact is 0, 0.5\)$"):
        plot("sticking", runs.assign(impact=[0.0] + [0.5] * 7))
    grown = runs.assign(grains=[16, 30] * 4, projectileGrains=[16, 30] * 4)
    grown.attrs = {**runs.attrs, "parameters": [*runs.attrs["parameters"], "grains", "projectileGrains"]}
    assert len(plot("largest", grown, by="grains").axes[0].get_legend_handles_labels()[1]) == 2
    chosen = runs.assign(stepFraction=0.05 * runs.velocity, tolerance=1e-4)
    chosen.attrs = {**runs.attrs, "parameters": [*runs.attrs["parameters"], "stepFraction", "tolerance"]}
    assert "8 runs" in drawn(plot("largest", chosen))[2]


def test_a_pair_that_ran_twice_is_no_fraction(runs):
    with pytest.raises(CannotPlot, match="a pair has several runs"):
        plot("sticking", pandas.concat([runs, runs[:1]]).assign(run="again"))


def test_the_command_writes_a_picture_and_prints_its_path_last(cluster_folder, tmp_path, capsys):
    file, again = tmp_path / "new" / "a.png", ["--where", "velocity=3"]
    command = ["plot", "energy", str(cluster_folder), "--where", "velocity=1", "--out", str(file)]
    assert main([*command, *again]) == 2 and "must be given once" in capsys.readouterr().err and not file.exists()
    assert main(command) == 0
    assert capsys.readouterr().out.splitlines()[-1] == str(file) and file.read_bytes().startswith(b"\x89PNG")
