"""The limit rule `cut` (Sirono & Ueno 2017, section 3.2) on pairs, against closed forms: energy a cut, run-out, mean resistance, order of convergence."""

import numpy as np
import pytest

PAIR = """
from scenes import *
RADIUS, INERTIA = 1e-7, 0.4 * 4 / 3 * np.pi * 1e-21 * 1000 * 1e-14
SPINS = dict(sliding=((0, 0, 1), (0, 0, 1)), rolling=((0, 0, 1), (0, 0, -1)), twisting=((1, 0, 0), (-1, 0, 0)))
RATE = dict(sliding=2 * RADIUS, rolling=RADIUS, twisting=2) # of the displacement, at these spins
def spring(mode):
    "(stiffness, limit)"
    c, name = constants(ice(), RADIUS), mode.capitalize()
    return c[mode + "Stiffness"], c["critical" + name]
def pair(mode, step, spin, limit, blocked, engine="functors"):
    "Two grains at equilibrium along x, turning at `spin` against each other so that this mode alone is strained."
    c = constants(ice(), RADIUS)
    new_scene(step * c["timeUnit"], limit=limit)
    for x, axis in zip((0, 2 * RADIUS - c["equilibriumOverlap"]), SPINS[mode]):
        grain((x, 0, 0), RADIUS, ice(), spin=spin * np.array(axis), blocked=blocked)
    if engine == "fused": fused_engine(limit=limit)
def spin_of(mode): return O.bodies[0].state.angVel[0 if mode == "twisting" else 2]
"""


@pytest.mark.parametrize("engine", ["functors", "fused"])
@pytest.mark.parametrize("mode", ["rolling", "sliding", "twisting"])
def test_run_out_of_a_pair_that_turns_freely(yade, mode, engine):
    """Centres held. With n + f times the energy e = k crit^2/2 a cut spring is cut n times and stops at (n + f^(1/2)) crit, having dissipated n e; a held one
    stops at (1 + n + f)/2 crit. Errors of second order: root mean square over five f, at steps a factor 4 apart; first order would give 4."""
    found = yade(
        PAIR
        + """
mode, (k, crit) = parameters["mode"], spring(parameters["mode"])
def run(limit, cuts, step):
    pair(mode, step, np.sqrt(cuts * 0.5 * k * crit**2 / INERTIA), limit, "xyz", parameters["engine"])
    fused = parameters["engine"] == "fused"
    O.engines[0].prepare() if fused else O.step()
    first, scale, ran, worst = total_energy(), energies()["kinetic"], 0, 0
    while spin_of(mode) > 0:
        spin = spin_of(mode)
        O.step()
        if fused: spin = (spin + max(0, spin_of(mode))) / 2 # the functors have it half-way through the step
        ran += spin * RATE[mode] * O.dt / crit
        worst = max(worst, abs(total_energy() - first) / scale)
        assert O.iter < 20000
    O.step()
    e = energies()
    others = sum(e[n] for n in ("slidingDissipation", "rollingDissipation", "twistingDissipation") if n != mode + "Dissipation")
    return [ran, e[mode + "Dissipation"] / (0.5 * k * crit**2), worst, others / e[mode + "Dissipation"]]
for step in (0.05, 0.0125):
    result[step] = [run("cut", 20 + f, step) for f in (0.18, 0.34, 0.5, 0.66, 0.82)]
result["held"] = run("held", 20.5, 0.0125)
""",
        {"mode": mode, "engine": engine},
    )
    fractions = np.array([0.18, 0.34, 0.5, 0.66, 0.82])
    coarse, fine = np.array(found["0.05"]), np.array(found["0.0125"])
    error = [np.sqrt(np.mean((rows[:, 1] - 20) ** 2)) for rows in (coarse, fine)]
    closure = [np.sqrt(np.mean(rows[:, 2] ** 2)) for rows in (coarse, fine)]
    print(mode, engine, error, closure)
    assert fine[:, 0] == pytest.approx(20 + np.sqrt(fractions), rel=1e-3)
    assert found["held"][0] == pytest.approx(21.5 / 2, rel=2e-3)
    assert error[1] < 2e-3 and error[0] / error[1] > 9, error
    assert closure[0] < 2e-4 and closure[0] / closure[1] > 9, closure
    assert np.abs(fine[:, 3]).max() < 1e-12


@pytest.mark.parametrize("mode", ["rolling", "sliding", "twisting"])
def test_mean_resistance_is_half_of_that_at_the_limit(yade, mode):
    """Spins held at a given value over 16.5 limits: the mean torque is half of the one at the limit, which `held` keeps, and 16 cuts take k crit^2/2 each."""
    found = yade(
        PAIR
        + """
mode, (k, crit) = parameters["mode"], spring(parameters["mode"])
for limit in ("held", "cut"):
    pair(mode, 0.1, 16.5 * crit / RATE[mode] / (2000 * 0.1 * constants(ice(), RADIUS)["timeUnit"]), limit, "xyzXYZ")
    axis, torques = 0 if mode == "twisting" else 2, []
    for _ in range(2001):
        O.step()
        torques.append(abs(O.forces.t(0)[axis]))
    e = energies()
    result[limit] = dict(torque=float(np.mean(torques)), stored=e[mode] / (0.5 * k * crit**2), lost=e[mode + "Dissipation"] / (0.5 * k * crit**2))
result["largest"] = k * crit * dict(sliding=RADIUS, rolling=RADIUS / 2, twisting=1)[mode]
""",
        {"mode": mode},
    )
    held, cut = found["held"], found["cut"]
    assert cut["torque"] == pytest.approx(found["largest"] / 2, rel=2e-2)
    assert held["torque"] == pytest.approx(found["largest"], rel=4e-2)  # half of it over the first limit of 16.5
    assert cut["lost"] == pytest.approx(16, rel=2e-3) and cut["stored"] == pytest.approx(0.25, rel=3e-2)
    assert held["lost"] == pytest.approx(31, rel=2e-3) and held["stored"] == pytest.approx(1, rel=1e-3)


def test_a_rule_of_another_name_is_refused_in_one_line(yade):
    found = yade(
        PAIR
        + """
try: Law2_ScGeom_JKRWadaPhys_JKRWada(limit="broken")
except ValueError as error: result["functors"] = str(error)
pair("rolling", 0.1, 0, "held", "", "fused")
O.engines[0].limit = "Cut"
result["engine"] = refusal()
O.engines[0].limit = "held"
O.step()
O.engines[0].limit = "cut"
result["later"] = refusal()
"""
    )
    assert found["functors"] == "limit = 'broken': must be 'held' or 'cut'"
    assert found["engine"] == "JKRWadaEngine: limit = 'Cut': must be 'held' or 'cut'"
    assert "limit was changed after the start: it must stay 'held', not 'cut'" in found["later"]
