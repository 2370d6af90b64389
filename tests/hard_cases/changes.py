"""A vibrating chain under JKRWadaEngine, what a script may do to it, and what it is refused with."""

from scenes import *


def chain(count=4, speed=0.1, **options):
    """Touching grains in a row that vibrate, under the fused engine."""
    new_scene(0.1 * unit)
    d = 2e-7 - constants(ice(), 1e-7)["equilibriumOverlap"]
    for k in range(count):
        grain((k * d, 0, 0), 1e-7, ice() if k == 0 else O.bodies[0].material, (0, speed * (-1) ** k, 0))
    fused_engine(**options)


def engine():
    return O.engines[0]


def steps(number):
    """So many calls of O.step."""
    for _ in range(number):
        O.step()


def run(text, **names):
    """Execute a script's text, which sees these names, and those here."""
    exec(text, {**globals(), **names})


def require_refused(cases, attempt):
    """Each case (text: words) of what attempt(text) does is refused with one line that has these words."""
    others = {}
    for text, words in cases.items():
        message = said(lambda: attempt(text))
        if not message or "\n" in message or not all(word in message for word in words):
            others[text] = message
    assert not others, "\n".join(f"{text}: {message!r}" for text, message in others.items())
