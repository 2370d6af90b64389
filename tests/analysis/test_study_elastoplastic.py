"""python3 -m analysis study elastoplastic as a user runs it: on made-up run folders, and on small real
collisions."""

import io
import json
import shutil
import subprocess
import warnings
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pandas
import pytest
from made_collisions import MODULI, line_of, made_run
from same_answer import differences, image_difference
from written_runs import RADIUS

from analysis.__main__ import main
from analysis.measures.compression import first_compression
from analysis.runs.format import CHANNELS
from analysis.runs.table import read_table
from analysis.statistics import wilson
from analysis.studies.collision_points import at_end, at_maximum, at_return
from analysis.studies.elastoplastic.comparison import LEGEND
from analysis.studies.elastoplastic.measure import COLUMNS

TOP = Path(__file__).resolve().parents[2]
VELOCITIES = [10 ** (0.1 * i) for i in (1, 3, 5, 7)]
NUMBERS = {"c1": "c1", "c2": "c2", "offset": "delta_offset", "ratio": "delta_max/R*"}


def analyse(*arguments):
    """What the command line gives, in this process: starting Python for each call would take longer than the call."""
    out, err = io.StringIO(), io.StringIO()
    with redirect_stdout(out), redirect_stderr(err), warnings.catch_warnings():
        warnings.simplefilter("error", RuntimeWarning)
        status = main(["study", "elastoplastic", *map(str, arguments)])
    return SimpleNamespace(returncode=status, stdout=out.getvalue(), stderr=err.getvalue())


@pytest.fixture(scope="module")
def runs(tmp_path_factory):
    """Folder of three sizes at 10^0.5 m/s with four seeds and four velocities at one size, in two levels;
    seed 1 sticks. Shifts of d scatter by 0.1 r around 0; compressions and times by 2 %, but not in the
    mean."""
    folder, random = tmp_path_factory.mktemp("elastoplastic"), np.random.default_rng(21)
    for size in (40.0, 60.0, 80.0):
        for velocity in VELOCITIES if size == 80.0 else [10**0.5]:
            for seed, stretch in enumerate((1.02, 0.98, 1.01, 0.99), start=1):
                made_run(
                    folder / "table" / f"R{size:g}-v{velocity:.3f}-s{seed}",
                    size,
                    velocity,
                    seed,
                    0.1 * random.normal(),
                    sticks=seed == 1,
                    stretch=stretch,
                )
    return folder


@pytest.fixture(scope="module")
def gallery(tmp_path_factory):
    return tmp_path_factory.mktemp("figures") / "new" / "gallery"


@pytest.fixture(scope="module")
def answer(runs, gallery):
    done = analyse(runs, "--json", "--figures", gallery)
    assert done.returncode == 0 and done.stderr == "", done.stderr
    return json.loads(done.stdout)


def lines(answer, heading):
    return {
        line["quantity"]: line
        for section in answer["sections"]
        if heading in section["heading"]
        for line in section["rows"]
    }


def points(answer):
    """Rows of the table of outcomes, with those of the energy by outcome."""
    (ends,) = (s["rows"] for s in answer["sections"] if s["heading"] == "how collisions end")
    (energy,) = (s["rows"] for s in answer["sections"] if s["heading"] == "where the energy goes")
    found = []
    for row in ends:
        own = [e for e in energy if (e["radius"], e["velocity"]) == (row["radius"], row["velocity"])]
        assert {e["outcome"]: e["seeds"] for e in own} == row["outcomes"]
        found.append({**row, "energy": {e["outcome"]: e for e in own}})
    assert sum(len(row["energy"]) for row in found) == len(energy)
    return found


def rows(folder):
    """Rows of the table of runs as dicts."""
    return read_table(folder / "runs.csv", COLUMNS)[0].to_dict("records")


def rows_of(folder):
    """{seed: row} of the table of the runs in a folder."""
    table = pandas.read_csv(io.StringIO(analyse(*folder.iterdir(), "--format", "csv").stdout), comment="#")
    return {row["seed"]: row for row in table.to_dict("records")}


