"""The limit rule `cut` (Sirono & Ueno 2017, section 3.2) on pairs, against closed forms: energy a cut, run-out (so the
mean resistance), order of convergence."""

import pytest
from scenes import *

pytestmark = pytest.mark.in_yade
MODES_OF_PAIRS = ["rolling", "sliding", "twisting"]
RADIUS, INERTIA = 1e-7, 0.4 * 4 / 3 * np.pi * 1e-21 * 1000 * 1e-14
SPINS = dict(sliding=((0, 0, 1), (0, 0, 1)), rolling=((0, 0, 1), (0, 0, -1)), twisting=((1, 0, 0), (-1, 0, 0)))
RATE = dict(sliding=2 * RADIUS, rolling=RADIUS, twisting=2)  # of the displacement, at these spins


def spring(mode):
    """(stiffness, limit)"""
    c = constants(ice(), RADIUS)
    return c[mode + "Stiffness"], c["critical" + mode.capitalize()]


def pair(mode, step, spin, limit, blocked, mover):
    """Two grains at equilibrium along x, turning at `spin` against each other so that this mode alone is strained."""
    new_scene(step * unit, mover, limit=limit)
    for x, axis in zip((0, 2 * RADIUS - constants(ice(), RADIUS)["equilibriumOverlap"]), SPINS[mode]):
        grain((x, 0, 0), RADIUS, ice(), spin=spin * np.array(axis), blocked=blocked)


def run_out(mode, mover, limit, cuts, step):
    """(way [limits], dissipated [k crit^2/2], closure, dissipated by other modes over that) of a pair with so many k
    crit^2/2 until it stands."""
    k, crit = spring(mode)
    axis, fused = 0 if mode == "twisting" else 2, mover == "fused"

    def spin():
        return O.bodies[0].state.angVel[axis]

    pair(mode, step, np.sqrt(cuts * 0.5 * k * crit**2 / INERTIA), limit, "xyz", mover)
    O.engines[0].prepare() if fused else O.step()
    first, scale, ran, worst = total_energy(), energies()["kinetic"], 0, 0
    while spin() > 0:
        before = spin()
        O.step()
        # the functors have it half-way through the step
        ran += ((before + max(0, spin())) / 2 if fused else before) * RATE[mode] * O.dt / crit
        worst = max(worst, abs(total_energy() - first) / scale)
        assert O.iter < 20000
    O.step()
    lost = {other: energies()[other + "Dissipation"] for other in MODES_OF_PAIRS}
    own = lost.pop(mode)
    return ran, own / (0.5 * k * crit**2), worst, sum(lost.values()) / own


@pytest.mark.parametrize("mover", ["functors", "fused"])
@pytest.mark.parametrize("mode", MODES_OF_PAIRS)
def test_run_out_of_a_pair_that_turns_freely(mode, mover):
    """Centres held. With n + f times the energy e = k crit^2/2 a cut spring is cut n times and stops at (n + f^(1/2))
    crit, having dissipated n e; a held one stops at (1 + n + f)/2 crit. Errors of second order: root mean square over
    five f, at steps a factor 4 apart; first order would give 4."""
    fractions = np.array([0.18, 0.34, 0.5, 0.66, 0.82])
    coarse, fine = (np.array([run_out(mode, mover, "cut", 20 + f, step) for f in fractions]) for step in (0.05, 0.0125))
    error = [rms(rows[:, 1] - 20) for rows in (coarse, fine)]
    closure = [rms(rows[:, 2]) for rows in (coarse, fine)]
    assert fine[:, 0] == pytest.approx(20 + np.sqrt(fractions), rel=1e-3)
    assert error[1] < 2e-3 and error[0] / error[1] > 9
    assert closure[0] < 2e-4 and closure[0] / closure[1] > 9
    assert np.abs(fine[:, 3]).max() < 1e-12
    assert run_out(mode, mover, "held", 20.5, 0.0125)[0] == pytest.approx(21.5 / 2, rel=2e-3)


def test_a_rule_of_another_name_is_refused():
    with pytest.raises(ValueError, match="^limit = 'broken': must be 'held' or 'cut'$"):
        Law2_ScGeom_JKRWadaPhys_JKRWada(limit="broken")
