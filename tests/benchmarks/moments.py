"""The files of the moments of the scenes' runs: grains with the springs of all contacts, reached by the engine itself.

They lie in build/bench/scenes: made once, they serve every version of the engine. A file is made again when the scene's
definition changes.
"""

import hashlib
import json
from dataclasses import replace
from math import log

import codes
import measured_scenes
import numpy as np
import scene_file
from measured_on import TOP

from analysis.measures.periodic_cell import filling_factor

FOLDER = TOP / "build/bench/scenes"
FAST_STRAIN = 1e-5  # 1/t0: at which the denser cells are made
RELAXED = 3000.0  # t0 at the paper's own rate before a denser cell is measured, in which what was stirred up dies down
LARGE = 1e6  # bytes of a scene's file from which on two threads pay


def path_of(name, moment, scene, folder=FOLDER):
    """File of a moment of a Scene; its name changes with the scene's definition."""
    made = [FAST_STRAIN, RELAXED] if scene.kind == "compression" else [scene.apart]
    definition = json.dumps([scene.kind, scene.parameters, scene.moments, *made, scene_file.FORMAT], sort_keys=True)
    key = hashlib.sha256(definition.encode()).hexdigest()[:8]
    return folder / f"{name}-{moment.replace(' ', '')}-{key}.scene"


def make(name, scene, folder=FOLDER, say=lambda words: None):
    """Start of a Scene, whose moments all have their files afterwards; what is there is not made again."""
    start = measured_scenes.start(scene)
    paths = {moment: path_of(name, moment, scene, folder) for moment in scene.moments}
    if not all(path.exists() for path in paths.values()):
        folder.mkdir(parents=True, exist_ok=True)
        (_make_cells if scene.kind == "compression" else _make_collision)(scene, start, paths, say)
    return start


def _make_collision(scene, start, paths, say):
    first, *later = paths.items()
    grains = start.scene.grains.copy()
    grains["position"] -= scene.apart * grains["velocity"]
    _save(first[1], replace(start.scene, grains=grains))
    begin, time = first[1].with_suffix(".begin"), 0.0
    _save(begin, start.scene)
    here = begin
    for moment, path in later:
        if not path.exists():
            say(f"making {path.name}")
            advance(here, path, (scene.moments[moment] - time) / start.step, start.together)
        here, time = path, scene.moments[moment]
    begin.unlink()


def _make_cells(scene, start, paths, say):
    """The denser cells are made at FAST_STRAIN, and then follow the paper's rate for RELAXED t0."""
    own, fast = start.scene.strain_rate.copy(), np.full(3, -2 * FAST_STRAIN / start.time_unit)
    here = next(iter(paths.values())).with_suffix(".fast")
    _save(here, start.scene.with_strain_rate(fast))
    for moment, path in paths.items():
        filling = scene.moments[moment]
        if filling is None:
            _save(path, start.scene)
            continue
        say(f"making {path.name}")
        relaxing, slowed = RELAXED * start.time_unit, path.with_suffix(".own")
        growth = log(filling / filling_of(scene_file.load(here)))
        growth += 3 * own[0] * relaxing  # less what the relaxation brings
        advance(here, here, growth / (-3 * fast[0]) / start.step, start.together)
        _save(slowed, scene_file.load(here).with_strain_rate(own))
        advance(slowed, path, relaxing / start.step, start.together)
        slowed.unlink()
    here.unlink()


def filling_of(scene):
    """Volume filling factor of a periodic SceneFile."""
    return filling_factor(scene.grains["radius"], scene.head["cellSize"])


def _save(path, scene):
    new = path.with_suffix(".new")
    scene_file.save(new, scene)
    new.replace(path)


def advance(begin, end, steps, together):
    """Take the scene of one file to another by the engine, so many small steps on, in whole O.steps."""
    new, threads = end.with_suffix(".new"), 2 if begin.stat().st_size > LARGE else 1  # the same bits
    steps = max(1, round(steps / together)) * together
    codes.harness(begin, steps=steps, together=together, threads=threads, out=new)
    new.replace(end)
