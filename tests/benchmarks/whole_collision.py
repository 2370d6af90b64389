"""Speed in each part of a collision, from the approach to fragments flying apart, beside that of the same grains while they approach at the usual speed: at 60 m/s the approach
lasts less than a measurement."""

import measured_scenes
from yade_process import YadeProcess


def estimate(settings):
    return sum(_one(radius, speed, duration) for radius, speed, duration in settings.collisions)


def _one(radius, speed, duration):
    """Slips cost more than other contact updates, and there are more at a higher speed."""
    return 12 + 2.5 * radius**3 * duration / 1.94e-11 / 75e6 * (1 + speed / 20)


def measure(settings, done):
    """[{"radius", "speed", "before": {threads: rate}, "parts": [{until [s], contacts, pieces, events, rate1, rate2}]}]; rates in contact updates a second."""
    found = []
    for radius, speed, duration in settings.collisions:
        found.append(collide(settings, radius, speed, duration))
        done(_one(radius, speed, duration))
    return found


def collide(settings, radius, speed, duration):
    calm, process = (YadeProcess("jkr-wada", "uniform", radius, v) for v in (measured_scenes.SPEED, speed))
    try:
        calm.wait(), process.wait()
        before = {threads: calm.ask("fused", seconds=settings.seconds, threads=threads)["rate"] for threads in (1, 2)}
        parts = process.ask("collision", duration=duration, parts=settings.collision_parts)
    finally:
        calm.close()
        process.close()
    return {"radius": radius, "speed": speed, "before": before, "parts": parts}
