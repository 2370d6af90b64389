"""Collisions of two aggregates, or of one and a plate (A24 section 3; A22 section 2.4; S17): parameters, scene, series.

In a collision with a plate (target=wall) the plate is at rest at x = 0, and the aggregate comes along -x.
"""

from dataclasses import dataclass, replace
from math import ceil, cos, radians, sin, sqrt

import numpy as np

from analysis.measures.compression import compression_and_velocity
from analysis.measures.decided import REBOUND_PER_RADIUS, RECENT, has_come_to_rest, rebound_time
from analysis.measures.outcome import NEVER_MET
from analysis.measures.plate import has_plate, with_plate
from analysis.runs.folder import open_run
from analysis.runs.format import COLLISION, RESTING, value_text
from analysis.runs.measured import outcome_of_run
from yade_scripts import packings, time_step
from yade_scripts.materials import derived_materials, pair_constants, require_small_contacts
from yade_scripts.packings import aggregate
from yade_scripts.packings.aggregate import MOST_GRAINS, NAMED_PACKING, AggregateParameters, make
from yade_scripts.packings.packing import SUM, arrays_of_grains, random_stream, sum_of_file
from yade_scripts.packings.placing import START_GAP, first_touch, offset_pair, velocities_of
from yade_scripts.parameters import POSITIVE, SWITCH, Check, ParameterError, Usual, between, one_of, parameter
from yade_scripts.run.kind import Ending, Estimate, Kind, Scene
from yade_scripts.run.parameters import RunParameters

AGGREGATE, WALL = "aggregate", "wall"  # targets
RANDOM = "random"
SPIN = Check("any number, positive counterclockwise about the axis", lambda x: True)
AXIS = 0  # across a plate
# radii of the larger aggregate that fluffy ones move at `velocity` in the default duration: of 100 collisions of small
# ones 10 are undecided then, 30 after 4 radii, 3 after 24, for 0.75 and 1.3 times the processor's time
WAY = 12
# At 3e3 m/s BCCA aggregates of ice broke down with the default step, at 2e3 they did not.
VELOCITY = Usual(1e-6, 1e3, "thermal motion of aggregates to a third of sound in ice")
LARGEST_NECK = 0.7  # the largest of S17
NECK = Check(
    f"0, or above that of a contact (ice: 0.1237) and at most {LARGEST_NECK}", lambda x: 0 <= x <= LARGEST_NECK
)
IMPACT_RADII = 4  # of the larger aggregate, that the two move with the shorter step: both diameters
CHECKS = 100  # times in a run that it is looked whether pieces are apart


