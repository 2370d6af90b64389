"""Measures the engine, and LAMMPS, at the moments of the papers' runs (paper_scenes.py)."""

import json
import subprocess
from dataclasses import asdict, dataclass

import engine_parts
import measured_scenes
import paper_scenes
import peers
import scene_file
from measured_on import HERE

from analysis.theory import Material

FEWEST_PEER_STEPS, PEER_UPDATES = 20, 1e7  # of grains: large scenes take fewer steps


@dataclass(frozen=True)
class Settings:
    """rounds; seconds: of one of their measurements; stretch: fraction of a run's small steps that measuring a moment may take; peer_steps (at most), skins: of LAMMPS,
    whose best skin [grain radii] counts; sampled: seconds of one thread for the parts of the time."""

    rounds: int = 5
    seconds: float = 2.0
    stretch: float = 0.05
    peer_steps: int = 100
    skins: tuple = (0.3, 0.6, 1.0)
    sampled: float = 3.0


FULL = Settings()
QUICK = Settings(rounds=3, seconds=0.5, stretch=0.03, peer_steps=30, skins=(0.6,), sampled=1.0)


def measure(name, moment, settings, begin=None, scene=None, folder=paper_scenes.FOLDER):
    """What was measured at a moment of a scene, whose file must be there (paper_scenes.make); begin: its Start, if that has been made already:

    {"engine": answer of yade_papers.py, "parts": {part: fraction of the time of one thread} or None,
    "lammps": {threads: {"msPerStep", "contacts", "skin"}} or {"missing": why not},
    "run": {"steps": of the whole run, "step" [t0], "progress": how far along the moment is}, "settings": of Settings}.
    """
    scene = scene or paper_scenes.SCENES[name]
    path = paper_scenes.path_of(name, moment, scene, folder)
    begin = begin or paper_scenes.start_of(scene)
    engine = measure_engine(path, begin, settings)
    return {
        "engine": engine,
        "parts": engine_parts.fractions(path, begin.together, steps_to_sample(engine, begin, settings)),
        "lammps": measure_lammps(path, scene, settings),
        "run": {
            "steps": begin.steps,
            "step": round(float(begin.scene.head["step"]) / begin.time_unit, 6),
            "progress": begin.progress[moment],
        },
        "settings": settings_of(settings),
    }


def steps_to_sample(engine, begin, settings):
    """Small steps that take settings.sampled seconds, but no more than measuring takes."""
    fastest = min(turn["seconds"] / turn["steps"] for turn in engine["turns"])
    return max(begin.together, int(min(settings.sampled / fastest, settings.stretch * begin.steps)))


def settings_of(settings):
    """As a JSON file gives them back."""
    return json.loads(json.dumps(asdict(settings)))


def measure_engine(path, begin, settings):
    """The answer of yade_papers.py. Raises RuntimeError with YADE's last words."""
    request = {"scene": str(path), "together": begin.together, "rounds": settings.rounds, "seconds": settings.seconds}
    request["most"] = int(settings.stretch * begin.steps)
    command = ["yade", "-n", "-x", "-j1", str(HERE / "yade_papers.py"), json.dumps(request)]
    done = subprocess.run(command, capture_output=True, text=True)
    answers = [line[len("ANSWER ") :] for line in done.stdout.splitlines() if line.startswith("ANSWER ")]
    if not answers:
        raise RuntimeError(f"YADE ended without an answer on {path}:\n{done.stderr[-2000:]}")
    return json.loads(answers[0])


def measure_lammps(path, scene, settings):
    """{threads: the run with the skin that is best for it}, or {"missing": why there is none}."""
    reason = peers.missing("lammps") if scene.lammps else "it has no sintered bonds"
    if reason:
        return {"missing": reason}
    grains, found = scene_of_peers(scene_file.load(path)), {}
    steps = min(settings.peer_steps, max(FEWEST_PEER_STEPS, int(PEER_UPDATES / grains.grains)))
    try:
        for cores in peers.core_counts():
            runs = {skin: peers.measure("lammps", grains, steps, cores, skin) for skin in settings.skins}
            skin, best = max(runs.items(), key=lambda one: one[1]["rate"])
            ms = 1e3 * best["seconds"] / best["steps"]
            found[str(cores)] = {"msPerStep": ms, "contacts": best["contacts"], "skin": skin}
    except peers.PeerFailed as error:
        return {"missing": "failed: " + " ".join(str(error).split())[:200]}
    return found


def scene_of_peers(scene):
    """The grains of a SceneFile as measured_scenes.Scene; without the springs of their contacts, and drag."""
    grains, (material,) = scene.grains, scene.materials
    names = ("young", "poisson", "density", "surfaceEnergy", "criticalRolling")
    return measured_scenes.Scene(
        grains["position"],
        grains["velocity"],
        grains["radius"],
        grains["material"],
        (Material(*(float(material[name]) for name in names)),),
        float(scene.head["step"]),
        spin=grains["angularVelocity"],
        edge=float(scene.head["cellSize"][0]),
    )
