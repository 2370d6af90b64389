"""python3 -m analysis as a user runs it."""

import json
import re

import numpy as np
import pytest
from running import PYTHON, TOP, call, read_arrays
from written_runs import PAIR, PAIR_VELOCITY, change_arrays, seal

from analysis.figures.draw import figures_of
from analysis.report.rows import row
from analysis.runs.folder import open_run
from analysis.runs.format import CHANNELS
from analysis.theory import collide_pair

analyse = lambda *arguments: call(TOP, PYTHON, "-m", "analysis", *arguments)
KEYS = {"run", "d_max", "t_max", "restitution", "outcome", "largest_fragment", "energy_closure", *CHANNELS}


def test_json_of_one_run_is_an_object_of_several_a_list_in_their_order(pair_folder, cluster_folder):
    collision = collide_pair(PAIR_VELOCITY, PAIR)
    done = analyse("summary", "--json", pair_folder)
    numbers = json.loads(done.stdout)
    assert done.returncode == 0 and done.stderr == "" and KEYS <= set(numbers)
    assert numbers["run"] == str(pair_folder) and numbers["outcome"] == "bouncing" and numbers["largest_fragment"] == 1
    assert numbers["restitution"] == pytest.approx(collision.restitution, rel=1e-9)
    assert numbers["d_max"] == pytest.approx(collision.largest_overlap - 2e-7, rel=1e-6)
    assert 0.3 < numbers["t_max"] / collision.duration < 0.5
    assert numbers["energy_closure"] < 1e-9
    assert numbers["disconnection"] == pytest.approx(4 / 45 * 3.969e-17, rel=1e-4)
    done = analyse("summary", pair_folder, cluster_folder, "--json")
    runs = json.loads(done.stdout)
    assert [r["run"] for r in runs] == [str(pair_folder), str(cluster_folder)]
    assert runs[1]["outcome"] == "sticking" and runs[1]["growth_efficiency"] == 1.0


def test_the_table_has_units_every_channel_and_the_numbers_of_the_json(cluster_folder):
    done = analyse("summary", "--long", cluster_folder)
    words = "grain radii; closure; of K(0); rolling dissipation; bond breaking; sticking; (ended"
    assert done.returncode == 0 and all(text in done.stdout for text in words.split("; "))
    assert max(map(len, done.stdout.splitlines())) <= 120
    numbers = json.loads(analyse("summary", "--json", cluster_folder).stdout)
    shown = re.search(r"d_max +(\S+) m.*?t_max +(\S+) ns", done.stdout, re.S).groups()
    assert [float(text) for text in shown] == pytest.approx([numbers["d_max"], 1e9 * numbers["t_max"]], rel=1e-3, abs=0)


def test_a_broken_run_among_others_is_reported_and_the_others_printed(pair_folder, cluster_folder, tmp_path):
    done = analyse("summary", "--long", pair_folder, tmp_path / "none", cluster_folder)
    assert done.returncode == 2
    assert done.stderr == f"analysis: {tmp_path / 'none'}: no such folder\n"
    assert f"run {pair_folder}" in done.stdout and f"run {cluster_folder}" in done.stdout
    listed = analyse("summary", "--json", pair_folder, tmp_path / "none")
    assert listed.returncode == 2 and [r["run"] for r in json.loads(listed.stdout)] == [str(pair_folder)]


def change(run, names, to=np.zeros_like):
    """These arrays of a folder, to what a function makes of them."""
    for file in (run / "history.npz", *(run / "states").iterdir()):
        own = read_arrays(file)
        change_arrays(file, **{name: to(own[name]) for name in names & own.keys()})
    seal(run)


def test_an_unfinished_run_says_so(run):
    (run / "ended").unlink()
    done = analyse("summary", "--long", run)
    assert done.returncode == 0 and "NOT ENDED" in done.stdout
    assert json.loads(analyse("summary", "--json", run).stdout)["ended"] is False


def test_aggregates_that_never_met_have_that_outcome(run):
    change(run, {"contacts_between"})
    numbers = json.loads(analyse("summary", "--json", run).stdout)
    assert numbers["outcome"] == "never met" and numbers["restitution"] is None
    table = analyse("summary", "--long", run).stdout
    assert numbers["d_max"] is None and re.search(r"d_max +undefined: the aggregates have not met", table)
    assert re.search(r"outcome +never met", table) and re.search(r"restitution +none: never met", table)
    about = json.loads((run / "run.json").read_text())
    about["derived"]["firstTouch"] = 1e-12  # a graze, between two samples
    (run / "run.json").write_text(json.dumps(about))
    seal(run)
    assert json.loads(analyse("summary", "--json", run).stdout)["outcome"] == "bouncing"


def test_a_compression_is_of_equal_aggregates_and_a_bound_is_marked(run):
    assert open_run(run).history["d"].max() > open_run(run).history["d"][-1] and "motion" in figures_of(open_run(run))
    change(run, {"d"}, np.sort)  # it rises until the end
    largest = open_run(run).history["d"].max()
    assert f">={largest:.4g}" in analyse("summary", run).stdout
    change(run, {"radius"}, lambda radius: radius * [1.0, 0.98])
    assert "d_max                undefined: aggregates of unlike mass" in analyse("summary", "--long", run).stdout
    found = row(open_run(run))
    assert all(np.isnan(found[name]) for name in ("d_max", "t_max", "final_d", "final_v"))
    assert "motion" not in figures_of(open_run(run))


def test_a_run_at_rest_has_no_closure_and_no_restitution(run, tmp_path):
    change(run, {"kinetic", "velocity"})
    numbers = json.loads(analyse("summary", "--json", run).stdout)
    assert numbers["energy_closure"] is None and numbers["restitution"] is None
    told = analyse("summary", "--long", run).stdout
    assert "undefined" in told and "no velocity at the start" in told
    drawn = analyse("figures", run, "--out", tmp_path / "figures")
    assert drawn.returncode == 2 and "no kinetic energy at the start" in drawn.stderr


def test_figures_are_written_where_asked_and_a_place_that_cannot_be_written_is_one_line(cluster_folder, tmp_path):
    done = analyse("figures", cluster_folder, "--out", tmp_path / "new" / "place")
    assert done.returncode == 0 and done.stderr == ""
    names = [line.rsplit("/", 1)[1] for line in done.stdout.splitlines()]
    assert sorted(names) == ["energy.png", "forces.png", "grains.png", "motion.png"]
    assert all((tmp_path / "new" / "place" / name).read_bytes().startswith(b"\x89PNG") for name in names)
    (tmp_path / "taken").write_text("")
    for command in ("figures", "export"):
        done = analyse(command, cluster_folder, "--out", tmp_path / "taken")
        assert done.returncode == 2 and done.stderr == f"analysis: {tmp_path}/taken: is a file; must be a folder\n"
