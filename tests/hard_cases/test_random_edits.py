"""Edits of a running scene by a script, each and at random: obeyed with the ledger closed, or refused in one line; none
is silent.

`make test-edits` runs a thousand sequences. A failure names the seed, the scene and the edits."""

import os
import random

import pytest
from changes import *

pytestmark = pytest.mark.in_yade
BATCH = 50
SEQUENCES = int(os.environ.get("EDITS", BATCH))
SMALL_STEP = 0.05 * unit if "yade" in sys.modules else 0
STEPS = 12  # between two edits
CLOSED = 5e-3  # of the energies in a step; integration's error, of second order, has been 2.8e-3
BOOKED = ("constraintWork", "externalWork", "boundaryWork")


# ---- scenes ----


def colliding(**options):
    new_scene(SMALL_STEP)
    converging(27, 1, [ice()], [1e-7])
    fused_engine(subSteps=10, **options)


def dragged():
    new_scene(SMALL_STEP)
    converging(27, 1, [ice(viscoelasticTime=1e-12), soft()], [1e-7, 1.2e-7])
    fused_engine(subSteps=10)


def touching(finer=1, **options):
    new_scene(SMALL_STEP / finer)
    cluster(12, 3, [ice()], [1e-7], 0.3, 3e6)
    fused_engine(subSteps=10, **options)


def on_walls():
    touching()
    low, high = (getattr(positions()[:, 2], end)() for end in ("min", "max"))
    for z, speed in ((low - 0.99e-7, 0.05), (high + 1.05e-7, -0.05)):
        wall = O.bodies[O.bodies.append(utils.wall(float(z), axis=2, material=O.bodies[0].material))]
        wall.state.vel = (0, 0, speed)


def shrinking():
    colliding()
    periodic_cell(3e-6, 3e-6, 3e-6, velocity_gradient=(-1e5, 0, 0))


SCENES = {
    "colliding": colliding,
    "cut": lambda: colliding(limit="cut", linearDamping=0.01),
    "dragged": dragged,
    "touching": touching,
    "bonded": lambda: touching(3, neck=0.4),  # bonds are stiff
    "walls": on_walls,
    "periodic": shrinking,
    "orientations": lambda: touching(orientations=True),
}


# ---- edits: texts of a script; {i}, {j}: two grains, {x}, {y}, {z}: numbers from -1 to 1 ----


def free_place(y):
    """Where nothing is: beside the grains, as high as the first."""
    return 1.2e-6 + 2.1e-7 * (len(list(O.bodies)) % 5), 1e-6 * y, O.bodies[0].state.pos[2]


def dead_for_a_step():
    engine().dead = True
    O.step()
    engine().dead = False


def no_engine_for_a_step(new):
    O.engines = []
    O.step()
    O.engines = [new]


def by_functors_and_back():
    """Two O.steps of the engine, by the functors' steps."""
    new, dt, O.trackEnergy = same(), O.dt, True  # the functors book nothing without
    O.dt /= new.subSteps
    factors = new.slidingStiffnessFactor, new.rollingStiffnessFactor
    O.engines = functor_engines(new.linearDamping, 0, new.neck, *factors, limit=new.limit)
    O.engines[2].loopOnSortedInteractions = True
    steps(2 * new.subSteps)
    O.engines = [new]
    O.dt = dt