def test_the_truth_is_recovered_within_the_stated_errors(answer):
    """Five standard errors: with four seeds (t(3) a point, pooled) a chance of some per mille."""
    size, truth = lines(answer, "size dependence"), line_of()
    for name, quantity in NUMBERS.items():
        line = size[quantity]
        assert abs(line["ours"] - truth[name]) < 5 * line["error"]
        assert line["difference"] == pytest.approx((line["ours"] - line["paper"]) / line["error"])
        assert abs(line["combined_difference"]) < abs(line["difference"])
    # The shifts are those of d(0), so without them the truth is met to the time between samples.
    assert size["delta_max/R*, d_max less d(0) + 2 r"]["ours"] == pytest.approx(truth["ratio"], rel=1e-3)
    moduli = lines(answer, "yield stress")
    for name, true in zip(("sigma_plastic", "E*"), MODULI):
        assert abs(moduli[name]["ours"] - true / 1e6) < 5 * moduli[name]["error"]


def test_rows_points_and_ledger(answer, gallery):
    runs = rows(gallery)
    assert answer["provenance"]["runs"] == len(runs) == 24 and answer["remarks"] == []
    for row in runs:
        assert row["closure"] < 1e-12 and "/" not in row["run"] and not row["exceeded"]
        assert row["label_d_max"] == pytest.approx(row["d_max"]) and row["coordination"] == 1.0
        assert sum(row[at_end(c)] for c in CHANNELS) == pytest.approx(1.0)
        assert (row["outcome"], row["restitution"] == 0.0) == (
            ("sticking", True) if row["seed"] == 1 else ("bouncing", False)
        )
        # Spheres that bounce part fastest at the end of their contact, and keep that speed.
        if row["outcome"] == "bouncing":
            assert row["return_speed"] / row["velocity"] == pytest.approx(row["restitution"], rel=0.01)
        assert row["return_time"] > row["t_max"] and sum(row[at_return(c)] for c in CHANNELS) == pytest.approx(1.0)
    (back,) = (section["rows"] for section in answer["sections"] if section["heading"] == "what comes back")
    assert sum(row["seeds"] for row in back) == 24
    assert len(points(answer)) == 6
    for point in points(answer):
        low, high, lowest, highest = point["sticking"]
        assert low == high == 0.25 and lowest < 0.25 < highest and set(point["energy"]) == {"sticking", "bouncing"}
        for energy in point["energy"].values():
            assert energy["compression"]["kinetic"][0] == pytest.approx(-1.0, abs=1e-3)
        assert point["restitution"][0] == pytest.approx((0.75 * point["bulk"][0]) ** 0.5, rel=0.01)
        assert point["restitution"][2] < point["restitution"][0] == point["restitution"][1] < point["restitution"][3]


def test_runs_that_still_part_at_the_end_are_undecided(tmp_path):
    for seed in (1, 2, 3):
        made_run(tmp_path / f"s{seed}", 80.0, 10**0.5, seed, 0.0, sticks=True, settles=seed != 3)
    (point,) = points(json.loads(analyse("--json", *tmp_path.iterdir()).stdout))
    assert point["outcomes"] == {"sticking": 2, "undecided": 1}
    assert point["sticking"] == [2 / 3, 1.0, wilson(2, 3)[0], 1.0]
    # The undecided one may yet bounce, with what is left of its speed.
    parting = rows_of(tmp_path)[3]["bulk"] ** 0.5
    assert point["restitution"][:2] == [0.0, pytest.approx(parting / 3)] and parting > 0.2
    for path in tmp_path.iterdir():
        if path.name != "s3":
            shutil.rmtree(path)
    (point,) = points(json.loads(analyse("--json", *tmp_path.iterdir()).stdout))
    assert point["outcomes"] == {"undecided": 1} and point["restitution"] == [0.0, pytest.approx(parting), None, None]
    assert point["sticking"] == [0.0, 1.0, 0.0, 1.0]


