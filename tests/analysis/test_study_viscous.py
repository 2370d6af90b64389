"""The study of viscous drag (Arakawa et al. 2022): made runs whose answers are known; means over offsets; fits."""

import numpy as np
import pandas
import pytest
from written_runs import MASS, PAIR, RADIUS, chain, losing, record, state_arrays, write_run

from analysis import theory
from analysis.runs.folder import open_run
from analysis.studies import viscous
from analysis.studies.estimates import estimate, where

GRAINS, V_FRA = 30, 55.0
VELOCITIES = tuple(10 ** (0.1 * i) for i in (16, 17, 18, 20))
COUNTS = {"formed": 2.5 * GRAINS, "broken": 1.5 * GRAINS}
LOST = {"rollingDissipation": 0.4, "slidingDissipation": 0.2, "connection": 0.1, "disconnection": 0.05}


def made_run(path, velocity, square, viscous_time, seed, derived={}, **parameters):
    """A collision whose largest fragment makes f_gro = (1 - B^2) 2/3 ln(V_FRA/v) + noise of the seed, the rest in
    fragments of one and two grains; derived: as record's others."""
    noise = 0.02 * np.random.default_rng((seed, int(1e12 * viscous_time))).normal()
    growth = np.clip((1 - square) * 2 / 3 * np.log(V_FRA / velocity) + noise, -0.9, 0.9)
    largest = int(round(GRAINS * (1 + growth)))
    whole = chain(0, GRAINS) + chain(GRAINS, GRAINS)
    pairs = chain(0, largest) + chain(largest, min(2, 2 * GRAINS - largest))
    position = 2.3 * RADIUS * np.arange(2 * GRAINS)[:, None] * (1, 0, 0)
    position[1::2] -= (0.3 * RADIUS, 0, 0)  # pairs nearer than 2.2 r
    moving = np.zeros_like(position)
    moving[1::2, 0] = -0.5  # which approach at 0.5 m/s
    aggregate, time = np.repeat([0, 1], GRAINS), np.linspace(0, 2e-6, 21)
    counts = {name: (number * time / time[-1]).astype(int) for name, number in COUNTS.items()}
    lost = {**LOST, "drag": 0.1 if viscous_time else 0.0}
    history = losing(time, GRAINS * MASS * (velocity / 2) ** 2, lost, time > 0, **counts)
    states = [
        state_arrays(0.0, position, 0 * moving, aggregate, whole),
        state_arrays(0.6e-6, position, moving, aggregate, whole),
        state_arrays(2e-6, position, 0.5 * moving, aggregate, pairs),
    ]
    scene = dict(packing="bpca", material="ice", grains=GRAINS, velocity=velocity, impact=square**0.5, seed=seed)
    own = dict(viscoelasticTime=viscous_time, targetCharacteristicRadius=5 * RADIUS, **derived)
    given = {**scene, "viscoelasticTime": viscous_time, **parameters}
    about = record(20 * RADIUS, given, projectileCharacteristicRadius=5.5 * RADIUS, **own)
    return write_run(path, about, history, states)


def test_thresholds_energies_and_events_of_made_runs(tmp_path):
    """f_gro falls linearly in ln v through 0 at V_FRA; grains are whole, so that it is rounded to 1/30."""
    folders = [
        made_run(tmp_path / f"v{i}-k{k:g}-s{seed}", velocity, k / 12, 6e-12, seed)
        for i, velocity in enumerate(VELOCITIES)
        for k in viscous.TWELFTHS[:: 1 if i < 3 else 2]
        for seed in (1, 2, 3)
    ]
    runs = viscous.STUDY.runs(pandas.DataFrame([viscous.STUDY.measure(open_run(folder)) for folder in folders]))
    v_fra = estimate(viscous.falls_at, runs)
    assert v_fra.value == pytest.approx(V_FRA, rel=0.1) and 0 < v_fra.error < 12 and v_fra.pairs == 3
    fast = where(runs, velocity=VELOCITIES[3])
    assert np.isnan(viscous.over_offsets()(fast)) and np.isfinite(viscous.over_offsets(viscous.TWELFTHS[::2])(fast))
    assert viscous.lead("rolling", max)(runs) == pytest.approx(100 * (0.4 - 0.2) / 0.85)
    assert viscous.lead("drag", min)(runs) == pytest.approx(100 * (0.1 - 0.0) / 0.85)
    assert viscous.a_grain("formed")(runs) == pytest.approx(COUNTS["formed"] / (2 * GRAINS))


def test_one_run(tmp_path):
    row = viscous.STUDY.measure(open_run(made_run(tmp_path / "run", VELOCITIES[1], 0.25, 6e-12, 2)))
    assert (row["grains"], row["seed"], row["viscoelasticTime"]) == (GRAINS, 2, 6e-12)
    kinetic = 2 * GRAINS * 0.5 * MASS * (VELOCITIES[1] / 2) ** 2
    assert row["kinetic_at_start"] == pytest.approx(kinetic) and row["drag"] == pytest.approx(0.1 * kinetic)
    assert (row["formed"], row["broken"]) == (75, 45)
    assert row["largest"] == round(GRAINS * (1 + row["growth"])) and row["fragments"].startswith(f"1x{row['largest']} ")
    assert viscous.sizes_of(row["fragments"]).sum() == 2 * GRAINS
    assert row["pair_speed"] == pytest.approx(0.5) and row["characteristic_radius"] == pytest.approx(5.25 * RADIUS)
    assert row["energy_unit"] == pytest.approx(PAIR.pull_off_force * PAIR.pull_off_overlap)
    ice = theory.Material(*(getattr(theory.ICE, n) for n in list(vars(theory.ICE))[:-1]), 6e-12)
    assert row["sticking_velocity"] == pytest.approx(theory.sticking_velocity(theory.pair_constants(ice, RADIUS)))


def test_means_over_offsets_are_exact_for_one_and_for_the_square():
    """<1> = 1 and <B^2> = int 2 B B^2 dB = 1/2; of B^4 the trapezoidal rule has the error h^2/6. Rounded numbers are
    those of A22's grid: 50.1 m/s and B_off = 0.2887 are 10^1.7 m/s and (1/12)^(1/2); 45 m/s and 0.3 are not of it."""
    of_grid = [viscous.velocity_of_grid(v) for v in (50.1, 45.0)] + [viscous.offset_of_grid(b) for b in (0.2887, 0.3)]
    assert of_grid == pytest.approx([10**1.7, 45.0, (1 / 12) ** 0.5, 0.3], rel=1e-14)
    runs = pandas.DataFrame({"pair": 1, "twelfth": viscous.TWELFTHS})
    for power, exact in ((0, 1), (1, 1 / 2), (2, 1 / 3 + 1 / 12**2 / 6)):
        own = runs.assign(growth=(runs.twelfth / 12) ** power)
        assert viscous.over_offsets()(own) == pytest.approx(exact, rel=1e-12)
