"""The studies of elastoplastic aggregates (Arakawa et al. 2024) and of compressed ones: Andrews's model against its
integrated motion, and made runs whose answers are known."""

import re

import numpy as np
import pandas
import pytest
from scipy.integrate import solve_ivp
from written_runs import RADIUS, answered, facing, losing, record, two_pairs, write_run

from analysis.runs.folder import open_run
from analysis.studies import elastoplastic as a24
from analysis.studies.estimates import beside, estimate, estimates, mean, where
from analysis.theory import andrews
from analysis.theory.andrews import Spheres, critical_compression

MODULI, OFFSET, FILLING, DENSITY = (2.0e6, 20e6), 0.25 * RADIUS, 0.4, 1000.0


def integrated(velocity, spheres):
    """(times [s], compressions [m], velocities [m/s]) of Andrews's spheres until the largest compression and from
    there until they part, from the force alone (A24 eqs 23, 26, B15, B19, B23, B24)."""
    scale, critical = spheres.reduced_radius, critical_compression(spheres)
    mass, stiffness = 16 * np.pi / 3 * spheres.density * scale**3, 4 / 3 * spheres.young * scale**0.5

    def until(end, start, state, force):
        moving = lambda t, y: [y[1], -force(y[0] * scale) / (mass * scale)]
        end.terminal, end.direction = True, -1
        how = {"rtol": 1e-11, "atol": 1e-13 * velocity / scale, "method": "DOP853", "max_step": 2e-9}
        found = solve_ivp(moving, (start, start + 1e-5), state, events=end, **how)
        return found.t, *(scale * found.y)

    plastic = lambda d: np.pi * scale * spheres.yield_stress * (d - critical / 3)
    growing = lambda d: stiffness * max(d, 0.0) ** 1.5 if d <= critical else plastic(d)
    there = until(lambda t, y: y[1], 0.0, [0.0, velocity / scale], growing)
    apart = max(there[1][-1] - critical, 0.0)
    force = lambda d: stiffness * max(d - apart, 0.0) ** 0.5 * (d + 0.5 * apart)
    return there, until(lambda t, y: y[0] - apart / scale, there[0][-1], [there[1][-1] / scale, 0.0], force)


def made_run(path, size, velocity, seed, stretch=1.0, **parameters):
    """Write a run folder of two aggregates of two grains each that move as Andrews's spheres of radius `size` [grain
    radii] would, with compressions and times larger by the factor `stretch`."""
    spheres = Spheres(0.5 * (size * RADIUS + OFFSET), FILLING * DENSITY, *MODULI)
    at, compression, speed = np.concatenate(integrated(velocity, spheres), axis=1)
    contact = 2.0 * (RADIUS - OFFSET) / velocity
    time = np.linspace(0.0, contact + 2.0 * at[-1], 401)
    since = (time - contact) / stretch
    free = velocity * np.minimum(since, 0.0) + speed[-1] * np.maximum(since - at[-1], 0.0)
    d = stretch * (np.interp(since, at, compression) + free) - 2.0 * OFFSET
    v = np.interp(since, at, speed)
    kinetic, touching = 1e-15 * v**2, (time > contact) & (time < contact + stretch * at[-1])
    own = dict(kinetic=kinetic, slidingDissipation=1e-15 * velocity**2 - kinetic, contacts=2 + touching)
    history = losing(time, touching=touching, d=d, v=v, **own)
    two = dict(one=[[0, 0, 0], [0, 2 * RADIUS, 0]], pairs=[[0, 1]], reach=size * RADIUS)
    states = [facing(time[k], d[k], v[k], **two, touching=touching[k]) for k in range(0, 401, 50)]
    scene = dict(packing="cpe", material="ice", filling=FILLING, radius=size, velocity=velocity, seed=seed)
    about = record(size * RADIUS, {**scene, "impact": 0.0, "stepFraction": 0.1, **parameters})
    return write_run(path, about, history, states)


# ---- Andrews's model against its integrated motion, its limits and A24's numbers ----


V = 10**0.5
PAPER = Spheres(0.5 * 80.271e-7, 400.0, 2.25e6, 15.7e6)


@pytest.mark.parametrize(
    "own", [PAPER, (2e-6, 400.0, 1.7e6, 80e6), (4e-6, 400.0, 3.2e6, 15.7e6), (4e-6, 300.0, 9e6, 5e6)]
)
def test_closed_forms_agree_with_the_integrated_force(own):
    """The paper's, mostly plastic, just beyond yield, and elastic throughout."""
    spheres = own if own is PAPER else Spheres(*own)
    there, back = integrated(V, spheres)
    assert andrews.largest_compression(V, spheres) == pytest.approx(there[1][-1], rel=1e-8)
    assert andrews.time_of_largest_compression(V, spheres) == pytest.approx(there[0][-1], rel=1e-6)
    assert andrews.restitution(V, spheres) == pytest.approx(-back[2][-1] / V, rel=1e-6)


def test_limits_are_reached():
    elastic, rigid = Spheres(4e-6, 400.0, np.inf, 14.6e6), Spheres(4e-6, 400.0, 1.67e6, np.inf)
    whole, plastic = andrews.elastic_compression(V, elastic), andrews.plastic_compression(V, rigid)
    eq_33 = 2 * np.pi / 3**0.5 * (400 / 1.67e6) ** 0.5 * 4e-6
    limits = (elastic, whole, 1.4716 * whole / V, 1.0), (rigid, plastic, eq_33, 0.0)
    for spheres, largest, time, restitution in limits:
        assert andrews.largest_compression(V, spheres) == pytest.approx(largest)
        assert andrews.time_of_largest_compression(V, spheres) == pytest.approx(time, rel=1e-4)
        assert andrews.restitution(V, spheres) == restitution


