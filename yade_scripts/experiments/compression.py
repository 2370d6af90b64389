"""Static compression of a BCCA cluster in a shrinking periodic cell, and its loosening (K13 section 2), or of a layer
between two plates, of which the upper one comes down (boundary=walls): parameters, scene, series.

Between walls the sides are periodic and stay as they are, so that the layer is one of a wide cake; the cell is so high
that nothing meets its images across the plates. The filling factor is that between the plates, the pressure the mean of
the forces on both over their area."""

from dataclasses import dataclass
from math import ceil, log, pi

import numpy as np

from analysis.measures.periodic_cell import AVERAGED, contact_pressure, filling_factor, kinetic_pressure
from analysis.runs.format import COMPRESSION, value_text
from analysis.theory.aggregates import bcca_coordination
from yade_scripts import packings, time_step
from yade_scripts.experiments import compression_end as end
from yade_scripts.experiments.compression_end import AXES, LOOSE, deform, shrinking_rate
from yade_scripts.materials import PAIR, GrainParameters, pair_constants, require_small_contacts
from yade_scripts.packings.aggregate import MOST_GROWN, with_materials_at_rest
from yade_scripts.packings.ballistic import rbd
from yade_scripts.packings.packing import arrays_of_grains
from yade_scripts.packings.placing import require_apart_from_images, smallest_edge
from yade_scripts.parameters import NOT_NEGATIVE, POSITIVE, SWITCH, Check, ParameterError, between, one_of, parameter
from yade_scripts.run.kind import Estimate, Kind, Scene
from yade_scripts.run.parameters import RunParameters

CLOSE_PACKED = 0.64  # of spheres that do not overlap
FINAL_FILLING = 0.5
SMALLEST_EDGE = 5.7  # grain radii: below, a grain could meet two images of another (the engine stops at 5.6)
BETWEEN_SAMPLES = 40.0  # t0; a sample takes as long as 20 steps
FINEST_FILLING = 0.005  # by this fraction the filling factor grows between samples, at most
FASTEST = 1e-3  # 1/t0: beyond, boundaries pass a grain within a few oscillations of a contact
EXTENT, EXTENT_EXPONENT = 2.45, 0.55  # edge of the first cell, in grain radii, against the number of grains: a fit
PERIODIC, WALLS = "periodic", "walls"
PACKING = {PERIODIC: "bcca", WALLS: "rbd"}
DEPOSITED = 0.15  # filling of a deep layer, which sets the square on which it is grown
FINAL = Check(
    f"> initialFilling and at most that of random close packing (about {CLOSE_PACKED:g})", lambda x: 0 < x < 1
)
RATE = Check(f"> 0 and <= {FASTEST:g}", lambda x: 0 < x <= FASTEST)
GAP = 0.1  # grain radii between the highest grain and the upper plate at the start
UP = 2  # axis across the plates


