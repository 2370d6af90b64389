"""A vibrating chain under JKRWadaEngine, and how refusals are looked at."""

SCENE = """
from scenes import *
unit = constants(ice(), 1e-7)["timeUnit"]
def chain(count=4, speed=0.1, **options):
    'Touching grains in a row that vibrate, under the fused engine.'
    new_scene(0.1 * unit)
    d = 2e-7 - constants(ice(), 1e-7)["equilibriumOverlap"]
    for k in range(count):
        grain((k * d, 0, 0), 1e-7, ice() if k == 0 else O.bodies[0].material, (0, speed * (-1) ** k, 0))
    fused_engine(**options)
def said(call):
    'What a call is refused with, or an empty string.'
    try:
        call()
    except (RuntimeError, ValueError) as error:
        return str(error)
    return ""
def engine(): return O.engines[0]
"""


def refused(yade, script, cases, **parameters):
    """Each case (script text: words) is tried by the script, which leaves what it was refused with in result[case]: one line with these words in it."""
    found = yade(SCENE + script, {"cases": list(cases), **parameters})
    others = {
        case: found[case]
        for case, words in cases.items()
        if not found[case] or "\n" in found[case] or not all(word in found[case] for word in words)
    }
    assert not others, "\n".join(f"{case}: {message!r}" for case, message in others.items())
    return found
