"""Grains of two materials and of materials of one's own, in packings and runs; springs that are left out."""

import numpy as np
import pytest
from running import COMPRESS, collide, completed, make_packing, read_arrays, refusal, stop_midway, study

from analysis.export.formats import write_xyz
from analysis.export.viewer import write_view
from analysis.measures.fragments import fragment_labels
from analysis.measures.outcome import collision_outcome
from analysis.runs.folder import open_run
from analysis.runs.ledger import closure
from analysis.runs.measured import outcome_of_run
from analysis.theory import ICE, SILICATE, interaction_energies
from analysis.theory import pair_constants as constants_of
from yade_scripts import packings
from yade_scripts.experiments.collision import CollisionParameters, place
from yade_scripts.materials import equilibrium_overlap, overlaps
from yade_scripts.packings.packing import equilibrium_overlaps, surface_gaps

BOTH = "material=ice,silicate"
MIXED = f"{BOTH} materialFraction=0.3 packing=bcca grains=60 threads=1".split()
THEORY = (ICE, SILICATE)
OWN = "[quartz]\nyoung = 54e9\npoisson = 0.17\ndensity = 2650\nsurfaceEnergy = 0.02\ncriticalRolling = 2e-9\n"


def placed(*arguments):
    """(CollisionParameters, packings, velocities) of a collision that isn't run."""
    parameters = CollisionParameters.parse(dict(argument.split("=") for argument in arguments))
    return place(parameters, equilibrium_overlap(parameters))


@pytest.mark.parametrize("layout, factor", [("mixed", 1), ("core-mantle", 1), ("halves", 0.3)])
def test_grains_of_two_materials_lie_as_the_layout_says_and_every_contact_rests(layout, factor):
    parameters, (packing, other), _ = placed(*MIXED, f"layout={layout}", f"mixedSurfaceEnergyFactor={factor}")
    assert np.count_nonzero(packing.kind) == np.count_nonzero(other.kind) == 18
    place_of = {"core-mantle": np.linalg.norm(packing.position - packing.position.mean(0), axis=1)}
    along = place_of.get(layout, packing.position[:, 0])
    apart = along[packing.kind == 1].min() > along[packing.kind == 0].max() - 0.05e-7
    assert apart == (layout != "mixed")
    pairs = packings.contacts(packing)
    rest = equilibrium_overlaps(packing.radius, pairs, 1e-7, overlaps(parameters.of_each()), packing.kind)
    for (i, j), depth in zip(packing.kind[pairs], rest):
        pair = constants_of(THEORY[i], 1e-7, THEORY[j], 1e-7, mixed_factor=factor)
        assert depth == pytest.approx(pair.equilibrium_overlap, rel=1e-12)
    assert -surface_gaps(packing.position, packing.radius, pairs) == pytest.approx(rest, rel=2e-3)
    assert len(pairs) >= packing.grains - 1


def test_a_script_brings_a_mixed_aggregate_to_rest():
    """Every second grain becomes silicate."""
    parameters = CollisionParameters.parse({"material": BOTH[9:], "materialFraction": 0.5, "packing": "bcca"})
    overlap, kind = overlaps(parameters.of_each()), np.arange(300) % 2
    rested = packings.brought_to_rest(packings.bcca(300, 1e-7, overlap[0, 0], seed=1), 1e-7, overlap, kind=kind)
    pairs = packings.contacts(rested)
    rest = equilibrium_overlaps(rested.radius, pairs, 1e-7, overlap, kind)
    assert -surface_gaps(rested.position, rested.radius, pairs) == pytest.approx(rest, rel=1e-6) and len(pairs) >= 299


def test_a_mixed_aggregate_stays_at_rest_for_2000_t0(tmp_path):
    """Before, half of its contacts broke without an impact."""
    about, history = completed(tmp_path, *MIXED, "velocity=0.01", "duration=3.9e-7", "endWhenApart=0")
    assert history["time"][-1] > 2000 * about["derived"]["timeUnit"] and not history["broken"].any()
    rolling = interaction_energies(constants_of(SILICATE, 1e-7))["roll"]
    assert np.ptp(history["kinetic"]) < 1e-6 * rolling and np.ptp(history["contacts"]) == 0


def test_a_mixed_collision_counts_mass_closes_its_ledger_and_resumes_to_the_same_bits(tmp_path):
    hit = (*MIXED, "velocity=8", "states=4")
    _, history = completed(tmp_path / "one", *hit, "duration=1e-7")
    _, finer = completed(tmp_path / "half", *hit, "duration=1e-7", "stepFraction=0.05")
    assert closure(history) < 1e-3 and closure(finer) < 0.4 * closure(history)
    run = open_run(tmp_path / "one" / "run")
    start, end = run.start, run.last
    density = np.array([ICE.density, SILICATE.density])[start.material]
    assert start.mass == pytest.approx(4 / 3 * np.pi * 1e-21 * density, rel=1e-12)
    reduced = start.mass.sum() / 4
    assert history["kinetic"][0] == pytest.approx(reduced * 8**2 / 2, rel=1e-9)
    assert start.mass @ start.velocity == pytest.approx(0, abs=1e-9 * start.mass.sum() * 8)
    largest = fragment_labels(120, end.contact_pairs) == 0
    assert end.fragments().mass_fraction[0] == pytest.approx(end.mass[largest].sum() / end.mass.sum())
    found = collision_outcome(
        start.mass, start.aggregate, start.velocity, start.contact_pairs, end.velocity, end.contact_pairs
    )
    assert outcome_of_run(run).mass_fractions == found.mass_fractions
    stop_midway(tmp_path, (*hit, "duration=4e-7", "checkpointInterval=0.05"))
    straight = completed(tmp_path / "straight", *hit, "duration=4e-7")[1]
    assert collide(tmp_path, "continue=run").returncode == 0
    continued = read_arrays(tmp_path, "run", "history.npz")
    assert all(np.array_equal(continued[name], straight[name]) for name in straight)