@dataclass(frozen=True)
class CollisionParameters(AggregateParameters, RunParameters):
    """The collision."""

    velocity: float = parameter(10**0.5, POSITIVE, "relative velocity of the aggregates", "m/s", usual=VELOCITY)
    target: str = parameter(AGGREGATE, one_of([AGGREGATE, WALL]), "what meets one: another, or a plate of its material")
    impact: float | str = parameter(
        0.0,
        between(0, 1),
        "impact parameter B_off over the sum of the characteristic radii (A22 eq 27; cpe: of the spheres' radii); "
        f"{RANDOM}: the seed's, its square uniform, as collisions have it (itself, with planar = 1)",
        "1",
        word=RANDOM,
    )
    impactAngle: float | None = parameter(
        None, Check(">= 0 and below 90", lambda x: 0 <= x < 90), "target = wall: from its normal to the way (0)", "deg"
    )
    projectileGrains: int | None = parameter(
        None, between(1, MOST_GRAINS), "grains of the projectile, with packing = bcca or bpca (as many as grains)"
    )
    spin: float = parameter(0.0, SPIN, "of the target, about its centre, or of what meets a plate", "rad/s")
    projectileSpin: float = parameter(0.0, SPIN, "of the projectile", "rad/s")
    spinAxis: str = parameter("z", one_of("xyz"), "about which it spins, z being across way and offset")
    projectileSpinAxis: str = parameter("z", one_of("xyz"), "likewise of the projectile")
    projectileFile: str | None = parameter(
        None, NAMED_PACKING, "the projectile's packing (file: the same, not turned: each grain meets its own image)"
    )
    neck: float = parameter(
        0.0, NECK, "neck radius over grain radius of the bonds that aggregates start with; 0: no bonds (S17)", "1"
    )
    duration: float | None = parameter(
        None,
        POSITIVE,
        f"time that is simulated (until the first touch, and {REBOUND_PER_RADIUS} t0 per grain radius of the "
        f"aggregates' radius: 12.5 ns for ice; others than cpe at least until they have moved by {WAY} radii)",
        "s",
    )
    impactStepFraction: float | None = parameter(
        None, POSITIVE, "shorter step until the aggregates have flown through each other, four radii after touch", "t0"
    )
    endWhenApart: int | None = parameter(
        None,
        SWITCH,
        "1: the run ends as soon as no pieces can meet until duration (straight lines of the spheres around them) and "
        "no piece is in motion within itself that could break it (1 where no duration is given, else 0)",
    )

    ONLY_WITH = [
        ("projectileGrains", "packing", aggregate.MOST_GROWN),
        ("projectileFile", "packing", ["file"]),
        ("impactStepFraction", "engine", ["fused"]),
        *((name, "target", [AGGREGATE]) for name in ("projectileGrains", "projectileFile", "impact", "neck")),
        *((name, "target", [AGGREGATE]) for name in ("projectileSpin", "projectileSpinAxis")),
        ("impactAngle", "target", [WALL]),
        # bonds start at rest, of equal grains
        *((name, "neck", [0]) for name in ("sizes", "initialOverlap")),
    ]

    def filled_in(self):
        """As AggregateParameters, with endWhenApart; refuses what doesn't go together."""
        if self.neck and len(self.material_names) > 1:
            raise ParameterError(f"material = {self.material}: given with neck = {self.neck:g}; must be one material")
        found = super().filled_in()
        short, step = found.impactStepFraction, found.stepFraction
        if short is not None and (step == time_step.AUTO or not step / 100 <= short < step):
            must = "must be below a number given as stepFraction, and at least a hundredth of it"
            raise ParameterError(f"impactStepFraction = {short:g}: given with stepFraction = {step}; {must}")
        if found.projectileGrains is not None:
            aggregate.require_growable(found.packing, "projectileGrains", found.projectileGrains)
        if found.neck and found.packing != "file":  # a file may name its material
            _require_sintered(found.neck, pair_constants(found))
        if found.planar and {found.spinAxis, found.projectileSpinAxis} != {"z"}:
            raise ParameterError("spinAxis: given with planar = 1; must be z")
        if found.impact == RANDOM:
            share = random_stream(found.seed, 0, 3).random()  # of the cross-section within
            found = found.changed(impact=float(share if found.planar else np.sqrt(share)))
        if found.endWhenApart is None:
            found = found.changed(endWhenApart=int(found.duration is None))
        return found

    @property
    def spins(self):
        """Angular velocities (3,) [rad/s] of target and projectile, or of the one that meets a plate."""
        of = ((self.spin, self.spinAxis), (self.projectileSpin, self.projectileSpinAxis))
        return [rate * np.eye(3)["xyz".index(axis)] for rate, axis in (of[:1] if self.target == WALL else of)]

    def of_projectile(self):
        """The parameters from which the projectile is made."""
        return self.changed(grains=self.projectileGrains or self.grains, file=self.projectileFile or self.file)

    def title(self):
        """collide-ice-f0.4-R20-v3-s1, collide-ice-bcca-N1024-v3-s1 ..., and the names of what is in it."""
        size = f"f{value_text(self.filling)}-R{value_text(self.radius)}" if self.packing == "cpe" else self.packing
        size += f"-N{self.grains}" if self.is_grown else ""
        target = f"{WALL}-" if self.target == WALL else ""
        in_name = ("target", "material", "packing", "filling", "radius", "grains", "velocity", "seed")
        return f"collide-{target}{self.material}-{size}-v{value_text(self.velocity)}-s{self.seed}", in_name


