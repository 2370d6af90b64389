"""Functors and fused engine against tests/reference_law.py, the law once more in plain Python written from MODEL.md.

Positions and every energy channel, step by step, while rounding has not grown yet: measured, 3e-14 of a radius and
4e-14 of the energy at most. Everything is held to 1e-12. The one number that the reference takes as the plugin has
it is the number of terms in missed_at_pull_off(), whose remainder (1e-8) would show as 4e-11 of a radius after a
breaking."""

import pytest
import reference_law
from scenes import *

ENERGIES = ("kinetic", *reference_law.MODES, *reference_law.LOST)
TOLERANCE = 1e-12  # positions against a grain radius, energies against the scene's energy scale


def given():
    """What the reference needs: materials, radii, positions, velocities, spins."""
    names = "young poisson density surfaceEnergy criticalRolling viscoelasticTime".split()
    return dict(
        materials=[[getattr(b.mat, name) for name in names] for b in O.bodies],
        radii=[b.shape.radius for b in O.bodies],
        x=positions(),
        v=np.array([b.state.vel for b in O.bodies]),
        w=np.array([b.state.angVel for b in O.bodies]),
        dt=O.dt,
    )


def tracks(start, steps, step=0.1, neck=0, limit="held", **options):
    """What the reference is given, positions and energies of functors and engine after each of some steps, and the
    bonds that broke."""
    law = dict(neck=neck, limit=limit, **options)
    new_scene(step * unit, **law)
    start()
    found = {"given": {**given(), **law}}
    x, e = record(steps + 1)
    found["functors"] = x[:steps], e[1:]  # their energies are of the positions a step ago
    found["broken"] = broken() if neck else None
    new_scene(step * unit)
    start()
    fused_engine(**attributes(law))
    found["engine"] = record(steps)
    return found


def reference(given, steps, half_step):
    scene = reference_law.Scene(**given, half_step=half_step)
    tracks, energies = [], []
    for _ in range(steps):
        scene.step()
        tracks.append(scene.x)
        energies.append([scene.energies[name] for name in ENERGIES])
    return np.array(tracks), np.array(energies)


def compared(found, steps):
    """Largest differences of functors and engine from the reference (position [radii], energy [scale] by channel),
    and the last energies by name."""
    differences = {}
    for way, half_step in (("functors", True), ("engine", False)):
        x, e = found[way][0], np.array([[one[name] for name in ENERGIES] for one in found[way][1]])
        x_reference, e_reference = reference(found["given"], steps, half_step)
        scale = np.abs(e_reference).sum(axis=1).max()
        position = np.abs(x - x_reference).max() / min(found["given"]["radii"])
        differences[way] = position, dict(zip(ENERGIES, np.abs(e - e_reference).max(axis=0) / scale))
    return differences, dict(zip(ENERGIES, e_reference[-1]))


def grains(name):
    """How the grains of a scene start: a function."""
    one, other = ice(), soft()
    viscous, soft_viscous = ice(viscoelasticTime=2e-12), soft(viscoelasticTime=1e-12)
    return {
        "collision": lambda: converging(12, 1, [one], [1e-7], speed=8),
        "unlike": lambda: converging(12, 2, [one, other], [1e-7, 1.5e-7], speed=20),
        "viscous": lambda: converging(12, 3, [viscous], [1e-7], speed=12),
        "damped": lambda: converging(12, 4, [viscous, soft_viscous], [1e-7, 1.4e-7], speed=12),
        "cluster": lambda: cluster(10, 5, [one, other], [1e-7, 1.6e-7, 1.3e-7], speed=6, spin=1e8),
        "cut": lambda: converging(12, 1, [one, other], [1e-7, 1.5e-7], speed=12),
        "cut-viscous": lambda: cluster(10, 5, [viscous, soft_viscous], [1e-7, 1.3e-7], speed=6, spin=1e8),
        "factors": lambda: converging(12, 2, [one, other], [1e-7, 1.5e-7], speed=20),
        "springs damped": lambda: cluster(10, 5, [one, other], [1e-7, 1.6e-7, 1.3e-7], speed=6, spin=1e8),
        "springs damped, met": lambda: converging(12, 3, [viscous], [1e-7], speed=12),
        "springs damped, cut": lambda: cluster(10, 5, [viscous, soft_viscous], [1e-7, 1.3e-7], speed=6, spin=1e8),
        "springs damped, bonded": lambda: cluster(12, 7, [viscous, soft_viscous], [1e-7, 1.5e-7], speed=15, spin=1e8),
        "mixed, bonded": lambda: cluster(12, 7, [viscous, soft_viscous], [1e-7, 1.5e-7], speed=15, spin=1e8),
        "bonded": lambda: cluster(12, 4, [one], [1e-7], speed=10, spin=2e8),
        "bonded-viscous": lambda: cluster(12, 7, [viscous, soft_viscous], [1e-7, 1.5e-7], speed=15, spin=1e8),
    }[name]