@dataclass(frozen=True)
class CompressionParameters(GrainParameters, RunParameters):
    """The cell."""

    boundary: str = parameter(
        PERIODIC,
        one_of(list(PACKING)),
        "what compresses: a periodic cell whose edges shrink; or two plates of the grains' material, of which the "
        "lower one rests and the upper one comes down, with periodic sides that stay",
    )
    grains: int = parameter(1024, between(2, MOST_GROWN["bcca"]), "grains of the cluster or layer")
    packing: str | None = parameter(
        None,
        one_of(list(PACKING.values())),
        "how it is made: in a periodic cell by cluster-cluster aggregation (bcca), between walls by ballistic "
        "deposition on the lower one, as high as wide (rbd)",
    )
    atRest: int = parameter(
        1, SWITCH, "1: contacts of a cluster are brought to rest first; 0, and between walls: as it is made", before=0
    )
    seed: int = parameter(1, NOT_NEGATIVE, "of the cluster or layer")
    strainRate: float = parameter(
        3e-7, RATE, "C_v: the edges, or the distance of the walls, follow L = L0 exp(-2 C_v t/t0) (K13 eq 7)", "1/t0"
    )
    linearDamping: float = parameter(0.01, NOT_NEGATIVE, "k_n of the damping of the normal motion (K13 eq 4)", "1")
    initialFilling: float | None = parameter(
        None,
        Check("> 0, and such that the cluster does not touch its images", lambda x: x > 0),
        "volume filling factor of the cell at the start (its edge is the cluster's extent in x, y or z; not between "
        "walls, where it is the layer's)",
        "1",
    )
    finalFilling: float | None = parameter(
        None, FINAL, f"where the compression ends ({FINAL_FILLING:g}; with finalPressure the largest there is)", "1"
    )
    finalPressure: float | None = parameter(
        None,
        POSITIVE,
        "pressure at which it ends if that comes first: work on the boundaries over the change of volume, in the last "
        f"{AVERAGED:g} t0",
        "Pa",
    )
    stretch: str = parameter("no", one_of(list(AXES)), "axes along which the cell is stretched afterwards, as fast")
    stretchFilling: float | None = parameter(
        None,
        Check("> 0 and below finalFilling", lambda x: x > 0),
        f"where the stretching ends ({LOOSE:g} of where it begins); a cell looser at finalPressure is not stretched",
        "1",
    )
    states: int = parameter(
        60, between(2, 10_000), "states written, evenly in time, start and end among them", of_consequence=False
    )
    duration: float | None = parameter(None, POSITIVE, "longest time that is simulated (as long as it takes)", "s")

    ONLY_WITH = [
        ("stretchFilling", "stretch", ["x", "xyz"]),
        # the functors have no plates in periodic cells, and walls only come together
        *((name, "boundary", [PERIODIC]) for name in ("engine", "stretch", "initialFilling")),
    ]

    def title(self):
        """compress-ice-N1024-Cv3e-07-s1 or compress-walls-ice-..., and the names of what is in it."""
        walls = f"{WALLS}-" if self.boundary == WALLS else ""
        name = f"compress-{walls}{self.material}-N{self.grains}-Cv{value_text(self.strainRate)}-s{self.seed}"
        return name, ("boundary", "material", "grains", "strainRate", "seed")

    def filled_in(self):
        """As GrainParameters; refuses what doesn't go together."""
        self.require_stretched_below(self.finalFilling)
        packing = PACKING[self.boundary]
        if self.packing not in (None, packing):
            raise ParameterError(f"packing = {self.packing}: given with boundary = {self.boundary}; must be {packing}")
        if self.boundary == WALLS and len(self.material_names) > 1:
            raise ParameterError(f"material = {self.material}: given with boundary = {WALLS}; must be one material")
        if self.layout == PAIR:
            raise ParameterError(f"layout = {PAIR}: a compression has one cluster; must be another one")
        at_rest = 0 if self.boundary == WALLS else self.atRest
        return super(CompressionParameters, self.changed(packing=packing, atRest=at_rest)).filled_in()

    def require_stretched_below(self, final):
        """Raise ParameterError where the stretching would not end below a filling factor (None: not known)."""
        if None not in (self.stretchFilling, final) and self.stretchFilling >= final:
            raise ParameterError(f"stretchFilling = {self.stretchFilling:g}: must be below finalFilling = {final:g}")

    @property
    def axes(self):
        """Number of axes along which the compression goes."""
        return 1 if self.boundary == WALLS else 3


def complete(parameters, constants, threads):
    """The parameters with what depends on the contact and on YADE's threads. Raises ParameterError."""
    require_small_contacts(parameters)
    return with_step(_with_final_filling(parameters, constants), constants).with_threads(threads)


def with_step(parameters, constants):
    """time_step.with_step() of a compression with a finalFilling."""
    limit = step_limit(parameters, constants)
    error = lambda: time_step.compression_error(parameters, constants)
    return time_step.with_step(parameters, limit, error, "final filling and damping")


def step_limit(parameters, constants):
    """Largest stable stepFraction [t0] of a compression with a finalFilling."""
    return time_step.limit_of(parameters, constants, parameters.finalFilling)


def _with_final_filling(parameters, constants):
    # random close packing of grains that overlap as contacts at rest do (K13 eq 22 counts overlaps twice)
    diameter, final = 4 * constants["reducedRadius"], parameters.finalFilling
    limit = CLOSE_PACKED * (diameter / (diameter - constants["equilibriumOverlap"])) ** 3
    if final is None:
        final = limit if parameters.finalPressure else FINAL_FILLING
    if final > limit:
        raise ParameterError(f"finalFilling = {final:g}: beyond random close packing; must be at most {limit:.3f}")
    fewest = final * SMALLEST_EDGE**3 / (4 / 3 * pi)
    if parameters.boundary == WALLS:  # the plates that far apart
        fewest *= (final / DEPOSITED) ** 2
    if parameters.grains < fewest:
        must = f"must be at least {fewest:.0f}, or finalFilling at most {parameters.grains / fewest * final:.3g}"
        raise ParameterError(f"grains = {parameters.grains}: too few for a cell at a filling of {final:.3g}; {must}")
    parameters.require_stretched_below(final)
    return parameters.changed(finalFilling=final)