# ---- the time step ----


def complete(parameters, constants, threads):
    """The parameters with what depends on the contact and on YADE's threads. Raises ParameterError."""
    require_small_contacts(parameters)
    _require_sintered(parameters.neck, constants)
    return with_step(parameters, constants).with_threads(threads)


def with_step(parameters, constants):
    """time_step.with_step() of a collision."""
    error = lambda: time_step.collision_error(parameters, constants)
    depends_on = "neck, filling and drag" if parameters.neck else "filling and drag"
    return time_step.with_step(parameters, step_limit(parameters, constants), error, depends_on)


def step_limit(parameters, constants, radii=None):
    """Largest stable stepFraction [t0] of a collision of grains of one size, or of radii (smallest, largest) [m]."""
    filling = time_step.equivalent_filling(parameters.packing, parameters.filling, parameters.planar, constants)
    return time_step.limit_of(parameters, constants, filling, radii)


def require_stable_with(parameters, constants, pair):
    """Raise ParameterError when the step or contacts are too large for the smallest grain of a pair of packings."""
    radii = np.concatenate([packing.radius for packing in pair])
    smallest, largest = float(radii.min()), float(radii.max())
    if smallest != largest:
        require_small_contacts(parameters, smallest)
        limit = step_limit(parameters, constants, (smallest, largest))
        time_step.require_stable(parameters.stepFraction, limit, "filling and drag, with grains of these sizes")


def _require_sintered(neck, constants):
    """Raise ParameterError for a neck (radii of a grain) that is thinner than the contact itself."""
    unsintered = constants["equilibriumContactRadius"] / (2 * constants["reducedRadius"])
    if 0 < neck <= unsintered:
        must = f"must be 0 (not sintered), or above {unsintered:.4g} and at most {LARGEST_NECK}"
        raise ParameterError(f"neck = {neck:g}: no thicker than a contact that is not sintered; {must}")


# ---- the scene ----


def prepare(parameters, threads, constants=None):
    """The Scene of a collision; called within YADE, or with the constants of materials.pair_constants()."""
    if constants is None:
        from yade_scripts.run import scene as yade_scene

        constants = yade_scene.pair_constants(parameters, parameters.neck)
    parameters = complete(parameters, constants, threads)
    parameters, pair, velocities = place(parameters, constants["equilibriumOverlap"])
    for packing in pair:
        packings.require_connected(packing)
    require_stable_with(parameters, constants, pair)
    touch = _time_of_touch(parameters, pair, velocities, constants.get("bond"))
    if parameters.duration is None:
        duration = default_duration(parameters, parameters.radius, constants["timeUnit"], touch or 0.0)
        parameters = parameters.changed(duration=duration)
    aggregate_radius = parameters.radius * parameters.grainRadius
    controls, shorter, reason = [], None, time_step.reason(parameters, step_limit(parameters, constants))
    if parameters.impactStepFraction is not None:
        until = (touch or 0.0) + _duration_of_impact(parameters)
        shorter = ShorterStep(parameters, until)
        controls.append(shorter.control)
        short, step = parameters.impactStepFraction, parameters.stepFraction
        reason = f"as given: {short:g} t0 until {until:.4g} s, then {step:g} t0"
    rest = Rest(parameters, constants, aggregate_radius, touch) if parameters.endWhenApart else None
    if rest:
        controls.append(_end_when_apart(rest))

    def build():
        from yade_scripts.run import scene as yade_scene

        materials = yade_scene.materials_of(parameters)
        yade_scene.add_bodies(pair, velocities, materials, bool(parameters.planar), parameters.spins)
        if parameters.target == WALL:
            yade_scene.add_plane(AXIS, 0.0, materials[0])

    resting = {RESTING: np.nan} if rest else {}
    return Scene(
        parameters=parameters,
        constants=constants,
        derived={**_sizes(aggregate_radius, pair, parameters), **({} if touch is None else {"firstTouch": touch})},
        grains=arrays_of_grains(pair),
        build=build,
        placed=(pair, velocities),
        rest=rest,
        shorter=shorter,
        series=lambda state: {**series(state, aggregate_radius), **resting},
        law={"neck": parameters.neck},
        step_choice=reason,
        control=lambda recorder, state: any([control(recorder, state) for control in controls]),
    )


