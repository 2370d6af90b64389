"""Tables of the studies: valid rows with stable steps, and the papers' runs."""

import os
from itertools import product
from pathlib import Path

import pytest
from running import STUDIES, TOP

from analysis.atlas.variables import CHOSEN
from yade_scripts.experiments.compression import KIND as COMPRESSION
from yade_scripts.materials import MATERIALS, pair_constants
from yade_scripts.run import table
from yade_scripts.runner import rows
from yade_scripts.studies import atlas, sintered, tables

TIME_UNIT = pair_constants(MATERIALS["ice"])["timeUnit"]


@pytest.fixture(scope="module")
def paths(tmp_path_factory):
    """{name: path} of all tables, as they are written."""
    folder = tmp_path_factory.mktemp("tables")
    return {
        name: os.path.join(STUDIES, f"{name}.table") if name in tables.EXAMPLES else tables.write(name, folder)
        for name in [*tables.of_studies(), *tables.EXAMPLES]
    }


@pytest.fixture(scope="module")
def runs(paths):
    """Function of a table's name: {row's name: parameters}; all of its rows are valid."""

    def of(name):
        found = rows.read(paths[name])
        assert not any(row.error for row in found)
        return {row.name: row.parameters for row in found}

    return of


def test_a_cell_may_hold_blanks(tmp_path):
    cells = {"description": "a", "file": "my packings/it's #1.npz", "out": "my runs/a"}
    table.write(tmp_path / "a.table", [cells])
    (row,) = table.read(tmp_path / "a.table")
    assert {"description": row.description, **row.cells} == cells


def test_the_example_in_git_is_what_its_study_writes(paths):
    assert Path(paths["elastoplastic-first"]).read_text() == Path(STUDIES, "elastoplastic-first.table").read_text()


@pytest.mark.in_yade
def test_tables_are_read_as_yade_reads_them(tmp_path, paths):
    from yade.utils import TableParamReader

    marked = tmp_path / "marked.table"
    marked.write_text(
        "# a comment\n\nradius! velocity material !THREADS # more\n4 10 'ice' 2\n\n= = * 1 # same\n5 = 'ice' =\n"
    )
    for path in [str(marked), *paths.values()]:
        ours = {row.line: {"description": row.description, **row.cells} for row in table.read(path)}
        theirs = TableParamReader(path).paramDict().items()
        assert ours == {line: {name: cell for name, cell in row.items() if cell != "*"} for line, row in theirs}, path


@pytest.mark.in_yade
def test_the_step_of_every_row_is_stable(paths):
    """What runs refuse of grains, necks and steps before packings are made."""
    from yade_scripts.experiments import collision, compression
    from yade_scripts.parameters import ParameterError
    from yade_scripts.run.scene import pair_constants

    os.chdir(TOP)
    refused, known = [], set()
    for row in (row for path in paths.values() for row in rows.read(path)):
        assert not row.error
        p = row.parameters
        alike = repr({**p.as_dict(), **dict.fromkeys(("seed", "out", "file", "projectileFile"))})
        if alike in known:
            continue
        known.add(alike)
        experiment = compression if row.kind.name == COMPRESSION.name else collision
        own = {"neck": p.neck} if experiment is collision else {"linearDamping": p.linearDamping}
        try:
            experiment.complete(p, pair_constants(p, **own), 1)
        except ParameterError as error:
            refused.append(f"{row.name}: {error}")
    assert refused == [] and len(known) > 300


def test_elastoplastic_holds_the_papers_runs(runs):
    """A24 section 3 and the captions of Figs 5 to 9; 12.5 ns per grain radius from the start."""
    full = runs("elastoplastic-full").values()
    scenes = {(p.filling, p.radius, p.velocity) for p in full}
    assert len(scenes) == 2 * (5 + 2 * 7) and len(full) == 10 * len(scenes) and {p.stepFraction for p in full} == {0.1}
    for p in full:
        assert p.duration == pytest.approx(64.6 * p.radius * TIME_UNIT, rel=1e-13)


def test_viscous_holds_the_papers_runs(runs):
    """A22 section 2.4: 13 B_off^2, 8 velocities, 4 T_vis."""
    offsets, full = lambda p: round(p.impact**2 * 12, 9), runs("viscous-full").values()
    scenes = {(offsets(p), p.velocity, p.viscoelasticTime) for p in full}
    grid = product(range(13), (10 ** (0.1 * i) for i in range(13, 21)), (0.0, 1e-12, 3e-12, 6e-12))
    assert len(full) == 416 and scenes == set(grid) and {(p.grains, p.stepFraction) for p in full} == {(50_000, 0.1)}
    assert {(p.packing, p.duration, p.endWhenApart) for p in full} == {("bpca", 6.34e-6, 1)}


def test_sintered_holds_the_papers_runs_and_files_that_are_grown(runs):
    """S17 section 4 and the captions of Figs 8 to 15, ten seeds each."""
    full = runs("sintered-full")
    assert {p.limit for p in full.values()} == {"cut"} and {p.criticalRolling for p in full.values()} == {2e-10, 30e-10}
    bcca = [p for p in full.values() if p.packing == "bcca" and p.planar and not p.viscoelasticTime]
    assert {p.grains for p in bcca} == {1024}
    for scene in product((10.0, 30.0), (2e-10, 30e-10)):
        necks = {p.neck for p in bcca if (p.velocity, p.criticalRolling) == scene}
        assert necks == {0, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7}
    points = {name.rpartition("-s")[0] for name in full}
    assert len(full) == 10 * len(points)
    assert {f"b0.7-v{growth:g}-vg{growth:g}" for growth in (1, 2, 3, 4, 5, 7.5, 10, 15, 20)} <= points
    for size in sintered.POINTS:
        wanted = {p.file for p in runs(f"sintered-{size}").values() if p.file}
        assert wanted == set(sintered.compacted(size))


def test_rows_of_the_atlas_are_the_same_in_every_size():
    """A tenth is held out, and not chosen, and a tenth of silicate, of every structure a quarter; sizes, mass ratios
    and steps are within their limits."""
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
    assert all(0.01 < row["stepFraction"] <= 0.2 for row in rows_) and cell in atlas.CELLS_OF[1024][1]