def test_exports_and_pages_know_the_materials(tmp_path):
    completed(tmp_path, *MIXED, "velocity=8", "duration=1e-8", "states=2", "sliding=0")
    run = open_run(tmp_path / "run")
    told = " ".join(repr(run).split())
    assert "layout mixed, materialFraction 0.3, surfaceEnergy 0.1,0.02 J/m^2, grain" in told and ", sliding 0, " in told
    frame = write_xyz(run, tmp_path / "export").read_text().splitlines()
    column = frame[1].split("Properties=")[1].split(":")
    assert column[column.index("material") + 1 :][:2] == ["I", "1"]
    page = write_view(run, tmp_path / "run.html").read_text()
    assert "silicate" in page and "= 0.1,0.02 J/m" in page


@pytest.mark.parametrize("engine, left_out", [("fused", "sliding"), ("fused", "rolling"), ("functors", "twisting")])
def test_springs_that_are_left_out_store_and_lose_nothing(tmp_path, engine, left_out):
    small = "packing=bpca grains=20 velocity=15 duration=2e-8 threads=1 states=2".split()
    _, history = completed(tmp_path, *small, f"engine={engine}", f"{left_out}=0")
    others = {"sliding", "rolling", "twisting"} - {left_out}
    assert all(history[name].any() for name in others)
    assert not history[left_out].any() and not history[f"{left_out}Dissipation"].any()


def test_a_sphere_cut_out_of_a_mixed_cell_keeps_the_materials_of_its_grains(tmp_path):
    cell = f"{BOTH} materialFraction=0.4 grains=64 strainRate=1e-4 finalFilling=0.25 states=2".split()
    completed(tmp_path, *cell, script=COMPRESS)
    state = sorted((tmp_path / "run" / "states").iterdir())[-1]
    done = make_packing(tmp_path, "a.npz", f"from={state}", "radius=4.5")
    assert done.returncode == 0, done.stderr
    packing, run = packings.load(tmp_path / "a.npz"), open_run(tmp_path / "run")
    assert packing.parameters["materials"] == run.derived["materials"] and set(packing.kind) == {0, 1}
    pairs = packings.contacts(packing)
    rest = [constants_of(THEORY[i], 1e-7, THEORY[j], 1e-7).equilibrium_overlap for i, j in packing.kind[pairs]]
    assert -surface_gaps(packing.position, packing.radius, pairs) == pytest.approx(rest, rel=0.06)
    refused = make_packing(tmp_path, "b.npz", f"from={tmp_path / 'a.npz'}")
    assert "of several materials; must be of one" in refusal(refused)


def test_target_and_projectile_of_different_materials_move_about_their_centre_of_mass():
    parameters, (target, projectile), (slow, fast) = placed(
        BOTH, "layout=target-projectile", "packing=cpe", "radius=6", "velocity=3"
    )
    assert not target.kind.any() and projectile.kind.all()
    assert fast[0] == pytest.approx(-3 / (1 + 2.65)) and slow[0] - fast[0] == pytest.approx(3)
    own = constants_of(SILICATE, 1e-7).equilibrium_overlap
    depth = -surface_gaps(projectile.position, projectile.radius, packings.contacts(projectile))
    assert depth == pytest.approx(own, rel=1e-6)


def test_a_material_of_ones_own_is_that_of_its_constants_and_its_file_is_watched(tmp_path):
    (tmp_path / "own.toml").write_text(OWN)
    tiny = "packing=bcca grains=10 velocity=1 grainRadius=1e-7 duration=2e-8 threads=1 states=2".split()
    _, of_papers = completed(tmp_path, *tiny, "material=silicate")
    _, own = completed(tmp_path, *tiny, "material=quartz", "materials=own.toml", "overwrite=1")
    assert all(np.array_equal(own[name], of_papers[name]) for name in own)
    cells = dict(cell.split("=") for cell in ("description=a", "out=mixed", *tiny)) | {"material": "ice,quartz"}
    cells |= {"materials": "own.toml", "materialFraction": "0.5"}
    (tmp_path / "a.table").write_text(" ".join(cells) + "\n" + " ".join(cells.values()) + "\n")
    assert "1 rows, 1 done" in study(tmp_path, "a.table", "-j", "1").stdout
    (tmp_path / "own.toml").write_text(OWN.replace("2650", "2700"))
    assert "own.toml as it is now" in study(tmp_path, "a.table", "-j", "1").stderr


def test_a_packing_file_keeps_the_materials_of_its_grains(tmp_path):
    assert make_packing(tmp_path, "a.npz", *MIXED[:-1], "seed=4").returncode == 0
    packing = packings.load(tmp_path / "a.npz")
    assert np.count_nonzero(packing.kind) == 18 and packing.parameters["materials"][1]["name"] == "silicate"
    own = ("packing=file", "file=a.npz", "velocity=3", "duration=1e-8", "threads=1")
    about, _ = completed(tmp_path, *own, BOTH)
    assert np.array_equal(open_run(tmp_path / "run").start.material[:60], packing.kind)
    assert about["derived"]["materials"][1]["density"] == SILICATE.density
    assert "of grains of ice,silicate, not ice" in refusal(collide(tmp_path, *own, "overwrite=1"))
    for given in ("materialFraction=0.9", "layout=halves"):
        assert "as its grains have their materials" in refusal(collide(tmp_path, *own, BOTH, given, "overwrite=1"))