def place(parameters, overlap):
    """(parameters, packings, velocities (3,) [m/s]) of target and projectile, or of the one that meets the plate, in
    their places; the parameters with radius, filling and grains of the larger aggregate where it is not a CPE one.
    overlap: of touching grains [m]."""
    if parameters.target == WALL:
        packing = make(parameters, overlap, 0)
        if parameters.packing != "cpe":
            parameters = _with_size(parameters, [packing])
        gap = START_GAP * packing.radius.max() - (packing.position[:, AXIS] - packing.radius).min()
        placed, angle = packings.moved(packing, (gap, 0.0, 0.0)), radians(parameters.impactAngle or 0.0)
        return parameters, [placed], [parameters.velocity * np.array([-cos(angle), sin(angle), 0.0])]
    pair = [make(parameters, overlap, 0), make(parameters.of_projectile(), overlap, 1)]
    if parameters.packing == "cpe":
        # A24 section 3: centres at -/+(R_agg + r) in x; offset in y as in A22 eq 27
        reach = (parameters.radius + 1) * parameters.grainRadius
        centre = np.array([reach, parameters.impact * reach, 0.0])
        pair = [packings.moved(pair[0], -centre), packings.moved(pair[1], centre)]
        velocities = [-own for own in velocities_of(pair, np.array([parameters.velocity, 0.0, 0.0]))]
    else:
        parameters = _with_size(parameters, pair)
        pair, velocities = offset_pair(*pair, parameters.velocity, parameters.impact)
    return parameters, pair, velocities


def _with_size(parameters, pair):
    """The parameters with radius, filling and grains of the aggregates that were made or read."""
    if parameters.neck and len(np.unique([radius for packing in pair for radius in packing.radius])) > 1:
        given = f"given with grains of unlike size in {parameters.file}"
        raise ParameterError(f"neck = {parameters.neck:g}: {given}; must be 0")
    extents = [packings.extent(packing) / parameters.grainRadius for packing in pair]
    radius, dimensions = max(extents) or 1.0, 2 if parameters.planar else 3  # 1: of single grains
    grains = pair[int(np.argmax(extents))].radius / parameters.grainRadius
    filling = float((grains**dimensions).sum() / radius**dimensions)
    return parameters.changed(radius=radius, filling=filling, grains=pair[0].grains)


def _sizes(aggregate_radius, pair, parameters):
    """Entries of run.json about the aggregates, with packing = file also how they were made."""
    found = {"aggregateRadius": aggregate_radius, "grainsPerAggregate": pair[0].grains}
    if parameters.atRest:
        found["largestMotion"] = max(packing.parameters.get("largestMotion", 0.0) for packing in pair)
    names = ("projectile",) if parameters.target == WALL else ("target", "projectile")
    for name, packing in zip(names, pair):
        if parameters.packing == "file":
            found[f"{name}Packing"] = {**packing.parameters, "seed": packing.seed}
        found[f"{name}Grains"] = packing.grains
        found[f"{name}GyrationRadius"] = packings.gyration_radius(packing)
        found[f"{name}CharacteristicRadius"] = packings.characteristic_radius(packing)
    return found


def _time_of_touch(parameters, pair, velocities, bond):
    """Time [s] until grains first touch, sintered ones shrunk, as if none spun, or None."""
    if parameters.target == WALL:
        return float((pair[0].position[:, AXIS] - pair[0].radius).min() / -velocities[0][AXIS])
    if bond:
        pair = [replace(packing, radius=np.full(packing.grains, bond["shrunkRadius"])) for packing in pair]
    return first_touch(*pair, velocities[1] - velocities[0])