# ---- the scene ----


def prepare(parameters, threads):
    """The Scene of a compression; called within YADE. Raises ParameterError and PackingError."""
    from yade_scripts.run import scene as yade_scene

    constants = yade_scene.pair_constants(parameters, linearDamping=parameters.linearDamping)
    parameters = complete(parameters, constants, threads)
    walls = parameters.boundary == WALLS
    packing, edges, build, own_series = (_layer if walls else _cluster)(parameters, constants)
    time_unit = constants["timeUnit"]
    parameters = parameters.changed(initialFilling=filling_factor(packing.radius, edges))
    parameters = end.with_start(parameters, time_unit)
    ending = end.Ending(parameters, time_unit)

    def come_down(recorder, state):
        from yade.wrapper import Omega

        piston = Omega().bodies[-1].state
        piston.vel = [0.0, 0.0, -ending.rate * piston.pos[UP]]
        return ending.is_pressed(recorder)

    rolling = parameters.surfaceEnergy * parameters.grainRadius * parameters.criticalRolling
    height = {"initialHeight": edges[UP]} if walls else {}
    moved = {name: value for name, value in packing.parameters.items() if name == "largestMotion"}
    between = min(BETWEEN_SAMPLES, FINEST_FILLING / (6 * parameters.strainRate))
    return Scene(
        parameters=parameters,
        constants=constants,
        derived={"initialEdge": edges[0], **moved, **height, "rollingEnergy": 6 * pi**2 * rolling},  # K13 eq 1
        grains=arrays_of_grains([packing]),
        build=build,
        series=own_series,
        law={"linearDamping": parameters.linearDamping},
        energy_is_conserved=parameters.engine == "fused",
        control=come_down if walls else ending,
        ended_by=ending.ended_by,
        interval=max(1, round(between / parameters.stepFraction)),
        step_choice=time_step.reason(parameters, step_limit(parameters, constants)),
    )


def _cluster(parameters, constants):
    """(Packing, edges (3,) of the cell [m], function that builds the scene, its series)."""
    from yade.wrapper import Omega

    from yade_scripts.run import scene as yade_scene

    radius, overlap = parameters.grainRadius, constants["equilibriumOverlap"]
    cluster = packings.bcca(parameters.grains, radius, overlap, parameters.seed)
    cluster = with_materials_at_rest(cluster, parameters, overlap)
    edge = smallest = smallest_edge(cluster)
    if parameters.initialFilling is not None:
        volume = parameters.grains * 4 / 3 * pi * parameters.grainRadius**3
        edge = (volume / parameters.initialFilling) ** (1 / 3)
        try:
            require_apart_from_images(cluster, edge)
        except packings.PackingError as problem:
            given, most = parameters.initialFilling, volume / smallest**3
            raise ParameterError(f"initialFilling = {given:g}: {problem}, as with {most:.4g} for this seed") from None
    mass = arrays_of_grains([cluster]).get("mass", cluster.radius**3 * (4 / 3 * pi * parameters.density))
    rate = shrinking_rate(parameters, constants["timeUnit"])
    materials = yade_scene.materials_of(parameters)

    def build():
        omega = Omega()
        omega.periodic = True
        omega.cell.setBox(edge, edge, edge)
        # 1 gives grains the mean flow when the rate changes (K13 eq 12), and leaves them to themselves afterwards
        omega.cell.homoDeform = 1
        yade_scene.add_bodies([cluster], [(0, 0, 0)], materials)
        deform(3 * (-rate,))

    return cluster, np.full(3, edge), build, lambda state: series(state, mass)


