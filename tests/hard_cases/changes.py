"""A vibrating chain under JKRWadaEngine, what a script may do to it, and what it is refused with."""

from scenes import *


def chain(count=4, speed=0.1, mover="fused", **options):
    """Touching grains in a row that vibrate, under the fused engine."""
    new_scene(0.1 * unit, mover, **options)
    d = 2e-7 - constants(ice(), 1e-7)["equilibriumOverlap"]
    for k in range(count):
        grain((k * d, 0, 0), 1e-7, ice() if k == 0 else O.bodies[0].material, (0, speed * (-1) ** k, 0))


def engine():
    return O.engines[0]


def run(text, **names):
    """Execute a script's text, which sees these names, and those here."""
    exec(text, {**globals(), **names})


def require_refused(cases, attempt):
    """Each case (text: words) of what attempt(text) does is refused with one line that has these words."""
    others = {}
    for text, words in cases.items():
        message = message_of(lambda: attempt(text))
        if not message or "\n" in message or not all(word in message for word in words):
            others[text] = message
    assert not others, "\n".join(f"{text}: {message!r}" for text, message in others.items())


SETTINGS = """subSteps threads domains instructions linearDamping slidingStiffnessFactor rollingStiffnessFactor
    springDamping mixedSurfaceEnergyFactor neck sliding rolling twisting limit orientations
    exportInteractions""".split()


def same(**other):
    """An engine with the settings of the present one, but for these."""
    return JKRWadaEngine(**{**{name: getattr(engine(), name) for name in SETTINGS}, **other})


# What is refused at the next step (what, how it is undone), and words of the refusal; {i}: a grain.
UNDONE = {
    "O.bodies[{i}].shape.radius *= 2 | O.bodies[{i}].shape.radius /= 2": ["the radius of body 2 was changed"],
    "O.bodies[{i}].state.mass *= 2 | O.bodies[{i}].state.mass /= 2": ["the mass of body 2 was changed", "must stay"],
    "O.bodies[{i}].mask = 2 | O.bodies[{i}].mask = 1": ["the mask of body 2 was changed"],
    "kept = O.bodies[{i}].material; O.bodies[{i}].material = soft() | O.bodies[{i}].material = kept": [
        "the material of body 2 was changed"
    ],
    "kept = O.bodies[{i}].state; O.bodies[{i}].state = State() | O.bodies[{i}].state = kept": [
        "the state of body 2 was changed"
    ],
    "O.bodies[0].material.surfaceEnergy *= 2 | O.bodies[0].material.surfaceEnergy /= 2": ["surfaceEnergy", "body 0"],
    "kept = engine().linearDamping; engine().linearDamping = 0.5 | engine().linearDamping = kept": [
        "linearDamping was changed",
        "must stay 0, not 0.5",
    ],
    "engine().subSteps *= -1 | engine().subSteps *= -1": ["subSteps = -1: must be >= 1"],
    "O.dt *= 1024 | O.dt /= 1024": ["the small step O.dt/subSteps is", "must be above 0 and below"],
    "O.periodic = not O.periodic | O.periodic = not O.periodic": ["O.periodic was changed"],
    "kept = O.bodies[{i}]; O.bodies.erase({i}) | O.bodies.insertAtId(kept, {i}); engine().exportInteractions = False": [
        "body 2 was erased after the start"
    ],
    "grain((2e-6, 0, 0), 1e-7, ElastMat()) | O.bodies.erase(len(O.bodies) - 1)": [
        "must be a sphere or a Wall of JKRMat"
    ],
    "O.engines += [NewtonIntegrator()] | O.engines = O.engines[:-1]": ["NewtonIntegrator is among O.engines too"],
    "kept = Vector3(O.bodies[{i}].state.vel); O.bodies[{i}].state.vel = Vector3(float('nan'), 0, 0)"
    " | O.bodies[{i}].state.vel = kept": ["body 2 was given", "not a finite number"],
    "O.forces.addF({i}, Vector3(float('nan'), 0, 0)) | O.forces.reset(False)": [
        "O.forces has",
        "body 2",
        "must be finite",
    ],
}