def default_duration(parameters, radius, time_unit, touch):
    """Duration [s] of a run that gives none: close-packed aggregates rebound within rebound_time(), fluffy ones move
    through each other first. radius: of the larger one in grain radii; time_unit: t0 [s]; touch: when they do [s]."""
    way = 0.0 if parameters.packing == "cpe" else WAY * radius * parameters.grainRadius / parameters.velocity
    return touch + max(rebound_time(radius, time_unit), way)


def series(state, aggregate_radius):
    """{name: value} of a collision's own series; state: as contact_law.snapshot(), with `aggregate`; R_agg [m]."""
    if has_plate(state):
        d, v = aggregate_radius - state["position"][:, AXIS].mean(), -state["velocity"][:, AXIS].mean()
        return {"d": d, "v": v, "contacts_between": len(state["plane_contacts"])}
    d, v = compression_and_velocity(state["position"][:, 0], state["velocity"][:, 0], aggregate_radius)
    sides = state["aggregate"][state["contact_pairs"]]
    return {"d": d, "v": v, "contacts_between": int(np.count_nonzero(sides[:, 0] != sides[:, 1]))}


class Rest:
    """Whether a collision has come to rest: for endWhenApart, of a scene of YADE or on a device.

    touch: when aggregates first touch [s], None: never; aggregate_radius [m]."""

    def __init__(self, parameters, constants, aggregate_radius, touch):
        self._known = {**constants, **(constants.get("bond") or {}), **derived_materials(parameters.of_each())}
        self._known.update(aggregateRadius=aggregate_radius, grainRadius=parameters.grainRadius)
        self._known.update(density=parameters.density)
        self._touch, self._end = touch, parameters.duration
        # before it none has had the time to rebound
        self.earliest = -np.inf if touch is None else touch + rebound_time(parameters.radius, constants["timeUnit"])

    def seems_so(self, state):
        """1.0 or 0.0: whether no piece seems to change any more (analysis.measures.decided)."""
        begin = -np.inf if self._touch is None else self._touch
        return float(has_come_to_rest(with_plate(state), self._known, begin, self._end))

    def needed(self, time):
        """For how long [s] it must have seemed so at a time [s]."""
        return RECENT * (time - (self._touch or 0.0))


def _end_when_apart(rest):
    """Scene.control of endWhenApart."""

    def control(recorder, state):
        if not recorder.is_one_of(CHECKS):
            return False
        recorder.note(RESTING, rest.seems_so(state))
        recent = recorder.recent(RESTING, rest.needed(state["time"]))
        return bool(np.all(recent[np.isfinite(recent)]))

    return control


def ending(folder):
    """Ending of the run in a folder, as analysis.measures.outcome and .decided have it."""
    found = outcome_of_run(open_run(folder))
    pieces = f"{found.fragments} piece{'s' * (found.fragments > 1)}"
    words = f"{pieces}, the largest {found.mass_fractions[0]:.4g} of the mass"
    if found.kind != NEVER_MET:
        words += f", growth {found.growth_efficiency:.4g}"
    return Ending(found.kind, words, found.why_undecided)


# ---- a shorter step at the impact ----
#
# Most of the error of a collision's ledger arises while aggregates fly through each other, when many contacts form and
# grains meet at the full velocity: of two BPCA of 50,000 grains at 50 m/s, 96 % in the first eighth of A22's time.


def _duration_of_impact(parameters):
    """How long [s] the shorter step holds from the first touch on; parameters: with the size of the aggregates."""
    return IMPACT_RADII * parameters.radius * parameters.grainRadius / parameters.velocity


class ShorterStep:
    """As many small steps between samples as impactStepFraction takes, until a time [s]: of a scene of YADE, or on a
    device."""

    def __init__(self, parameters, until):
        self._ratio, self._until = parameters.stepFraction / parameters.impactStepFraction, until * (1 - 1e-12)

    def steps(self, usual):
        """Between two samples, where there are `usual` ones later."""
        return ceil(usual * self._ratio * (1 - 1e-12))

    def samples(self, between):
        """How many samples end with shorter steps; between: time from one to the next [s]."""
        return int(self._until / between) + 1

    def control(self, recorder, state):
        from yade.wrapper import Omega

        usual = recorder.schedule.interval
        Omega().engines[0].subSteps = usual if state["time"] > self._until else self.steps(usual)
        return False


