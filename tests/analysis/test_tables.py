"""What the analysis is like in a notebook: names, examples, what a run shows; tables of runs, and as files."""

import doctest
import pickle
import pkgutil
import subprocess
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest
from refused import refused

import analysis
from analysis.report.rows import table
from analysis.runs.format import CHANNELS
from analysis.runs.table import Column, make_table, read_table, table_text

TOP = Path(__file__).resolve().parents[2]
COLUMNS = (Column("velocity", "m/s", "impact velocity"), Column("seed", "", "seed", kind="i"))
MODULES = [m.name for m in pkgutil.walk_packages(analysis.__path__, "analysis.") if m.name != "analysis.__main__"]


@pytest.fixture(scope="module")
def run(cluster_folder):
    return analysis.open_run(cluster_folder)


def test_public_names_are_documented_and_importing_the_package_loads_no_large_library():
    assert {"table", "plot", "outcome", "open_run"} < set(analysis.__all__) < set(dir(analysis))
    assert all(getattr(analysis, name).__doc__ for name in analysis.__all__)
    found = "import sys, analysis; print([m for m in ('numpy', 'scipy', 'pandas', 'matplotlib') if m in sys.modules])"
    done = subprocess.run(["/usr/bin/python3", "-c", found], cwd=TOP, capture_output=True, text=True)
    assert done.stdout == "[]\n", done.stderr


@pytest.mark.parametrize("name", MODULES)
def test_examples_in_docstrings(name):
    assert doctest.testmod(import_module(name)).failed == 0


def test_runs_and_states_are_a_few_lines_pickle_and_have_fragments(run):
    for thing in (run, run.last, run.states):
        text = repr(thing).replace(str(run.path), "")
        assert len(text.splitlines()) < 12 and max(map(len, text.splitlines())) < 300
    assert "velocity 1 m/s" in repr(run)
    copied, state = pickle.loads(pickle.dumps((run, run.last)))
    assert np.array_equal(copied.history["d"], run.history["d"]) and copied.parameters == run.parameters
    assert np.array_equal(state.position, copied.last.position)
    found, state = run.last.fragments(), run.last
    assert found.grains.sum() == len(state.radius) and found.mass_fraction.sum() == pytest.approx(1.0, rel=1e-12)
    assert (found.grains * found.coordination).sum() == 2 * len(state.contact_pairs)
    assert (found.grains * found.projectile_fraction).sum() == pytest.approx(np.sum(state.aggregate == 1), rel=1e-12)
    assert 0.2 < found.filling_factor[0] < 0.7 and found.attrs["units"]["gyration_radius"] == "m"


def test_a_table_has_a_row_a_run(run, pair_folder, tmp_path):
    (tmp_path / "logs").mkdir()
    for number, folder in enumerate((run.path, pair_folder)):
        (tmp_path / f"r{number}").symlink_to(folder)
    found = table(f"{tmp_path}/**")
    numbers = analysis.summarise(run)
    assert found.run.tolist() == ["r0", "r1"] and found.outcome.tolist() == ["sticking", "bouncing"]
    for name in ("largest_fragment", "growth_efficiency", "energy_closure", "d_max", *CHANNELS):
        assert found[name][0] == numbers[name], name
    assert found.filter(like="_at_end").sum(axis=1).tolist() == pytest.approx([1.0, 1.0], abs=0.02)
    piece = run.last.fragments().iloc[0]
    for name in ("filling_factor", "gyration_radius", "fractal_dimension", "coordination"):
        assert np.array_equal(found[f"largest_{name}"][0], piece[name], equal_nan=True)
    assert table([run, run, str(tmp_path), f"{tmp_path}/r*"]).run.tolist() == ["run", "r1"]  # each folder once


def test_what_was_written_is_read_back_and_what_is_no_table_is_one_line(tmp_path):
    """With names of any characters, saved by an editor that puts a mark of the encoding before it; versions 0.5 and 0.6
    put the text's sum into its head."""
    names, file = ["# s3", "a\u2028b", "c\x85d", "e\udcfff"], tmp_path / "runs.csv"
    table = make_table((tmp_path / name, {"velocity": 1 / 3, "seed": k}) for k, name in enumerate(names))
    text = table_text(table, COLUMNS, {"study": "own"})
    summed = text.replace("# {", f'# {{"sha256": "{64 * "0"}", ', 1)
    for written, encoding in ((text, "utf-8"), (summed, "utf-8-sig")):
        file.write_text(written, encoding=encoding)
        again, head = read_table(file, COLUMNS)
        assert list(again.run) == list(table.run) and again.run[0] == "# s3" and head["study"] == "own"
        assert list(again.velocity) == [1 / 3] * 4 and list(again.seed) == [0, 1, 2, 3]
    for before, after, words in (("seed\n", "velocity\n", "velocity 2 times"), ('"own"', "[" * 100_000, "not a table")):
        file.write_text(text.replace(before, after))
        with refused(ValueError, words):
            read_table(file, COLUMNS)