# The run is the same with and without them.
NEUTRAL = """
O.engines = [same()]

old = engine(); O.engines = [same()]; engine().prepare(); O.engines = [old]
engine().label = "mover"; O.engines = O.engines; engine().writeInteractions(); O.engines = [same(label="mover")]
O.save("a.yade")
saved_and_loaded(); O.engines = [same()]
O.save("a.yade"); O.step(); O.load("a.yade")
dead_for_a_step()
no_engine_for_a_step(same())
engine().prepare()
engine().writeInteractions()
utils.unbalancedForce()
contact_law.snapshot()
engine().threads = 2
engine().exportInteractions = True
O.forces.reset(False)
engine().exportInteractions = False
O.trackEnergy = False
O.trackEnergy = True
engine().giveWay()
O.bodies[{i}].state.vel *= 2; O.bodies[{i}].state.vel /= 2
""".strip().splitlines()
NOT_IN_CELLS = "for_a_step"  # a cell changes while nothing moves the grains, which the engine refuses
# Kinetic energy changes by what is given; otherwise the ledger is closed.
BOOKED_EDITS = """
O.bodies[{i}].state.vel += Vector3({x}, {y}, {z})
O.bodies[{i}].state.angVel += 1e7 * Vector3({x}, {y}, {z})
O.bodies[{i}].state.vel = Vector3.Zero
O.bodies[{i}].state.blockedDOFs = "xyzXYZ"
O.bodies[{i}].state.blockedDOFs = "xZ"
O.bodies[{i}].state.blockedDOFs = ""
O.dt *= 0.5
O.dt *= 1.25
engine().subSteps += 2
O.forces.setPermF({i}, 1e-9 * Vector3({x}, {y}, {z}))
O.forces.setPermT({i}, 1e-17 * Vector3({x}, {y}, {z}))
O.forces.setPermF({i}, Vector3.Zero)
O.forces.addF({i}, 3e-9 * Vector3({x}, {y}, {z}))
O.engines = [ForceResetter()] + O.engines; O.engines = O.engines[1:]
grain(free_place({y}), 1e-7, O.bodies[0].material)
grain(free_place({y}), 1e-7, ice(), (-3, {z}, 0))
O.engines = [same(limit="cut")]
O.engines = [same(linearDamping=0.02)]
O.dt /= 3; contact_law.sinter(0.3)
by_functors_and_back()
O.engines = [same(slidingStiffnessFactor=1.5)]
O.engines = [same(rolling=False)]
O.bodies[0].material.surfaceEnergy *= 1.05; O.engines = [same()]
O.bodies[0].material.viscoelasticTime = 2e-12; O.engines = [same()]
O.bodies[{i}].material = soft(); O.engines = [same()]
""".strip().splitlines()
# What they do to the energies isn't known beforehand.
UNKNOWN = """
O.bodies[{i}].state.pos += 3e-9 * Vector3({x}, {y}, {z})
O.bodies[{i}].state.pos += Vector3(8e-7, {y} * 1e-6, 8e-7)
O.bodies[{i}].state.mass *= 1.5; O.engines = [same()]
O.bodies[{i}].shape.radius *= 0.999; O.engines = [same()]
old = same(); O.engines = functor_engines(0, 0, old.neck); O.trackEnergy = True; O.step(); O.engines = [old]
""".strip().splitlines()
IN_CELLS = """
O.cell.velGrad = Matrix3({x} * 1e5, 0, 0, 0, {y} * 1e5, 0, 0, 0, 0)
O.cell.velGrad = Matrix3({x} * 1e5, 0, 0, 0, {y} * 1e5, 0, 0, 0, 0); engine().prepare()
O.cell.velGrad = Matrix3.Zero
""".strip().splitlines()
WITH_WALLS = """
O.bodies.append(utils.wall(-1.3e-6, axis=0, material=O.bodies[0].material))
wall = O.bodies[O.bodies.append(utils.wall(-1.3e-6, axis=1, material=O.bodies[0].material))]; wall.state.vel = (0, 3, 0)
O.bodies[12].state.vel = (0, 0, {z} / 5)
""".strip().splitlines()
REFUSED = list(UNDONE)  # after which the run is as without


def edits_of(rng, scene):
    """(kind, text) each of a few edits."""
    kinds = {"neutral": NEUTRAL, "booked": BOOKED_EDITS, "unknown": UNKNOWN, "refused": REFUSED}
    if scene == "periodic":
        kinds["cell"] = IN_CELLS
    if scene in ("walls", "touching", "colliding"):
        kinds["wall"] = WITH_WALLS[: 2 + (scene == "walls")]
    sequence = []
    for _ in range(rng.randint(1, 6)):
        kind = rng.choices(list(kinds), [5, 4, 1, 2, 2][: len(kinds)])[0]
        numbers = {name: round(rng.uniform(-1, 1), 3) for name in "xyz"}
        sequence.append((kind, rng.choice(possible(kinds[kind], scene)).format(i=rng.randrange(12), **numbers)))
    return sequence


def possible(texts, scene):
    return [text for text in texts if scene != "periodic" or NOT_IN_CELLS not in text]