def _layer(parameters, constants):
    """As _cluster(), of a layer between walls: edges of the space between them."""
    from yade.wrapper import Omega

    from yade_scripts.run import scene as yade_scene

    radius = parameters.grainRadius
    on_plate = yade_scene.plane_constants(parameters, linearDamping=parameters.linearDamping)["equilibriumOverlap"]
    edge = ceil(100 * (parameters.grains * 4 / 3 * pi / DEPOSITED) ** (1 / 3)) / 100 * radius  # as high as wide
    layer = rbd(parameters.grains, radius, constants["equilibriumOverlap"], on_plate, edge, parameters.seed)
    height = layer.position[:, UP].max() + (1 + GAP) * radius
    rate = shrinking_rate(parameters, constants["timeUnit"])
    materials = yade_scene.materials_of(parameters)

    def build():
        omega = Omega()
        omega.periodic = True
        omega.cell.setBox(edge, edge, 2 * height + 10 * layer.radius.max())
        omega.cell.homoDeform = 0
        yade_scene.add_bodies([layer], [(0, 0, 0)], materials)
        yade_scene.add_plane(UP, 0.0, materials[0])
        yade_scene.add_plane(UP, height, materials[0], -rate * height)

    return layer, [edge, edge, height], build, series_between_walls


def series(state, mass):
    """{name: value} of a compression's own series; state: as contact_law.snapshot(); mass (N,) [kg]."""
    position, edges = state["position"], state["cell_size"]
    contacts = contact_pressure(position, state["contact_pairs"], state["contact_normal_force"], edges)
    kinetic = kinetic_pressure(mass, position, state["velocity"], edges, end.rates())
    return {
        "filling": filling_factor(state["radius"], edges),
        "pressure": contacts + kinetic,
        "kinetic_pressure": kinetic,
        "coordination": 2 * len(state["contact_pairs"]) / len(mass),
        **{f"edge_{axis}": edge for axis, edge in zip("xyz", edges)},
    }


def series_between_walls(state):
    """The same between walls: edges, filling and pressure are of the space between the plates."""
    edges = np.array([*state["cell_size"][:UP], np.ptp(state["plane_position"])])
    plane, force = state["plane_contacts"][:, 1], state["plane_contact_normal_force"]
    pressures = np.bincount(plane, weights=force, minlength=2) / np.prod(state["cell_size"][:UP])
    contacts = 2 * len(state["contact_pairs"]) + len(state["plane_contacts"])
    return {
        "filling": filling_factor(state["radius"], edges),
        "pressure": pressures.mean(),
        "kinetic_pressure": 0.0,
        "piston_pressure": pressures[1],
        "coordination": contacts / len(state["radius"]),
        **{f"edge_{axis}": edge for axis, edge in zip("xyz", edges)},
    }


# ---- what is known without a run ----


def estimate(parameters):
    """Estimate of a run, without its cluster: two contacts a grain, more where it is dense (A24 eq 45)."""
    constants = pair_constants(parameters, linearDamping=parameters.linearDamping)
    try:
        ends = _with_final_filling(parameters, constants)
        step = with_step(ends, constants).stepFraction
    except ParameterError:  # the run ends with this line
        ends, step = parameters.changed(finalFilling=FINAL_FILLING, stretch="no"), time_step.SHORTEST
    typical = DEPOSITED if parameters.boundary == WALLS else typical_first_filling(ends.grains)
    first = min(ends.initialFilling or typical, 0.9 * ends.finalFilling)
    duration = parameters.duration or end.longest_duration(ends.changed(initialFilling=first), constants["timeUnit"])
    fillings = np.exp(np.linspace(log(first), log(ends.finalFilling), 50))
    contacts = parameters.grains * float(bcca_coordination(fillings).mean()) / 2
    return Estimate(parameters.grains, contacts, duration / constants["timeUnit"] / step)


def typical_first_filling(grains):
    """Filling factor of the first cell: a fit to clusters of 64 to 16,384 grains, which scatter by half of it."""
    return grains * 4 / 3 * pi / (EXTENT * grains**EXTENT_EXPONENT) ** 3


def expected(parameters, run):
    """What a run's run.json should hold of parameters that are left open and follow from the cluster."""
    held, derived = run.get("parameters", {}), run.get("derived", {})
    found = {"initialFilling": held.get("initialFilling")} if parameters.initialFilling is None else {}
    try:
        ends = _with_final_filling(parameters, pair_constants(parameters))
    except ParameterError:  # the run ends with this line
        return found
    found["finalFilling"] = ends.finalFilling
    if parameters.duration is None and None not in (held.get("initialFilling"), derived.get("timeUnit")):
        whole = ends.changed(initialFilling=held["initialFilling"])
        found["duration"] = end.longest_duration(whole, derived["timeUnit"])
    return found


KIND = Kind(COMPRESSION, CompressionParameters, prepare, estimate, expected)