def test_numbers_of_the_paper():
    """Its best fits give its delta_max/R* (eqs 19, 21), and section 4.3.2 the ends of Fig. 10."""
    assert andrews.largest_compression(V, PAPER) / PAPER.reduced_radius == pytest.approx(0.113, abs=5e-4)
    loose = Spheres(1.0, 300.0, 0.428e6, 4.96e6)
    assert andrews.largest_compression(V, loose) == pytest.approx(0.199, abs=5e-4)
    assert andrews.young_if_elastic(0.113, V, 400.0) == pytest.approx(14.6e6, abs=0.05e6)
    assert andrews.stress_if_rigid(0.113, V, 400.0) == pytest.approx(1.67e6, abs=0.005e6)


# ---- the study ----


TRUTH = a24.Aggregates(MODULI[0], 1.0 / MODULI[1], OFFSET / RADIUS, FILLING * DENSITY)
VELOCITIES = [10 ** (0.1 * i) for i in (1, 3, 5, 7)]


def test_the_truth_comes_out_of_made_runs(tmp_path):
    """Three sizes at A24's velocity, four velocities at R = 80 r, four pairs that scatter by 2 %, but not in the mean.
    Pairs 1 and 2 of R = 40 r with drag too, which lets them go 5 and 4 % deeper."""
    made = []
    for size in (40.0, 60.0, 80.0):
        for velocity in VELOCITIES if size == 80.0 else [a24.VELOCITY]:
            for seed, stretch in enumerate((1.02, 0.98, 1.01, 0.99), 1):
                path = tmp_path / f"R{size:g}-v{velocity:.3f}-s{seed}"
                made.append(made_run(path, size, velocity, seed, stretch))
    for seed, stretch in ((1, 1.07), (2, 1.02)):
        made.append(made_run(tmp_path / f"drag{seed}", 40.0, a24.VELOCITY, seed, stretch, viscoelasticTime=3e-12))
    runs = a24.STUDY.runs(pandas.DataFrame([a24.STUDY.measure(open_run(path)) for path in made]))
    plain = a24.once(runs[~runs.changed])
    assert len(runs) == 26 and len(plain) == 24
    for size, velocity in ((40.0, a24.VELOCITY), (60.0, a24.VELOCITY), (80.0, VELOCITIES[0])):
        own = where(plain, radius=size, velocity=velocity)
        d, t = (estimate(mean(column), own) for column in ("d", "t"))
        assert (d.value, t.value) == pytest.approx(TRUTH.at(size, velocity), rel=5e-3) and d.pairs == 4
    *_, offset, slope, _ = estimates(a24.size_line, where(plain, velocity=a24.VELOCITY))
    expected = (TRUTH.at(80.0, a24.VELOCITY)[0] - TRUTH.at(40.0, a24.VELOCITY)[0]) / 20.0
    assert slope.value == pytest.approx(expected, rel=2e-3) and offset.value == pytest.approx(TRUTH.offset, abs=0.01)
    stress, soft = estimates(lambda r: a24.moduli(a24.papers_way(r)), plain)
    assert abs(stress.value - TRUTH.stress) < 5 * stress.error and abs(soft.value - TRUTH.compliance) < 5 * soft.error
    forty = where(plain, radius=40.0)
    change = beside(mean("d"), a24.once(where(runs, viscoelasticTime=3e-12)), forty)
    assert change.value == pytest.approx(0.045 * (TRUTH.at(40.0, a24.VELOCITY)[0] + 2 * TRUTH.offset), rel=0.02)
    assert change.pairs == 2


# ---- the study of compressed aggregates beside CPE ones ----


def collision(path, seed, compressed):
    packing = {"packing": "compressed", "filling": 0.401, "nominal": 0.4, "aggregateRadius": 20 * RADIUS}
    own = {"targetPacking": {**packing, "cell": seed}, "projectilePacking": {**packing, "filling": 0.399}}
    kind = "file" if compressed else "cpe"
    two_pairs(path, 3.0, seed, derived=own if compressed else {}, packing=kind, filling=0.4, radius=20.0)


def test_both_kinds_from_the_first_touch_on(tmp_path, capsys):
    """They touch at 101 ns and turn around at 200 ns, 99^2/200 ns times v nearer."""
    for seed in (1, 2, 3):
        for compressed in (0, 1):
            collision(tmp_path / f"{compressed}-{seed}", seed, compressed)
    two_pairs(tmp_path / "other", 3.0, 1, packing="file")
    found, runs, err = answered(capsys, "compressed", tmp_path)
    assert runs == 6 and "neither CPE aggregates nor spheres cut out" in err
    found = {re.sub(r", φ = 0.4, 3 m/s.*?(?= \[|$)", "", what): row["ours"] for what, row in found.items()}
    deepest = pytest.approx(3.0 * 99e-9**2 / 200e-9 / RADIUS, rel=1e-3)
    # A24 eqs 31 and 44, of spheres of 400 kg/m^3 with R* = 10 r
    over = 16 / 3 * 400 * 3.0**2 / (0.1 * deepest.expected) ** 2 / (0.47e6 * (1 / 0.4 - 1 / 0.74) ** -3)
    for kind in ("CPE", "compressed"):
        assert found[f"compression from the first touch to d_max, {kind} [r]"] == deepest
        assert found[f"yield stress over A24's static one, {kind}"] == pytest.approx(over, rel=3e-3)
    assert found["compression, compressed over CPE"] == pytest.approx(1.0)