def test_text_names_everything(runs):
    done = analyse(*(runs / "table").glob("R80*-s[12]"))
    assert done.returncode == 0 and done.stderr == "", done.stderr
    for text in (
        *LEGEND,
        "8 runs",
        "sigma_plastic [MPa]",
        "sticking probability",
        "slid. diss.",
        "not fitted: only one size, R = 80 r",
        "delta_offset = 0.271 r (A24's, since one size gives none)",
    ):
        assert text in done.stdout
    assert max(map(len, done.stdout.splitlines())) < 250


def test_gallery(runs, gallery, answer):
    drawn = {file.name for file in gallery.glob("*.png")}
    assert drawn == {
        f"{name}.png"
        for name in (
            "fig03_snapshots",
            "fig04_motion",
            "fig05_size",
            "fig07_time",
            "fig08_velocity",
            "fig10_moduli",
            "fig11_strength",
            "fig12_andrews",
            "fig13_forces",
            "outcome",
            "returned",
            "energy_velocity",
            "energy_size",
            "start_offset",
        )
    }
    assert all((gallery / name).read_bytes().startswith(b"\x89PNG") for name in drawn)
    vector = {file.stem for file in gallery.glob("*.pdf")}
    assert vector == {Path(name).stem for name in drawn} - {"fig03_snapshots", "fig13_forces"}
    assert all((gallery / f"{name}.pdf").read_bytes().startswith(b"%PDF") for name in vector)
    page = (gallery / "comparison.md").read_text()
    assert all(f"({name})" in page for name in drawn) and str(runs) not in page
    assert json.loads((gallery / "comparison.json").read_text()) == answer


def test_the_table_of_runs_gives_the_same_comparison_and_figures(gallery, answer, tmp_path):
    """In the same folder: what needs the run folders stays as it is, all else comes out again, to rounding."""
    folder = shutil.copytree(gallery, tmp_path / "gallery")
    again = analyse(folder / "runs.csv", "--json", "--figures", folder)
    assert again.returncode == 0 and differences(json.loads(again.stdout), answer) == []
    assert again.stderr.splitlines() == [
        f"analysis: {name}: not drawn: it needs the run folders, a table has only their numbers"
        for name in ("fig03_snapshots", "fig04_motion", "fig12_andrews", "fig13_forces")
    ]
    assert {file.name for file in folder.iterdir()} == {file.name for file in gallery.iterdir()}
    assert (folder / "runs.csv").read_text() == (gallery / "runs.csv").read_text()
    apart = {file.name: image_difference(file, gallery / file.name) for file in folder.glob("*.png")}
    assert len(apart) == len(list(gallery.glob("*.png"))) and max(apart.values()) < 2e-3, apart


def test_formats(gallery):
    assert analyse(gallery / "runs.csv", "--format", "csv").stdout == (gallery / "runs.csv").read_text()
    page = analyse(gallery / "runs.csv", "--format", "markdown").stdout
    assert (gallery / "comparison.md").read_text().startswith(page.rstrip())


def test_runs_and_tables_together(runs, gallery, tmp_path):
    """Runs that a table has already are left out; new ones are added."""
    new = made_run(tmp_path / "new", 80.0, 10**0.5, 9, 0.0)
    old = next(iter((runs / "table").iterdir()))
    done = analyse(gallery / "runs.csv", new, old, "--json")
    assert done.returncode == 0 and json.loads(done.stdout)["provenance"]["runs"] == 25
    assert done.stderr.count("\n") == 1 and f"runs.csv, {old.name}, left out" in done.stderr


BAD_TABLES = {
    "no head": (lambda text: text.split("\n", 1)[1], "not a table of runs"),
    "another study": (lambda text: text.replace('"elastoplastic"', '"viscous"'), "of the study viscous: must be of"),
    "lost column": (lambda text: text.replace(",d_max,", ",dmax,"), "lacks the column d_max"),
    "twice": (
        lambda text: text.replace('"runs": 24', '"runs": 25') + text.splitlines()[-1] + "\n",
        "two runs have the same filling, radius, velocity and seed",
    ),
    "cut": (lambda text: text[: text.rindex("\n", 0, -1) + 1], "says that it holds 24 runs, it holds 23"),
    "cut within a row": (lambda text: text[:-20], "has no value in row 24"),
    "words for numbers": (lambda text: text.replace(",1e-07,", ",small,"), "'grain_radius' must be numbers"),
    "binary": (lambda text: "\0\0", "not a table of runs"),
}


