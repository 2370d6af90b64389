"""Springs with damping: the closed form of one that rings down, and that an aggregate comes to rest."""

import pytest
from scenes import *

pytestmark = pytest.mark.in_yade
R = 1e-7  # of a grain of ice [m]


def ringing(mode, step):
    """A pair set ringing in one mode, at a hundredth of its limit, for 60 t0: the largest error of the mode's stored
    energy over its largest value; over the kinetic energy at the start, what was dissipated and the largest error of
    the ledger. The closed form: D'' + 2 g D' + w^2 D = 0 with g = w^2 c/2."""
    c = constants(ice(), R)
    k, distance, reduced = c[f"{mode}Stiffness"], 2 * R - c["equilibriumOverlap"], c["reducedMass"]
    inertia = 0.4 * 2 * reduced * R**2
    across = 2 * R / distance
    lightness = {  # w^2/k
        "sliding": across**2 / reduced + 2 * R**2 / inertia,
        "rolling": c["reducedRadius"] ** 2 * 2 / inertia,
        "twisting": 2 / inertia,
    }[mode]
    square = k * lightness
    time = 0.3 / np.sqrt(square)  # c
    decay = square * time / 2
    frequency = np.sqrt(square - decay**2)
    rate = 0.01 * c[f"critical{mode.capitalize()}"] * frequency  # of D at the start
    new_scene(step * c["timeUnit"], "fused", spring_damping=time)
    push = rate / lightness  # that sets it in motion: an impulse, angular over R for rolling, or angular
    motions = {
        "sliding": ([0, across * push / 2 / reduced, 0], [0, 0, R * push / inertia], [0, 0, R * push / inertia]),
        "rolling": (
            [0, 0, 0],
            [0, 0, c["reducedRadius"] * push / inertia],
            [0, 0, -c["reducedRadius"] * push / inertia],
        ),
        "twisting": ([0, 0, 0], [push / inertia, 0, 0], [-push / inertia, 0, 0]),
    }
    velocity, *spins = (np.array(v) for v in motions[mode])
    grain((0, 0, 0), R, ice(), velocity, spins[0])
    grain((distance, 0, 0), R, ice(), -velocity, spins[1])
    O.engines[0].prepare()
    start, errors, sums = energies()["kinetic"], [], []
    total = total_energy()
    for _ in range(int(60 / step)):
        O.step()
        e = energies()
        now = rate / frequency * np.exp(-decay * O.time) * np.sin(frequency * O.time)
        errors.append(e[mode] - k / 2 * now**2)
        sums.append(total_energy() - total)
    largest = k / 2 * (rate / frequency) ** 2
    return np.abs(errors).max() / largest, e["springDamping"] / start, np.abs(sums).max() / start


@pytest.mark.parametrize("mode", ["sliding", "rolling", "twisting"])
def test_a_spring_rings_down_as_the_closed_form_with_second_order(mode):
    (coarse, _, _), (fine, lost, ledger) = ringing(mode, 0.08), ringing(mode, 0.02)
    assert fine < 3e-3 and coarse / fine > 10  # second order gives 16
    assert mode != "sliding" or lost == pytest.approx(1, abs=1e-3)
    assert ledger < 1e-5


def spread_of_spins(**options):
    """How far spins differ after 1,500 t0, over the start, in a chain of three whose normal motion is damped."""

    def spread():
        return np.std([b.state.angVel for b in O.bodies], axis=0).max()

    new_scene(0.1 * unit, "fused", damping=0.05, **options)
    cluster(3, 3, [ice()], [R], speed=0.05, spin=3e6)
    first = spread()
    steps(15000)
    return spread() / first


def test_an_aggregate_comes_to_rest():
    assert spread_of_spins() > 0.1
    assert spread_of_spins(spring_damping=1e-10) < 0.01
