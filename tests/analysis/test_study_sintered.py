"""The study of sintered aggregates (Sirono & Ueno 2017): made runs whose answers are known, and its fits."""

import numpy as np
import pandas
import pytest
from written_runs import MASS, RADIUS, chain, losing, record, state_arrays, write_run

from analysis.runs.folder import open_run
from analysis.runs.format import BROKEN_BONDS
from analysis.studies.sintered import PARTS, STUDY, critical_velocity, necks_exponent

GRAINS = 2048  # of both aggregates: chains
PLAIN = dict(material="ice", planar=1, viscoelasticTime=0.0, limit="cut", slidingStiffnessFactor=2.0, impact=0.0)
LOST = {"rollingDissipation": 0.4, "disconnection": 0.1, "normal": 0.05}


def made_run(path, velocity, neck, seed, largest=GRAINS, growth=0.0, broken=0, **parameters):
    """A collision of two straight chains: at the end a piece of `largest` grains, the rest a second piece beside it;
    necks broken by sliding (one in eight) and rolling."""
    time, half = np.linspace(0, 4e-6, 21), GRAINS // 2
    counts = zip(BROKEN_BONDS, (0, broken // 8, broken - broken // 8, 0))
    counts = {name: np.linspace(0, number, 21).round().astype(int) for name, number in counts}
    history = losing(time, half * MASS * (velocity / 2) ** 2, LOST, time > 0, v=np.zeros(21), **counts)
    position, states = 2 * RADIUS * np.arange(GRAINS)[:, None] * (1, 0, 0), []
    for t, n in ((0.0, half), (4e-6, largest)):
        pairs = chain(0, n) + chain(n, GRAINS - n)
        states.append(state_arrays(t, position, 0 * position, np.repeat([0, 1], half), pairs))
        states[-1]["contact_bonded"] = np.full(len(pairs), neck > 0)
    states[1]["position"][largest:, 0] += RADIUS
    own = dict(packing="file" if growth else "bcca", neck=neck, velocity=velocity, seed=1 if growth else seed)
    grown = {"targetPacking": {"growthVelocity": growth, "seed": seed}} if growth else {}
    given = {**PLAIN, **own, "duration": 24.4e-6, **parameters}
    return write_run(path, record(200 * RADIUS, given, criticalRolling=2e-10, **grown), history, states)


def test_one_run(tmp_path):
    row = STUDY.measure(open_run(made_run(tmp_path / "run", 30.0, 0.7, 2, broken=80)))
    assert (row["neck"], row["packing_seed"], row["growth_velocity"], row["grains"]) == (0.7, 2, 0.0, GRAINS)
    assert row["energy_ratio"] == pytest.approx(MASS * 30.0**2 / 4 / (np.pi * 0.1 * (0.7 * RADIUS) ** 2))
    assert row["largest"] == 1.0 and row["second"] == 0.0 and row["fragments"] == 0.0 and row["outcome"] == "sticking"
    # a straight chain of n grains 2R apart: R_g^2 = 4 R^2 (n^2 - 1)/12
    assert row["gyration_radius"] == pytest.approx(2 * np.sqrt((GRAINS**2 - 1) / 12))
    assert row["contacts"] == pytest.approx(2 * (GRAINS - 2) / GRAINS) and row["necks_at_start"] == GRAINS - 2
    assert [row[name] for name in BROKEN_BONDS] == [0, 10, 70, 0]
    assert sum(row[f"part_{name}"] for name in PARTS) == pytest.approx(1.0) and row["closure"] < 1e-12
    assert (row["part_kinetic"], row["part_elastic"]) == pytest.approx((0.45, 0.05)) and row["ended_by"]
    # 1,250 periods of 1.22 ns fall next to two fifths of the record, in which half of K(0) is lost evenly
    assert row["left_1250"] == pytest.approx(0.8, abs=0.02)
    assert np.isnan(row["left_5000"]) and np.isnan(row["part_necks_5000"])


def test_set_ups_stand_beside_each_other_by_pairs(tmp_path):
    """Half as many necks break in space; a compacted aggregate of the same seed is the same pair."""
    for seed, large in ((1, 1.0), (2, 0.9), (3, 0.5)):
        made_run(tmp_path / f"cut{seed}", 30.0, 0.7, seed, int(large * GRAINS), broken=80 * seed)
        made_run(tmp_path / f"space{seed}", 30.0, 0.7, seed, broken=40 * seed, planar=0)
        made_run(tmp_path / f"grown{seed}", 30.0, 0.7, seed, GRAINS // 2, growth=3.0, broken=120 * seed)
        made_run(tmp_path / f"held{seed}", 30.0, 0.7, seed, int((large - 0.25) * GRAINS), limit="held", broken=80)
    runs = STUDY.runs(pandas.DataFrame([STUDY.measure(open_run(path)) for path in sorted(tmp_path.iterdir())]))
    found = {row.quantity: row.ours for row in STUDY.rows(runs.assign(run=runs.index))}
    assert found["largest piece, V_g = 0 m/s, β = 0.7, 30 m/s, held"].value == pytest.approx(
        (0.75 + 0.65 + 0.75) / 3, abs=1e-3
    )
    space = found["broken necks, space over plane, β = 0.7, 30 m/s, cut"]
    assert space.value == pytest.approx(0.5) and space.error > 0.1  # other aggregates: both errors count
    grown = found["broken necks, V_g = 3 m/s over BCCA, β = 0.7, 30 m/s, cut"]
    assert grown.value == pytest.approx(1.5) and not grown.error  # the same pairs
    assert found["necks broken by rolling, five kinds together, cut [%]"].value == pytest.approx(87.5)
    assert set(runs.setup) == {"cut", "held", "space"}


def test_the_law_of_broken_necks_and_the_velocity_where_half_of_the_mass_stays_are_fitted_exactly():
    ratios = np.tile([0.01, 0.3, 1.0, 3.0], 3)
    rows = pandas.DataFrame({"energy_ratio": ratios, "broken_bonds": 2048 * 0.05 * ratios**1.4, "grains": 2048})
    assert necks_exponent(rows) == pytest.approx(1.4)
    assert necks_exponent(rows.assign(broken_bonds=rows.broken_bonds.where(rows.energy_ratio > 0.1, 0))) > 1.4
    runs = pandas.DataFrame({"velocity": [10.0, 10.0, 20.0, 20.0, 40.0], "largest": [1.0, 0.9, 0.7, 0.9, 0.4]})
    assert critical_velocity(runs) == pytest.approx(35.0)
