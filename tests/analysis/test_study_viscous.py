"""The study of viscous drag (Arakawa et al. 2022): made runs whose answers are known; means, thresholds, fits against closed forms."""

import numpy as np
import pytest
from study_answers import answered, quantities, rows
from written_runs import MASS, PAIR, RADIUS, chain, losing, record, state_arrays, write_run

from analysis import theory
from analysis.__main__ import main
from analysis.runs.folder import open_run
from analysis.studies.curves import threshold_velocity
from analysis.studies.viscous.growth import SQUARES as TWELFTHS
from analysis.studies.viscous.growth import fragment_exponent, offset_weights
from analysis.studies.viscous.measure import sizes_from_text
from analysis.studies.viscous.study import STUDY

GRAINS, V_FRA = 30, 55.0
VELOCITIES = tuple(10 ** (0.1 * i) for i in (16, 17, 18, 20))
COUNTS = {"formed": 2.5 * GRAINS, "broken": 1.5 * GRAINS}
LOST = {"rollingDissipation": 0.4, "slidingDissipation": 0.2, "connection": 0.1, "disconnection": 0.05}


def made_run(path, velocity, square, viscous_time, seed, derived={}, **parameters):
    """A collision whose largest fragment makes f_gro = (1 - B^2) 2/3 ln(V_FRA/v) + noise of the seed, the rest in fragments
    of one and two grains; derived: as record's others."""
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


@pytest.fixture(scope="module")
def answer(tmp_path_factory):
    """{quantity: [row]} of three pairs at A22's offsets, without drag and with the most."""
    folder, out = tmp_path_factory.mktemp("viscous"), tmp_path_factory.mktemp("out")
    for viscous_time in (0.0, 6e-12):
        for i, velocity in enumerate(VELOCITIES):
            for square in TWELFTHS[:: 1 if i < 3 else 2]:
                for seed in (1, 2, 3):
                    path = folder / f"v{i}-b{square:.3f}-t{viscous_time}-s{seed}"
                    made_run(path, velocity, square, viscous_time, seed)
    assert main(["study", "viscous", str(folder), "--figures", str(out)]) == 0
    assert {"fig03_mean_growth", "drag", "size"} <= {file.stem for file in out.glob("*.png")}
    return quantities((out / "comparison.json").read_text())


def test_thresholds_energies_and_events_of_made_runs(answer):
    """f_gro falls linearly in ln v through 0 at V_FRA; grains are whole, so that it is rounded to 1/30."""
    found = rows(answer["v_fra"], grains=GRAINS)
    assert [row["value"] for row in found] == pytest.approx([V_FRA] * 2, rel=0.1)
    assert all(0 < row["error"] < 12 for row in found)
    assert len(rows(answer["growth"], velocity=100.0)) == 0 and len(rows(answer["growth_7"], velocity=100.0)) == 2
    assert all(row["pairs"] == 3 for row in answer["growth"])
    (rolling,) = rows(answer["loss"], channel="rolling", viscoelasticTime=0.0)
    assert rolling["value"] == pytest.approx(0.4 / 0.75)
    (lead,) = rows(answer["rolling_lead"], viscoelasticTime=6e-12)
    assert lead["value"] == pytest.approx((0.4 - 0.2) / 0.85)
    (formed,) = rows(answer["events"], event="N_con", velocity=VELOCITIES[1], viscoelasticTime=6e-12)
    assert formed["value"] == pytest.approx(COUNTS["formed"] / (2 * GRAINS))
    assert rows(answer["pair_speed"], viscoelasticTime=0.0)[0]["value"] == pytest.approx(0.5)
    assert rows(answer["v_stick_ratio"], viscoelasticTime=6e-12)[0]["value"] == pytest.approx(10, rel=0.15)


def test_one_run(tmp_path):
    path = made_run(tmp_path / "run", VELOCITIES[1], 0.25, 6e-12, 2)
    row = STUDY.measure(open_run(path))
    assert (row["grains"], row["seed"], row["viscoelasticTime"]) == (GRAINS, 2, 6e-12)
    kinetic = 2 * GRAINS * 0.5 * MASS * (VELOCITIES[1] / 2) ** 2
    assert row["kinetic_at_start"] == pytest.approx(kinetic) and row["drag"] == pytest.approx(0.1 * kinetic)
    assert (row["formed"], row["broken"]) == (75, 45)
    assert row["largest"] == round(GRAINS * (1 + row["growth"])) and row["fragments"].startswith(f"1x{row['largest']} ")
    assert row["pair_speed"] == pytest.approx(0.5) and row["characteristic_radius"] == pytest.approx(5.25 * RADIUS)
    assert row["energy_unit"] == pytest.approx(PAIR.pull_off_force * PAIR.pull_off_overlap)
    ice = theory.Material(*(getattr(theory.ICE, n) for n in list(vars(theory.ICE))[:-1]), 6e-12)
    assert row["sticking_velocity"] == pytest.approx(theory.sticking_velocity(theory.pair_constants(ice, RADIUS)))