@pytest.mark.parametrize("damage", BAD_TABLES)
def test_a_table_that_is_none_is_one_line(gallery, tmp_path, damage):
    spoil, message = BAD_TABLES[damage]
    (tmp_path / "runs.csv").write_text(spoil((gallery / "runs.csv").read_text()))
    done = analyse(tmp_path / "runs.csv")
    assert (done.returncode, done.stdout, done.stderr.count("\n")) == (2, "", 1) and message in done.stderr


def test_what_does_not_belong_is_left_out_with_a_note(runs, tmp_path):
    made_run(tmp_path / "a" / "late", 40.0, 3.0, 1, 0.0, ended=False)
    made_run(tmp_path / "a" / "oblique", 40.0, 3.0, 2, 0.0, impact=0.5)
    made_run(tmp_path / "a" / "good", 40.0, 3.0, 3, 0.0)
    made_run(tmp_path / "b" / "again", 40.0, 3.0, 3, 0.0)
    made_run(tmp_path / "b" / "cut", 40.0, 3.0, 4, 0.0, limit="cut")
    other = made_run(tmp_path / "b" / "other", 40.0, 3.0, 5, 0.0)
    record = json.loads((other / "run.json").read_text())
    record["derived"]["surfaceEnergy"] = 0.02
    (other / "run.json").write_text(json.dumps(record))
    done = analyse(tmp_path, "--json")
    assert done.returncode == 0
    notes = done.stderr.splitlines()
    assert len(notes) == 5 and all(note.endswith("left out") for note in notes)
    for text in (
        "late: has not ended",
        "oblique: impact = 0.5, A24's scene has 0.0",
        "again: the same filling",
        "cut: limit = cut, A24's scene has held",
        "other: other grains than the paper's (surfaceEnergy = 0.02)",
    ):
        assert text in done.stderr
    answer = json.loads(done.stdout)
    table = analyse(tmp_path, "--format", "csv").stdout.splitlines()
    assert [line.split(",")[0] for line in table if line[0] != "#"] == ["run", "good"] and answer["notes"] == [
        "5 runs left out (not ended, of another scene, or with nothing to measure)"
    ]
    assert ["only one size" in answer["remarks"][0], "has 3 velocities" in answer["remarks"][1]] == [True, True]


def test_a_broken_run_gets_one_line_and_the_others_are_analysed(runs, tmp_path):
    made_run(tmp_path / "good", 40.0, 3.0, 1, 0.0)
    (made_run(tmp_path / "cut", 40.0, 3.0, 2, 0.0) / "history.npz").write_bytes(b"PK")
    broken = made_run(tmp_path / "odd", 40.0, 3.0, 3, 0.0)
    record = json.loads((broken / "run.json").read_text())
    record["parameters"]["filling"] = "dense"
    (broken / "run.json").write_text(json.dumps(record))
    done = analyse(tmp_path, tmp_path / "none")
    assert done.returncode == 2 and "1 runs" in done.stdout
    assert len(done.stderr.splitlines()) == 3 and "Traceback" not in done.stderr
    for text in ("cut/history.npz: damaged", "none: no such folder", "odd: its parameter filling is 'dense'"):
        assert text in done.stderr


def test_nothing_to_analyse(tmp_path):
    (tmp_path / "empty").mkdir()
    done = analyse(tmp_path / "empty")
    assert (done.returncode, done.stdout) == (2, "") and "no run folder (run.json) there" in done.stderr
    made_run(tmp_path / "late", 40.0, 3.0, 1, 0.0, ended=False)
    done = analyse(tmp_path / "late", "--json")
    assert (done.returncode, done.stdout) == (2, "") and "no run of A24's scene to analyse" in done.stderr


