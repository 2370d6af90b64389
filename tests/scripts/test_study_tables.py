"""The tables in yade_scripts/studies: what their scripts write, valid rows with stable steps, and the papers' runs."""

import os
import sys
from contextlib import nullcontext
from itertools import product
from pathlib import Path

import pytest
from running import STUDIES, TOP

from analysis.atlas.variables import CHOSEN
from yade_scripts.experiments.compression import KIND as COMPRESSION
from yade_scripts.materials import MATERIALS, pair_constants
from yade_scripts.run import table
from yade_scripts.runner import rows
from yade_scripts.studies import atlas, compressed, compression, elastoplastic, sintered, table_script, viscous

TABLES = sorted(name for name in os.listdir(STUDIES) if name.endswith(".table"))
PATHS = [os.path.join(STUDIES, name) for name in TABLES]
TIME_UNIT = pair_constants(MATERIALS["ice"])["timeUnit"]
WRITE_TABLES = (elastoplastic, viscous, compression, sintered, compressed, atlas)
BY_HAND = ("elastoplastic-prediction.table", "elastoplastic-referee.table")
VELOCITIES = {10 ** (0.1 * i) for i in range(8)}


def runs(name):
    """{row's name: parameters} of a table; all of its rows are valid."""
    found = rows.read(os.path.join(STUDIES, f"{name}.table"))
    assert not any(row.error for row in found)
    return {row.name: row.parameters for row in found}


def offsets(parameters):
    """12 B_off^2, a whole number in A22."""
    return round(parameters.impact**2 * 12, 9)


@pytest.mark.parametrize("script", WRITE_TABLES, ids=lambda script: script.__name__.rpartition(".")[2])
def test_committed_tables_are_what_the_script_writes(tmp_path, script):
    script.write_tables(tmp_path)
    study = script.__name__.rpartition(".")[2]
    assert sorted(os.listdir(tmp_path)) == [
        name for name in TABLES if name.startswith(f"{study}-") and name not in BY_HAND
    ]
    for path in tmp_path.iterdir():
        assert Path(STUDIES, path.name).read_text() == path.read_text(), f"{path.name}: run {script.__name__}"


def test_scripts_that_write_tables_say_what_they_do_and_refuse_arguments(tmp_path, monkeypatch, capsys):
    """Asked for help, or given what they don't take, they write nothing."""
    calls = []
    for arguments, status, said in (
        (["--help"], None, ("Writes tables.\n", "")),
        (["desk"], 2, ("", "desk: takes no arguments but --help\n")),
        ([], None, ("", "")),
    ):
        assert calls == []
        monkeypatch.setattr(sys, "argv", ["study.py", *arguments])
        with pytest.raises(SystemExit) if status else nullcontext():
            table_script.main(calls.append, tmp_path, "Writes tables.")
        assert tuple(capsys.readouterr()) == said
    assert len(calls) == 1


@pytest.mark.in_yade
def test_tables_are_read_as_yade_reads_them(tmp_path):
    from yade.utils import TableParamReader

    marked = tmp_path / "marked.table"
    marked.write_text(
        "# a comment\n\nradius! velocity material !THREADS # more\n4 10 'ice' 2\n\n= = * 1 # same\n5 = 'ice' =\n"
    )
    for path in [str(marked), *PATHS]:
        ours = {row.line: {"description": row.description, **row.cells} for row in table.read(path)}
        theirs = TableParamReader(path).paramDict().items()
        assert ours == {line: {name: cell for name, cell in row.items() if cell != "*"} for line, row in theirs}, path