OTHER_SCENES = {"neck": 0.5, "sizes": "two", "limit": "cut", "slidingStiffnessFactor": 2}
OTHER_GRAINS = {"criticalRolling": 8e-09, "young": 5.4e10, "surfaceEnergy": 0.025, "density": 2000}


def test_runs_of_other_scenes_grains_or_law_are_left_out(tmp_path, capsys):
    for square in (0.0, 0.25, 0.5, 1.0):
        made_run(tmp_path / f"b{square}", VELOCITIES[0], square, 0.0, 1, duration=6.34e-6)
    for name, value in OTHER_SCENES.items():
        made_run(tmp_path / name, VELOCITIES[0], 0.0, 0.0, 2, **{name: value})
    for name, value in OTHER_GRAINS.items():
        made_run(tmp_path / name, VELOCITIES[0], 0.0, 0.0, 1, {name: value})
    _, runs, said = answered(capsys, "viscous", tmp_path)
    assert runs == 4 and "neck = 0.5, the study of Arakawa et al. (2022) has 0.0" in said
    for name, value in {**OTHER_SCENES, **OTHER_GRAINS}.items():
        assert f"{name} = {value if isinstance(value, str) else f'{value:g}'}" in said


def test_a_run_too_short_for_final_fragments_is_left_out(tmp_path, capsys):
    """They last 2 us; at 0.1 m/s that is a fraction of r_c. One that ended before its duration has nothing left to meet."""
    made_run(tmp_path / "short", 0.1, 0.0, 0.0, 1, duration=2e-6)
    made_run(tmp_path / "apart", 0.1, 0.0, 0.0, 2, duration=6.34e-6)
    made_run(tmp_path / "long", VELOCITIES[1], 0.0, 0.0, 3, duration=2e-6)
    _, runs, said = answered(capsys, "viscous", tmp_path)
    assert runs == 2 and "short: lasts 2e-06 s, too short" in said


def test_rounded_numbers_are_those_of_the_grid(tmp_path, capsys):
    """50.1 m/s, B_off = 0.2887 and 6.00001 ps beside 10^1.7, (1/12)^(1/2) and 6 ps are the same run; 45 m/s is another."""
    made_run(tmp_path / "a", VELOCITIES[1], 1 / 12, 6e-12, 1)
    made_run(tmp_path / "b", 50.1, 0.2887**2, 6.00001e-12, 1)
    made_run(tmp_path / "c", 45.0, 0.3**2, 6e-12, 1)
    assert STUDY.measure(open_run(tmp_path / "b"))["velocity"] == pytest.approx(VELOCITIES[1], rel=1e-15)
    row = STUDY.measure(open_run(tmp_path / "c"))
    assert (row["velocity"], row["impact"]) == (45.0, pytest.approx(0.3, rel=1e-15))
    _, runs, said = answered(capsys, "viscous", tmp_path)
    assert runs == 2 and "b: the same grains, impact, velocity" in said


def test_weights_are_exact_for_one_and_for_the_square():
    squares = np.array(TWELFTHS)
    weights = offset_weights(squares)
    assert weights.sum() == pytest.approx(1, rel=1e-14)  # <1> = 1
    assert weights @ squares == pytest.approx(1 / 2, rel=1e-14)  # <B^2> = int 2 B B^2 dB
    uneven = np.array([0, 0.1, 0.5, 1.0])
    assert offset_weights(uneven) @ (3 - 2 * uneven) == pytest.approx(2, rel=1e-14)
    # of B^4 the trapezoidal rule has the error h^2/6
    assert weights @ squares**2 - 1 / 3 == pytest.approx(1 / 12**2 / 6, rel=1e-9)


def test_a_text_that_is_no_sizes():
    with pytest.raises(ValueError):
        sizes_from_text("3 fragments")


def test_threshold_of_made_data():
    """f_gro falls linearly in ln v through 0 at 55 m/s, whatever the velocities of the runs; the first fall counts."""
    velocities = 10 ** (0.1 * np.arange(13, 21))
    growth = 0.7 * np.log(55.0 / velocities)
    shifted = np.stack([growth, growth + 0.07, growth - 5, growth + 5])
    found = threshold_velocity(velocities, shifted)
    assert found[:2] == pytest.approx([55, 55 * np.exp(0.1)]) and np.isnan(found[2:]).all()
    assert np.isnan(threshold_velocity([10.0], np.array([0.5])))
    assert threshold_velocity([1.0, 10.0, 100.0, 1000.0], [1.0, -1.0, 1.0, -1.0]) == pytest.approx(10**0.5)


@pytest.mark.parametrize("exponent, amplitude", [(1.0, 1.0), (0.6, 2.0), (1.5, 30.0)])
def test_fits_recover_the_law(exponent, amplitude):
    """N_cum of the law itself, A22 eq 41."""
    numbers = np.unique(np.geomspace(1, 5000, 60).round())
    grains = amplitude * numbers ** (2 - exponent) / (2 - exponent)
    assert fragment_exponent(numbers, np.stack([grains, 7 * grains])) == pytest.approx([exponent] * 2, rel=1e-9)
    assert np.isnan(fragment_exponent(numbers, 0 * numbers)) and np.isnan(fragment_exponent([1, 2], [1.0, 2.0]))
