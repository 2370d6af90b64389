"""python3 -m analysis elastoplastic as a user runs it: on made-up run folders, and on small real
collisions."""

import json
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
from made_collisions import MODULI, line_of, made_run
from written_runs import RADIUS

from analysis.studies.elastoplastic.bounce import wilson
from analysis.studies.elastoplastic.measure import first_compression
from analysis.studies.elastoplastic.report import LEGEND

TOP = Path(__file__).resolve().parents[2]
VELOCITIES = [10 ** (0.1 * i) for i in (1, 3, 5, 7)]
NUMBERS = {"c1": "c1", "c2": "c2", "offset": "delta_offset", "ratio": "delta_max/R*"}


def analyse(*arguments):
    return subprocess.run(
        ["/usr/bin/python3", "-W", "error::RuntimeWarning", "-m", "analysis", "elastoplastic", *map(str, arguments)],
        cwd=TOP,
        capture_output=True,
        text=True,
    )


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
        for section in answer["comparison"]
        if heading in section["heading"]
        for line in section["lines"]
    }


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


def test_rows_points_and_ledger(answer):
    assert answer["provenance"]["runs"] == len(answer["runs"]) == 24 and answer["missing"] == []
    for row in answer["runs"]:
        assert row["closure"] < 1e-12 and "/" not in row["path"] and not row["exceeded"]
        assert row["label_d_max"] == pytest.approx(row["d_max"]) and row["coordination"] == 1.0
        assert sum(row["shares_at_end"].values()) == pytest.approx(1.0)
        assert (row["outcome"], row["restitution"] == 0.0) == (
            ("sticking", True) if row["seed"] == 1 else ("bouncing", False)
        )
    for point in answer["bounces"]:
        assert point["sticking"][0] == 0.25 and point["sticking"][1] < 0.25 < point["sticking"][2]
        assert point["compression"]["kinetic"][0] == pytest.approx(-1.0, abs=1e-3)
        assert point["restitution"][0] == pytest.approx((0.75 * point["bulk"][0]) ** 0.5, rel=0.01)


def test_runs_that_still_part_at_the_end_are_undecided(tmp_path):
    for seed in (1, 2, 3):
        made_run(tmp_path / f"s{seed}", 80.0, 10**0.5, seed, 0.0, sticks=True, settles=seed != 3)
    (point,) = json.loads(analyse("--json", *tmp_path.iterdir()).stdout)["bounces"]
    assert point["outcomes"] == {"sticking": 2, "undecided": 1}
    assert point["sticking"] == [1.0, wilson(2, 3)[0], 1.0]
    for path in tmp_path.iterdir():
        if path.name != "s3":
            shutil.rmtree(path)
    (point,) = json.loads(analyse("--json", *tmp_path.iterdir()).stdout)["bounces"]
    assert point["outcomes"] == {"undecided": 1} and point["restitution"][0] is None
    assert point["sticking"] == [None, 0.0, 1.0]


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
        "delta_offset = 0.271 r (A24's, for want of sizes here)",
    ):
        assert text in done.stdout
    assert max(map(len, done.stdout.splitlines())) < 250


def test_gallery(runs, gallery, answer):
    drawn = {file.name for file in gallery.glob("*.png")}
    assert drawn == {
        f"{name}.png"
        for name in (
            "fig04_motion",
            "fig05_size",
            "fig07_time",
            "fig08_velocity",
            "fig10_moduli",
            "fig11_strength",
            "fig12_andrews",
            "fig13_forces",
            "outcome",
            "energy_velocity",
            "energy_size",
            "start_offset",
        )
    }
    assert all((gallery / name).read_bytes().startswith(b"\x89PNG") for name in drawn)
    page = (gallery / "comparison.md").read_text()
    assert all(f"({name})" in page for name in drawn) and str(runs) not in page
    assert json.loads((gallery / "comparison.json").read_text()) == answer


def test_what_does_not_belong_is_left_out_with_a_note(runs, tmp_path):
    made_run(tmp_path / "a" / "late", 40.0, 3.0, 1, 0.0, ended=False)
    made_run(tmp_path / "a" / "oblique", 40.0, 3.0, 2, 0.0, impact=0.5)
    made_run(tmp_path / "a" / "good", 40.0, 3.0, 3, 0.0)
    made_run(tmp_path / "b" / "again", 40.0, 3.0, 3, 0.0)
    done = analyse(tmp_path, "--json")
    assert done.returncode == 0
    notes = done.stderr.splitlines()
    assert len(notes) == 3 and all(note.endswith("left out") for note in notes)
    for text in ("late: has not ended", "oblique: impact = 0.5, A24's scene has 0.0", "again: the same filling"):
        assert text in done.stderr
    answer = json.loads(done.stdout)
    assert [row["path"] for row in answer["runs"]] == ["good"] and answer["notes"] == [
        "3 runs left out (not ended, of another scene, or without a compression)"
    ]
    assert ["only one size" in answer["missing"][0], "has 3 velocities" in answer["missing"][1]] == [True, True]


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
    done = analyse(tmp_path / "runs", "--json")
    assert done.returncode == 2 and done.stderr.count("\n") == 1 and "R7-s2" in done.stderr
    answer = json.loads(done.stdout)
    assert len(answer["runs"]) == 3 and answer["provenance"]["steps"] > 0
    size = lines(answer, "size dependence at 20 m/s")
    assert size["c1"]["error"] > 0 and size["c1"]["paper"] is None
    for row in answer["runs"]:
        assert row["closure"] < 1e-3 and row["grain_radius"] == RADIUS and 2 < row["inner_coordination"] < 12
        assert abs(sum(row["shares_at_maximum"].values()) - 1) < 1e-3
    assert any(
        "no size at filling 0.35 has 3 velocities" in line or "no delta_offset" in line for line in answer["missing"]
    )