# ---- what is known without a run ----


def estimate(parameters):
    """Estimate of a run, without its packings: contacts of a CPE packing by A24 eq 39, in BCCA two a grain; extents by
    fits to BCCA of 32 to 4096 grains and BPCA of 300 to 50,000, of packings in files as of CPE."""
    constants = pair_constants(parameters, neck=parameters.neck)
    planar, time_unit = bool(parameters.planar), constants["timeUnit"]
    one, other = _grain_numbers(parameters)
    neighbours, way, most = 2, START_GAP, max(one, other)
    if parameters.packing == "cpe":
        full = packings.maximum_filling(parameters.grainRadius, constants["equilibriumOverlap"], planar)
        neighbours = parameters.filling / full * (6 if planar else 12)
        radius = parameters.radius
        if parameters.target == AGGREGATE:  # from where spheres start, and 1.4 more
            way = 2 * (radius + 1) * (1 - sqrt(1 - parameters.impact**2)) + 1.4
    elif parameters.packing == "file":
        neighbours, radius = 6, (most / 0.4) ** (1 / 3)
    elif parameters.packing == "bpca":
        radius = 2.6 * most ** (1 / 2.97)
    else:
        radius = 1.6 * most ** (1 / 1.5) if planar else 1.9 * most ** (1 / 1.9)
    touch = way * parameters.grainRadius / parameters.velocity
    duration = parameters.duration or default_duration(parameters, radius, time_unit, touch)
    try:
        steps = duration / time_unit / with_step(parameters, constants).stepFraction
    except ParameterError:  # the run ends with this line
        steps = duration / time_unit / time_step.SHORTEST
    if short := parameters.impactStepFraction:
        impact = min(touch + _duration_of_impact(parameters.changed(radius=radius)), duration)
        steps += impact / time_unit * (1 / short - 1 / parameters.stepFraction)
    return Estimate(one + other, (one + other) * neighbours / 2, steps)


def _grain_numbers(parameters):
    """Grains of target (0: a plate) and projectile; of files that can't be read as if they held one each."""
    projectile = parameters.of_projectile()
    numbers = parameters.grains, projectile.grains
    if parameters.packing == "file":
        try:
            numbers = tuple(packings.load(file).grains for file in (parameters.file, projectile.file))
        except packings.PackingError:
            numbers = 1, 1
    return (0, numbers[0]) if parameters.target == WALL else numbers


def expected(parameters, run):
    """What a run's run.json should hold of size and duration where the parameters leave them open, and of files that
    have changed since. Aggregates that pass each other, and runs of format 1, have no first touch."""
    held, derived = run.get("parameters", {}), run.get("derived", {})
    open_names = ("radius", "filling", "grains")
    found = {name: held.get(name) for name in open_names if getattr(parameters, name) is None}
    first = "projectilePacking" if parameters.target == WALL else "targetPacking"
    if derived.get("materials", []) != derived_materials(parameters.of_each()).get("materials", []):
        found["materials"] = f"{parameters.materials} as it is now"
    for name, of in (("file", first), ("projectileFile", "projectilePacking")):
        file, kept = getattr(parameters, name), (derived.get(of) or {}).get(SUM)
        if file and kept and sum_of_file(file) not in (kept, None):
            found[name] = f"{file} as it is now"
    touch = derived.get("firstTouch", 0.0)
    if parameters.duration is None and None not in (held.get("radius"), derived.get("timeUnit")):
        found["duration"] = default_duration(parameters, held["radius"], derived["timeUnit"], touch)
    return found


KIND = Kind(COLLISION, CollisionParameters, prepare, estimate, expected, ending)
