"""python3 -m analysis as a user runs it."""

import json
import re

import numpy as np
import pytest
from running import PYTHON, TOP, call, read_arrays
from written_runs import PAIR, PAIR_VELOCITY, change_arrays, seal

from analysis.__main__ import main
from analysis.figures.draw import figures_of
from analysis.runs.folder import open_run
from analysis.runs.format import CHANNELS
from analysis.theory import collide_pair


@pytest.fixture
def analyse(capsys):
    """analyse(*arguments): exit status, stdout and stderr of a command, in this process."""

    def of(*arguments):
        status = main(list(map(str, arguments)))
        return status, *capsys.readouterr()

    return of


@pytest.fixture
def summary(analyse):
    return lambda run: json.loads(analyse("summary", "--json", run)[1])


def test_a_command_is_a_process_with_an_exit_status(pair_folder, tmp_path):
    done = call(TOP, PYTHON, "-m", "analysis", "summary", "--long", pair_folder, tmp_path / "none")
    assert done.returncode == 2 and done.stderr == f"analysis: {tmp_path / 'none'}: no such folder\n"
    assert f"run {pair_folder}" in done.stdout


def change(run, names, to=np.zeros_like):
    """These arrays of a folder, to what a function makes of them."""
    for file in (run / "history.npz", *(run / "states").iterdir()):
        own = read_arrays(file)
        change_arrays(file, **{name: to(own[name]) for name in names & own.keys()})
    seal(run)


def test_json_of_one_run_is_an_object_of_several_a_list_and_its_numbers_are_those_of_theory(
    analyse, summary, pair_folder, cluster_folder
):
    collision, numbers = collide_pair(PAIR_VELOCITY, PAIR), summary(pair_folder)
    keys = {"d_max", "t_max", "restitution", "outcome", "largest_fragment", "energy_closure", *CHANNELS}
    assert keys <= set(numbers) and numbers["run"] == str(pair_folder) and numbers["outcome"] == "bouncing"
    assert numbers["restitution"] == pytest.approx(collision.restitution, rel=1e-9)
    assert numbers["d_max"] == pytest.approx(collision.largest_overlap - 2e-7, rel=1e-6)
    assert 0.3 < numbers["t_max"] / collision.duration < 0.5 and numbers["energy_closure"] < 1e-9
    assert numbers["disconnection"] == pytest.approx(4 / 45 * 3.969e-17, rel=1e-4)
    runs = json.loads(analyse("summary", pair_folder, cluster_folder, "--json")[1])
    assert runs[0] == numbers and runs[1]["outcome"] == "sticking" and runs[1]["growth_efficiency"] == 1.0


def test_the_table_has_units_every_channel_and_the_numbers_of_the_json(analyse, summary, cluster_folder):
    (status, text, _), numbers = analyse("summary", "--long", cluster_folder), summary(cluster_folder)
    words = "compression length; closure; of K(0); rolling dissipation; bond breaking; sticking; (ended"
    assert status == 0 and all(word in text for word in words.split("; "))
    shown = re.search(r"d_max +(\S+) m.*?t_max +(\S+) s", text, re.S).groups()
    assert [float(word) for word in shown] == pytest.approx([numbers["d_max"], numbers["t_max"]], rel=1e-3, abs=0)


def test_aggregates_that_never_met_have_that_outcome_and_no_d_max(analyse, summary, run):
    change(run, {"contacts_between", "kinetic"})
    (run / "ended").unlink()
    numbers = summary(run)
    assert numbers["ended"] is False and "NOT ENDED" in analyse("summary", "--long", run)[1]
    assert numbers["outcome"] == "never met" and numbers["restitution"] is None and numbers["d_max"] is None
    assert numbers["energy_closure"] is None and analyse("figures", run)[0] == 2  # nothing moves at the start


def test_a_d_max_that_is_but_a_bound_is_marked_and_unlike_aggregates_have_none(analyse, run):
    change(run, {"d"}, np.sort)  # it rises until the end
    change(run, {"v"}, np.abs)
    assert f">={read_arrays(run / 'history.npz')['d'].max():.4g}" in analyse("summary", run)[1]
    change(run, {"radius"}, lambda radius: radius * [1.0, 0.98])
    assert "  d_max" not in analyse("summary", "--long", run)[1]
    assert "motion.png" not in analyse("figures", run)[1]


def test_figures_are_written_and_a_place_that_cannot_be_written_is_one_line(analyse, cluster_folder, tmp_path):
    status, text, error = analyse("figures", cluster_folder, "--out", tmp_path / "new" / "place")
    assert status == 0 and error == ""
    names = [line.rsplit("/", 1)[1] for line in text.splitlines()]
    assert names == [f"{name}.png" for name in figures_of(open_run(cluster_folder))] and len(names) > 3
    assert all((tmp_path / "new" / "place" / name).read_bytes().startswith(b"\x89PNG") for name in names)
    (tmp_path / "taken").write_text("")
    status, _, error = analyse("figures", cluster_folder, "--out", tmp_path / "taken")
    assert status == 2 and error == f"analysis: {tmp_path}/taken: is a file; must be a folder\n"