def test_a_place_that_cannot_be_written_is_one_line(runs, tmp_path):
    (tmp_path / "taken").write_text("")
    made_run(tmp_path / "run", 40.0, 3.0, 1, 0.0)
    done = analyse(tmp_path / "run", "--figures", tmp_path / "taken")
    assert done.returncode == 2 and done.stderr.count("\n") == 1 and "taken" in done.stderr


def test_aggregates_that_never_turned_around_are_reported(tmp_path):
    path = made_run(tmp_path / "run", 40.0, 3.0, 1, 0.0)
    with np.load(path / "history.npz") as archive:
        arrays = {name: array[:60] for name, array in archive.items()}
    np.savez(path / "history.npz", **arrays)
    done = analyse(path)
    assert done.returncode == 2 and "not met, or not turned around, left out" in done.stderr
    made_run(tmp_path / "other", 40.0, 3.0, 2, 0.0)
    assert analyse(tmp_path).returncode == 0


def test_a_line_that_falls_is_reported_as_it_is(tmp_path):
    """Two runs may give any slope: what rests on a positive delta_max/R* is left out, the rest is drawn."""
    for size, shift in ((40.0, 2.0), (60.0, -3.0)):
        made_run(tmp_path / "runs" / f"R{size:g}", size, 3.0, 1, shift)
    done = analyse(tmp_path / "runs", "--figures", tmp_path / "figures", "--json")
    assert done.returncode == 0 and done.stderr == "", done.stderr
    size = lines(json.loads(done.stdout), "size dependence")
    assert size["c1"]["ours"] < 0 and size["c1"]["error"] is None and size["c1"]["difference"] is None
    assert (tmp_path / "figures" / "fig10_moduli.png").exists()


def test_first_compression_is_taken_where_aggregates_creep_together_later():
    t = np.linspace(0.0, 20.0, 2001)
    d, v = np.sin(t) + 0.1 * t, np.cos(t) + 0.1
    first, later = first_compression(t, d, v)
    top = np.arccos(-0.1)
    assert later and (first.time, first.length) == pytest.approx((top, np.sin(top) + 0.1 * top), abs=1e-6)
    assert not first_compression(t[:400], d[:400], v[:400])[1]


def test_small_real_collisions(tmp_path):
    """Two sizes and two seeds of YADE's own runs: everything is measured, nothing is made up where data
    lack."""
    for size, seed in ((5, 1), (5, 2), (7, 1)):
        out = tmp_path / "runs" / f"R{size}-s{seed}"
        subprocess.run(
            [
                "yade",
                "-n",
                "-x",
                TOP / "yade_scripts" / "collide.py",
                f"radius={size}",
                f"seed={seed}",
                "velocity=20",
                "filling=0.35",
                "duration=60e-9",
                f"out={out}",
            ],
            capture_output=True,
            check=True,
        )
    broken = shutil.copytree(tmp_path / "runs" / "R7-s1", tmp_path / "runs" / "R7-s2")
    shutil.rmtree(broken / "states")
    (broken / "run.json").write_text((broken / "run.json").read_text().replace('"seed": 1', '"seed": 2'))
    done = analyse(tmp_path / "runs", "--json", "--figures", tmp_path / "figures")
    assert done.returncode == 2 and done.stderr.count("\n") == 1 and "R7-s2" in done.stderr
    answer = json.loads(done.stdout)
    assert answer["provenance"]["runs"] == 3 and answer["provenance"]["steps"] > 0
    size = lines(answer, "size dependence at 20 m/s")
    assert size["c1"]["error"] > 0 and size["c1"]["paper"] is None
    for row in rows(tmp_path / "figures"):
        assert row["closure"] < 1e-3 and row["grain_radius"] == RADIUS and 2 < row["inner_coordination"] < 12
        assert abs(sum(row[at_maximum(c)] for c in CHANNELS) - 1) < 1e-3
    assert any(
        "no size at filling 0.35 has 3 velocities" in line or "no delta_offset" in line for line in answer["remarks"]
    )