# Time steps, what else the scene has, and the channels that must be at work.
CASES = {
    "collision": (300, {}, "sliding rolling twisting connection disconnection"),
    "unlike": (300, {}, "sliding rolling twisting connection"),
    "viscous": (300, {}, "sliding rolling twisting connection disconnection drag"),
    "damped": (300, {"damping": 0.01}, "sliding rolling twisting connection disconnection drag"),
    "cluster": (300, {}, "sliding rolling twisting disconnection"),
    "cut": (300, {"limit": "cut", "sliding_factor": 2}, "sliding rolling twisting connection"),
    "cut-viscous": (300, {"limit": "cut"}, "sliding rolling twisting drag"),
    "factors": (
        300,
        dict(sliding_factor=2.5, rolling_factor=8, mixed_factor=2.5),
        "sliding rolling twisting connection",
    ),
    "springs damped": (300, {"spring_damping": 1e-11}, "sliding rolling twisting disconnection springDamping"),
    "springs damped, met": (300, {"spring_damping": 1e-11}, "sliding rolling twisting connection drag springDamping"),
    "springs damped, cut": (300, {"limit": "cut", "spring_damping": 1e-11}, "sliding rolling twisting springDamping"),
    "springs damped, bonded": (250, {"neck": 0.5, "step": 0.05, "spring_damping": 1e-11}, "bondBreaking springDamping"),
    "mixed, bonded": (250, {"neck": 0.5, "step": 0.05, "mixed_factor": 0.4}, "bondBreaking sliding rolling twisting"),
    "bonded": (250, {"neck": 0.3, "step": 0.05}, "bondBreaking sliding rolling twisting"),
    "bonded-viscous": (250, {"neck": 0.5, "step": 0.05}, "bondBreaking sliding rolling twisting drag"),
}
MODES_THAT_BREAK = {"bonded": 4, "bonded-viscous": 2}


@pytest.mark.in_yade
@pytest.mark.parametrize("case", CASES)
def test_functors_and_engine_are_the_reference_law(case):
    steps, options, working = CASES[case]
    found = tracks(grains(case), steps, **options)
    differences, last = compared(found, steps)
    for name in working.split():
        channel = name if name in last and name not in reference_law.MODES else f"{name}Dissipation"
        assert last[channel] > 1e-4 * sum(map(abs, last.values())), name
    if case in MODES_THAT_BREAK:
        assert np.count_nonzero(found["broken"]) >= MODES_THAT_BREAK[case]
    for way, (position, energies) in differences.items():
        assert position < TOLERANCE, (way, position)
        assert max(energies.values()) < TOLERANCE, (way, energies)


def test_the_terms_that_the_plugin_sums_before_pull_off_are_exact_to_1e_8():
    fractions, missed = np.linspace(1e-6, 1, 50), reference_law.missed_at_pull_off
    assert max(abs(missed(g) - missed(g, terms=64)) for g in fractions) < 1e-8
