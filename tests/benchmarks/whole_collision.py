"""Speed in each part of a collision, from the approach to fragments flying apart, beside the speed of the same scene before it."""
from yade_process import YadeProcess


def estimate(settings):
    contacts, steps = 2.5 * settings.reference**3, settings.collision_duration / 1.94e-11
    return 5 + 1.2 * contacts * steps / 75e6


def measure(settings, done):
    """{"before": {threads: rate}, "parts": [{until [s], contacts, pieces, events, rate1, rate2}]}; rates in contact updates a second."""
    process = YadeProcess("jkr-wada", "alike", settings.reference, settings.collision_speed)
    try:
        before = {threads: process.ask("fused", seconds=settings.seconds, threads=threads)["rate"] for threads in (1, 2)}
        parts = process.ask("collision", duration=settings.collision_duration, parts=settings.collision_parts)
    finally:
        process.close()
    done(estimate(settings))
    return {"before": before, "parts": parts}
