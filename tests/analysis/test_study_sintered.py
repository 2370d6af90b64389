"""The study of sintered aggregates (Sirono & Ueno 2017): made runs whose answers are known, and its fits."""

import numpy as np
import pandas
import pytest
from written_runs import MASS, RADIUS, chain, losing, record, state_arrays, write_run

from analysis.runs.folder import open_run
from analysis.runs.format import BROKEN_BONDS
from analysis.studies.sintered import PARTS, STUDY, critical_velocity, necks_exponent

GRAINS = 2048  # of both aggregates: chains
PARAMETERS = dict(material="ice", planar=1, viscoelasticTime=0.0, limit="cut", slidingStiffnessFactor=2.0, impact=0.0)
PARAMETERS |= dict(packing="bcca", neck=0.7, velocity=30.0, seed=2, duration=24.4e-6)
LOST = {"rollingDissipation": 0.4, "disconnection": 0.1, "normal": 0.05}


def test_one_run(tmp_path):
    """Two straight chains of bonded grains stick; 10 necks break by sliding and 70 by rolling."""
    time, half = np.linspace(0, 4e-6, 21), GRAINS // 2
    counts = {name: np.linspace(0, n, 21).round().astype(int) for name, n in zip(BROKEN_BONDS, (0, 10, 70, 0))}
    history = losing(time, half * MASS * 15.0**2, LOST, time > 0, v=np.zeros(21), **counts)
    position, states = 2 * RADIUS * np.arange(GRAINS)[:, None] * (1, 0, 0), []
    for t, pairs in ((0.0, chain(0, half) + chain(half, half)), (4e-6, chain(0, GRAINS))):
        states.append(state_arrays(t, position, 0 * position, np.repeat([0, 1], half), pairs))
        states[-1]["contact_bonded"] = np.full(len(pairs), True)
    about = record(200 * RADIUS, PARAMETERS, criticalRolling=2e-10)
    row = STUDY.measure(open_run(write_run(tmp_path / "run", about, history, states)))
    assert (row["neck"], row["packing_seed"], row["growth_velocity"], row["grains"]) == (0.7, 2, 0.0, GRAINS)
    assert row["energy_ratio"] == pytest.approx(MASS * 30.0**2 / 4 / (np.pi * 0.1 * (0.7 * RADIUS) ** 2))
    assert row["largest"] == 1.0 and row["second"] == 0.0 and row["fragments"] == 0.0 and row["outcome"] == "sticking"
    # a straight chain of n grains 2R apart: R_g^2 = 4 R^2 (n^2 - 1)/12
    assert row["gyration_radius"] == pytest.approx(2 * np.sqrt((GRAINS**2 - 1) / 12))
    assert row["contacts"] == pytest.approx(2 * (GRAINS - 2) / GRAINS) and row["necks_at_start"] == GRAINS - 2
    assert [row[name] for name in BROKEN_BONDS] == [0, 10, 70, 0]
    assert sum(row[f"part_{name}"] for name in PARTS) == pytest.approx(1.0) and row["closure"] < 1e-12
    assert (row["part_kinetic"], row["part_elastic"]) == pytest.approx((0.45, 0.05))
    # 1,250 periods of 1.22 ns fall next to two fifths of the record, in which half of K(0) is lost evenly
    assert row["left_1250"] == pytest.approx(0.8, abs=0.02)
    assert np.isnan(row["left_5000"])


def test_the_law_of_broken_necks_and_the_velocity_where_half_of_the_mass_stays_are_fitted_exactly():
    ratios = np.tile([0.01, 0.3, 1.0, 3.0], 3)
    rows = pandas.DataFrame({"energy_ratio": ratios, "broken_bonds": 2048 * 0.05 * ratios**1.4, "grains": 2048})
    assert necks_exponent(rows) == pytest.approx(1.4)
    assert necks_exponent(rows.assign(broken_bonds=rows.broken_bonds.where(rows.energy_ratio > 0.1, 0))) > 1.4
    runs = pandas.DataFrame({"velocity": [10.0, 10.0, 20.0, 20.0, 40.0], "largest": [1.0, 0.9, 0.7, 0.9, 0.4]})
    assert critical_velocity(runs) == pytest.approx(35.0)