@pytest.mark.in_yade
def test_the_step_of_every_row_is_stable():
    """Rows would start: what their runs refuse of grains, necks and steps before packings are made."""
    from yade_scripts.experiments import collision, compression
    from yade_scripts.parameters import ParameterError
    from yade_scripts.run.scene import pair_constants

    os.chdir(TOP)
    refused, seen = [], set()
    for row in (row for path in PATHS for row in rows.read(path)):
        assert not row.error
        p = row.parameters
        files = {"file": None, "projectileFile": None} if hasattr(p, "file") else {}
        alike = repr(p.changed(seed=1, out="", **files))
        if alike in seen:
            continue
        seen.add(alike)
        experiment = compression if row.kind.name == COMPRESSION.name else collision
        own = {"neck": p.neck} if experiment is collision else {"linearDamping": p.linearDamping}
        try:
            experiment.complete(p, pair_constants(p, **own), 1)
        except ParameterError as error:
            refused.append(f"{row.name}: {error}")
    assert refused == [] and len(seen) > 300


def test_elastoplastic_holds_the_papers_runs():
    """A24 section 3 and the captions of Figs 5 to 9; desk has some of each size, every velocity, both fillings. 12.5 ns per grain
    radius from the start, as older run folders of these rows have it; the slowest 1000 ns."""
    full, desk = runs("elastoplastic-full").values(), runs("elastoplastic-desk")
    scenes = {(p.filling, p.radius, p.velocity) for p in full}
    assert len(scenes) == 2 * (5 + 2 * 7) and len(full) == 10 * len(scenes)
    assert {p.stepFraction for p in full} == {0.1} and {p.velocity for p in desk.values()} == VELOCITIES
    sizes = {(filling, radius) for filling in (0.3, 0.4) for radius in (40, 50, 60, 80)}
    assert {(p.filling, p.radius) for p in desk.values()} == sizes
    one = desk["f0.4-R40-i5-s1"]
    assert (one.out, one.velocity, one.seed) == ("runs/elastoplastic/f0.4-R40-i5-s1", 10**0.5, 1)
    for p in [*full, *desk.values()]:
        slow = p in desk.values() and p.radius == 40 and p.velocity < 1.6
        assert p.duration == pytest.approx(1e-6 if slow else 64.6 * p.radius * TIME_UNIT, rel=1e-13)


def test_viscous_holds_the_papers_runs():
    """A22 section 2.4: 13 B_off^2, 8 velocities, 4 T_vis; desk has that grid with several seeds of smaller aggregates."""
    full, desk, predicted = (runs(f"viscous-{size}").values() for size in ("full", "desk", "prediction"))
    scenes = {(offsets(p), p.velocity, p.viscoelasticTime) for p in full}
    grid = product(range(13), (10 ** (0.1 * i) for i in range(13, 21)), (0.0, 1e-12, 3e-12, 6e-12))
    assert len(full) == 416 and scenes == set(grid) and {(p.grains, p.stepFraction) for p in full} == {(50_000, 0.1)}
    assert {(p.packing, p.duration, p.endWhenApart) for p in [*full, *desk]} == {("bpca", 6.34e-6, 1)}
    large = {(p.viscoelasticTime, p.velocity, offsets(p)) for p in desk if p.grains == 50_000}
    assert large == {(t, 10 ** (0.1 * 17), 3) for t in (0.0, 6e-12)}
    small = {(offsets(p), p.velocity, p.viscoelasticTime, p.seed) for p in desk if p.grains == 500}
    assert small == {(*scene, seed) for scene in scenes for seed in (1, 2, 3, 4)}
    # What was predicted before it ran is in no other table, and spans B_off at every velocity and T_vis.
    assert not {p.out for p in predicted} & {p.out for p in [*full, *desk]}
    of_size = [p for p in predicted if p.grains == 10_000]
    assert {offsets(p) for p in of_size} == set(range(13)) and len(of_size) == 2 * 2 * 4 * 13
    # Every second offset stands before the others, which are the last block.
    odd = [offsets(p) % 2 for p in of_size]
    assert odd == sorted(odd) and sum(odd) == 2 * 2 * 4 * 6 and len(predicted) == len(of_size) + 1