# ---- what must hold ----


def kinetic():
    """Of the grains as they are now [J]."""
    states = [b.state for b in O.bodies if b and isinstance(b.shape, Sphere)]
    return sum(0.5 * s.mass * s.vel.squaredNorm() + 0.5 * s.inertia[0] * s.angVel.squaredNorm() for s in states)


def obeyed_or_refused(call):
    """What a call is refused with, in one line, or ''."""
    message = message_of(call)
    assert len(message.splitlines()) <= 1, message
    return message


class Ledger:
    """Sum of all channels, from step to step."""

    reference = None

    def step(self, given):
        """After a step; given: kinetic energy that an edit before it gave, or None (unknown)."""
        if given is None:
            self.reference = None
        elif self.reference is not None:
            self.reference += given
        if not O.trackEnergy:
            return
        e = energies(*BOOKED)
        now, scale = sum(e.values()), e["kinetic"] + e["connection"] + abs(e["externalWork"])
        assert np.isfinite(now)
        if self.reference is not None:
            assert abs(now - self.reference) < CLOSED * scale, "the ledger is not closed"
        self.reference = now


def edited(scene, sequence):
    """Play a sequence; (positions, energies, contact pairs, refusal that ended it or '')."""
    SCENES[scene]()
    O.dt *= 10
    steps(60)
    ledger, names = Ledger(), {}
    ledger.step(None)
    for kind, text in sequence:
        before, change = kinetic(), text.split(" | ")[0]
        refused = obeyed_or_refused(lambda: run_in(change, names))
        if kind == "refused":
            time, refused = O.time, obeyed_or_refused(O.step)
            assert refused and O.time == time, f"{change}: was not refused"
            run_in(text.split(" | ")[1], names)
        given = None if kind in ("unknown", "cell") or "wall" in text or "functors" in text else kinetic() - before
        if kind in ("neutral", "refused"):
            given = 0
        for k in range(STEPS):
            refused = obeyed_or_refused(O.step)
            if refused:
                assert kind not in ("neutral", "refused"), f"{text}: then {refused}"
                return None, None, None, refused
            ledger.step(given if k == 0 else 0)
    O.trackEnergy = True
    O.step()
    ledger.step(0)
    return positions(), energies(*BOOKED), sorted(map(sorted, contact_law.snapshot()["contact_pairs"].tolist())), ""


def run_in(text, names):
    exec(text, globals(), names)


def require(scene, sequence):
    """What must hold in a sequence; a twin run without what must not matter ends in the same state."""
    x, e, pairs, end = edited(scene, sequence)
    without = [("neutral", "pass") if kind in ("neutral", "refused") else (kind, text) for kind, text in sequence]
    y, f, others, same_end = edited(scene, without)
    assert end == same_end
    if end:
        return
    assert pairs == others and np.abs(x - y).max() < 1e-5 * 1e-7
    scale = e["kinetic"] + e["connection"]
    wrong = {name: (e[name] - f[name]) / scale for name in e if abs(e[name] - f[name]) > 1e-5 * scale}
    assert not wrong


@pytest.mark.parametrize("scene", SCENES)
def test_no_trace_is_left_of_what_is_neutral_or_refused_and_undone(scene):
    edits = [("neutral", text) for text in possible(NEUTRAL, scene)]
    edits += [("refused", text) for text in possible(REFUSED, scene)]
    edits = [(kind, text.format(i=k % 12)) for k, (kind, text) in enumerate(edits)]
    for k in range(0, len(edits), 8):
        require(scene, edits[k : k + 8])


@pytest.mark.parametrize("batch", range(-(-SEQUENCES // BATCH)))
def test_no_edit_is_silent(batch):
    failures = []
    for seed in range(BATCH * batch, BATCH * (batch + 1)):
        rng = random.Random(seed)
        scene = rng.choice(list(SCENES))
        sequence = edits_of(rng, scene)
        print(f"{seed}: {scene}, {sequence}", flush=True)  # the last line when YADE crashes
        try:
            require(scene, sequence)
        except AssertionError as what:
            failures.append(f"{seed}: {scene}, {sequence}: {what}")
    assert not failures, "\n".join(failures)
