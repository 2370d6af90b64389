"""Contact updates a second of every code, in rounds: each round measures all of them once, so that ratios are taken between neighbours in time."""

from contextlib import ExitStack, contextmanager
from dataclasses import dataclass

import measured_scenes
import peers
from quiet import fraction_of_others
from yade_process import YadeProcess

SLOWER_SETS = ("avx2", "portable")
UNLIKE = ("materials", "radii")


@dataclass(frozen=True)
class Task:
    """One measurement: labels of its result; which YADE to ask (law, kind, radius, its -j), None for a peer; the request; seconds it takes about."""

    labels: dict
    process: tuple
    request: dict
    seconds: float


def engine(settings, radius, threads, kind="uniform", instructions=""):
    labels = {
        "code": "engine",
        "kind": kind,
        "radius": radius,
        "threads": threads,
        "instructions": instructions or "best",
    }
    request = {"do": "fused", "seconds": settings.seconds, "threads": threads, "instructions": instructions}
    return Task(labels, ("jkr-wada", kind, radius, 1), request, 4 / 3 * settings.seconds + 0.3 + 8e-6 * 0.8 * radius**3)


def loop(settings, law, radius, threads):
    """YADE's own loop with this repository's law (functors) or with the stock one."""
    labels = {
        "code": {"jkr-wada": "functors", "stock": "stock"}[law],
        "kind": "uniform",
        "radius": radius,
        "threads": threads,
        "instructions": "",
    }
    return Task(
        labels,
        (law, "uniform", radius, threads),
        {"do": "loop", "seconds": settings.loop_seconds},
        4 / 3 * settings.loop_seconds + 0.5,
    )


def peer(settings, code, cores):
    labels = {"code": code, "kind": "uniform", "radius": settings.reference, "threads": cores, "instructions": ""}
    return Task(
        labels,
        None,
        {"steps": settings.peer_steps, "cores": cores},
        1 + settings.peer_steps * 0.8 * settings.reference**3 * 3 / 7e6,
    )


def tasks_of_a_round(settings):
    """The tasks, in the order in which a round measures them: what is compared stands together."""
    others = [radius for radius in settings.radii if radius != settings.reference]
    loops = [(law, threads) for law in ("jkr-wada", "stock") for threads in (1, 2)]
    codes = [
        [loop(settings, "stock", settings.reference, cores)]
        + [
            peer(settings, code, cores)
            for code in peers.PROGRAMS
            if not peers.missing(code) and cores in peers.core_counts()
        ]
        for cores in (1, 2)
    ]
    tasks = [engine(settings, radius, threads) for radius in others for threads in (1, 2)]
    tasks += [
        engine(settings, radius, 1, instructions=name) for radius in settings.instruction_radii for name in SLOWER_SETS
    ]
    tasks += [
        loop(settings, law, radius, threads)
        for radius in settings.loop_radii
        if radius != settings.reference
        for law, threads in loops
    ]
    tasks += [loop(settings, "jkr-wada", settings.reference, threads) for threads in (1, 2)]
    tasks += codes[1]
    tasks += [
        engine(settings, settings.reference, threads, kind) for kind in UNLIKE + ("uniform",) for threads in (2, 1)
    ]
    return tasks + codes[0]


def estimate(settings):
    """Seconds that measure() takes about."""
    starting = 10 + 6e-5 * sum(0.8 * radius**3 for radius in settings.radii)
    return starting + settings.rounds * (1 + sum(task.seconds for task in tasks_of_a_round(settings)))


@contextmanager
def yades(tasks):
    """The YADEs that the tasks ask, started together: {process of the task: YadeProcess}."""
    with ExitStack() as stack:
        started = {}
        for key in sorted({task.process for task in tasks if task.process}):
            law, kind, radius, threads = key
            started[key] = YadeProcess(law, kind, radius, measured_scenes.SPEED, threads)
            stack.callback(started[key].close)
        yield started


def measure(settings, done):
    """{"results": [labels, round and what was measured], "memory": {radius: ...}, "others": largest fraction of the machine that other programs took,
    "failed": {peer: last words of one that ended with an error, and was not tried again}}.

    done(seconds) is called after each measurement with its estimated length.
    """
    tasks, results, others, failed = tasks_of_a_round(settings), [], 0.0, {}
    peers_scene = measured_scenes.make("uniform", settings.reference)
    with yades(tasks) as started:
        for process in started.values():
            process.wait()
        done(estimate(settings) - settings.rounds * (1 + sum(task.seconds for task in tasks)))
        for turn in range(settings.rounds):
            others = max(others, fraction_of_others())
            done(1)
            for task in tasks:
                answer = take(task, started, peers_scene, failed)
                if answer:
                    results.append(
                        {**answer, **task.labels, "round": turn, "instructions_used": answer.get("instructions", "")}
                    )
                done(task.seconds)
        memory = {
            radius: started["jkr-wada", "uniform", radius, 1].ask("memory")
            for radius in settings.radii
            if radius >= settings.reference
        }
    return {"results": results, "memory": memory, "others": others, "failed": failed}


def take(task, started, peers_scene, failed):
    """What a task measured; None of a peer that fails, now or in an earlier round: noted in failed, {name: last words}."""
    if task.process:
        return started[task.process].ask(**task.request)
    name = f"{task.labels['code']} on {task.labels['threads']}"
    if name in failed:
        return None
    try:
        return peers.measure(task.labels["code"], peers_scene, **task.request)
    except peers.PeerFailed as error:
        failed[name] = str(error)