def test_sintered_full_holds_the_papers_runs():
    """S17 section 4 and the captions of Figs 8 to 15, ten seeds each."""
    full = runs("sintered-full")
    assert {p.limit for p in full.values()} == {"cut"} and {p.criticalRolling for p in full.values()} == {2e-10, 30e-10}
    bcca = [p for p in full.values() if p.packing == "bcca" and p.planar and not p.viscoelasticTime]
    assert {p.grains for p in bcca} == {1024}
    for scene in ((10.0, 2e-10), (10.0, 30e-10), (30.0, 2e-10), (30.0, 30e-10)):
        necks = {p.neck for p in bcca if (p.velocity, p.criticalRolling) == scene}
        assert necks == {0, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7}
    points = {name.rpartition("-s")[0] for name in full}
    assert len(full) == 10 * len(points)
    assert {f"b0.7-v{growth:g}-vg{growth:g}" for growth in (1, 2, 3, 4, 5, 7.5, 10, 15, 20)} <= points


def test_sintered_desk_has_ten_seeds_of_what_the_paper_states_and_files_that_are_grown():
    desk = runs("sintered-desk")
    for point in "b0-v50 b0.7-v3.2 b0.7-v10 b0.7-v20 b0.4-v30 b0.5-v30 b0.7-v3-vg3 b0.7-v10-space".split():
        own = [desk[f"{point}-s{seed}"] for seed in range(1, 11)]
        assert len({(p.seed, p.file) for p in own}) == 10
    assert {(p.velocity > 10, p.duration) for p in desk.values()} == {(False, 24.4e-6), (True, 12.2e-6)}
    assert all(p.endWhenApart and p.slidingStiffnessFactor == 2 for p in desk.values())
    for size in sintered.TABLES:
        wanted = {p.file for p in runs(f"sintered-{size}").values() if p.file}
        assert wanted == {grown.file(0) for grown in sintered.grown(size)}


def test_sintered_beyond_stands_beside_the_desks_runs():
    """Every row of beyond differs from a row of desk with the same seed in one thing alone."""
    beyond, desk = runs("sintered-beyond"), runs("sintered-desk")
    assert len(beyond) == 420 and not set(beyond) & set(desk)
    for name, p in beyond.items():
        changed = {"-space": not p.planar, "-held": p.limit == "held", "-x30": p.criticalRolling == 30e-10}
        *more, other = (ending for ending, is_so in changed.items() if is_so)
        assert name.replace(other, "") in desk and more in ([], ["-space"])
        if p.packing == "file":  # aggregates grow by the law that they collide with
            assert ("space" in p.file, "held" in p.file) == (not p.planar, p.limit == "held")
    core_hours = {size: sintered.core_hours(size) for size in sintered.TABLES}
    assert core_hours == pytest.approx(
        {"desk": 9.9, "full": 38.6, "beyond": 8.3, "decide": 3.6}, rel=0.02
    )  # those of STUDIES.md


def test_rows_of_the_atlas_are_the_same_in_every_size():
    """A tenth is held out, and not chosen, and a tenth of silicate, of every structure a quarter; sizes, mass ratios and steps are within
    their limits."""
    scenes = atlas.scenes(4000)
    assert scenes[:500] == atlas.scenes(500) and len({scene.seed for scene in scenes}) == 4000
    assert sum(scene.held for scene in scenes) == 400 and sum(scene.material == "silicate" for scene in scenes) == 400
    assert not any(atlas.chosen()[k] for k, scene in enumerate(scenes[CHOSEN.start :]) if scene.held)
    assert not any(scene.material == "silicate" and scene.structure == "compressed" for scene in scenes)
    numbers = [sum(scene.structure == name for scene in scenes[:2000]) for name in atlas.STRUCTURES]
    assert numbers == pytest.approx([500] * 4, abs=2)
    for number, scene in enumerate(scenes):
        large, small = scene.grains
        assert 64 <= large + small <= (1024 if number < 2000 else 4096) and large >= small >= 4 and large <= 73 * small
    rows_, cell = [atlas.row(scene) for scene in scenes[:50]], scenes[1].cell
    assert all(0.01 < row["stepFraction"] <= 0.2 for row in rows_) and cell in atlas.CELL_SEEDS[1024]
