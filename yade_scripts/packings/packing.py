"""Packings of spheres: their contacts, sizes and pieces, how contacts come to rest, and files. Lengths in m."""

import hashlib
import json
import os
import zipfile
from dataclasses import dataclass, field, replace
from functools import lru_cache
from math import sqrt

import numpy as np
from scipy.sparse import csr_matrix
from scipy.sparse.linalg import lsqr
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from analysis.measures.fragments import belongs_to_an_aggregate, fragment_labels
from analysis.measures.structure import fractal_dimension, grains_within, mean_coordination
from analysis.progress import progress
from analysis.runs.files import RunFolderError, npz, read_arrays, write_file
from analysis.runs.folder import read_quantities
from analysis.runs.format import FORMAT, STATE, same
from yade_scripts.parameters import InputError, one_line

NEAREST = 3.0  # grain radii: nearer than that numbers of grains depend on contacts
ORIGINS = 2000  # grains from which the fractal dimension is taken
AT_REST = 1e-3  # of the equilibrium overlap: contacts closer to it are at rest
MOST_MOVES = 20
# Of LSQR a step: more of them follow soft modes of dense packings, which are of no use before distances are nearly
# right (10,800 close-packed grains: 1 % left after 6 steps of 300, 4 % after 6 of 2000).
ITERATIONS = 300

SUM = "sha256"  # of a packing, among its parameters
SPHERES = [quantity for quantity in STATE if quantity.name in ("position", "radius", "material")]
OF_CONTACTS = ("young", "poisson", "surfaceEnergy")  # what contacts at rest depend on, beside the radius
MOST_PRESSED = 1.05  # equilibrium overlaps that a contact may keep where not all can be at rest together
DEEPEST = 1.1  # equilibrium overlaps that a contact of a run's packing may have, as if pressed a little


class PackingError(InputError, ValueError):
    """A packing that can't be made or read; the message is one line: what, where, what it must be."""


@dataclass(frozen=True)
class Packing:
    """Spheres."""

    position: np.ndarray  # (N, 3), centres [m]
    radius: np.ndarray  # (N,) [m]
    seed: int
    parameters: dict = field(default_factory=dict)  # what the packing was made from
    kind: np.ndarray | None = None  # (N,) int: which of parameters["materials"], where there are several

    @property
    def grains(self):
        return len(self.radius)

    @property
    def density(self):
        """(N,) [kg/m^3] of grains of several materials, else 1.0."""
        if self.kind is None:
            return 1.0
        return np.array([material["density"] for material in self.parameters["materials"]])[self.kind]

    def motion(self, velocity, spin):
        """Velocities (N, 3) [m/s] and angular velocities (N, 3) [rad/s] of its grains as it moves with a velocity (3,)
        and turns about its centre of mass with a spin (3,)."""
        velocities, spins = (
            np.broadcast_to(np.asarray(motion, dtype=float), (self.grains, 3)) for motion in (velocity, spin)
        )
        if np.any(spin):
            velocities = velocities + np.cross(spin, centred(self.position, self.radius, self.density))
        return velocities, spins

    def of(self, rows, **about):
        """The packing of some of its grains, which are where they were; about: what else its parameters say."""
        kind = None if self.kind is None else self.kind[rows]
        parameters = {**self.parameters, **about}
        return Packing(self.position[rows], self.radius[rows], self.seed, parameters, kind)


def random_stream(seed, index, *more):
    """numpy Generator of aggregate number index of a seed; more: numbers of independent streams of the aggregate."""
    return np.random.default_rng(np.random.SeedSequence(seed, spawn_key=(index, *more)))


def centred(position, radius, density=1.0):
    """Positions (N, 3) relative to the centre of mass of grains of these radii (N,) and densities, in any unit."""
    return position - np.average(position, axis=0, weights=(radius / radius.max()) ** 3 * density)


def randomly_turned(position, stream, planar):
    """Positions (N, 3) in a random orientation; planar: those in the plane z = 0, which stay there."""
    if planar:
        return Rotation.from_rotvec([0, 0, stream.uniform(0, 2 * np.pi)]).apply(position) * (1, 1, 0)
    return Rotation.random(random_state=stream).apply(position)


def moved(packing, shift):
    """The same packing, every grain moved by shift (3,) [m]."""
    return replace(packing, position=packing.position + np.asarray(shift))


def extent(packing):
    """Largest distance [m] of a grain's centre from the origin."""
    return np.linalg.norm(packing.position, axis=1).max()


def gyration_radius(packing):
    """r_gyr [m]: root of the mean square distance of the mass from its centre, grains as points."""
    mass = (packing.radius / packing.radius.max()) ** 3 * packing.density
    position = centred(packing.position, packing.radius, packing.density)
    return float(np.sqrt(np.average((position**2).sum(axis=1), weights=mass)))


def characteristic_radius(packing):
    """r_c = (5/3)^(1/2) r_gyr [m] (Mukai et al. 1992; A22 section 2.4): of a homogeneous sphere its radius. Of a single
    grain it is the grain's."""
    if packing.grains == 1:
        return float(packing.radius[0])
    return sqrt(5.0 / 3.0) * gyration_radius(packing)


def surface_gaps(position, radius, pairs):
    """Distances (M,) of the surfaces of pairs (M, 2), negative where they overlap; lengths in any unit."""
    distance = np.linalg.norm(position[pairs[:, 0]] - position[pairs[:, 1]], axis=1)
    return distance - radius[pairs].sum(axis=1)


def touching(position, radius, gap=0.0):
    """Pairs (M, 2) of grains whose surfaces are at most `gap` apart, in the unit of position (N, 3) and radius (N,)."""
    pairs = cKDTree(position).query_pairs(2 * radius.max() + gap, output_type="ndarray")
    return pairs[surface_gaps(position, radius, pairs) <= gap]


def contacts(packing):
    """Pairs (M, 2) of touching grains, sorted, first < second."""
    pairs = touching(packing.position, packing.radius)
    return pairs[np.lexsort((pairs[:, 1], pairs[:, 0]))]


def touching_distance(first, second, grain_radius, overlap):
    """Distance [m] of the centres of grains of radii first, second [m] (any shape) at rest against each other.

    overlap: of two of grain_radius; goes as R*^(1/3), since delta_0 = a_0^2/(3 R*), a_0^3 ~ R*^2 (A22)."""
    return first + second - overlap * np.cbrt(2 * first * second / ((first + second) * grain_radius))


def equilibrium_overlaps(radius, pairs, grain_radius, overlap, kind=None):
    """Overlaps (M,) [m] at rest of pairs (M, 2), where that of two grains of grain_radius is `overlap`: of materials
    that `kind` (N,) numbers a matrix (K, K)."""
    first, second = radius[pairs].T
    overlap = overlap if kind is None else overlap[tuple(kind[pairs].T)]
    return first + second - touching_distance(first, second, grain_radius, overlap)


def largest_cluster(grains, pairs):
    """(grains of the largest cluster that pairs (M, 2) connect, its pairs in their rows)."""
    kept = np.flatnonzero(fragment_labels(grains, pairs) == 0)
    row = np.full(grains, -1)
    row[kept] = np.arange(len(kept))
    rows = row[pairs]
    return kept, rows[(rows >= 0).all(axis=1)]


def largest_piece(packing):
    """The largest connected piece of a packing, where it was; its parameters count the grains that are `dropped`."""
    kept, _ = largest_cluster(packing.grains, contacts(packing))
    return packing.of(kept, dropped=packing.grains - len(kept))


def require_connected(packing):
    """Raise PackingError when a packing is in crumbs, so that a collision of it has no outcome."""
    try:
        mass = packing.radius**3 * packing.density
        belongs_to_an_aggregate(np.zeros(packing.grains, dtype=int), contacts(packing), mass)
    except ValueError as error:
        raise PackingError(str(error)) from None


def description(packing):
    """A line about a packing; lengths in mean radii. The filling factor is that of the sphere of the characteristic
    radius, the fractal dimension the mean slope of the number of grains about one from NEAREST to r_gyr."""
    pairs, radius = contacts(packing), packing.radius.mean()
    pieces = int(fragment_labels(packing.grains, pairs).max()) + 1
    characteristic, gyration = characteristic_radius(packing), gyration_radius(packing)
    words = [
        f"{packing.grains} grains in {pieces} piece{'s' * (pieces > 1)}, {len(pairs)} contacts",
        f"mean coordination number {mean_coordination(packing.grains, pairs):.3f}",
        f"filling factor {(packing.radius**3).sum() / characteristic**3:.3g}",
        f"radius of gyration {gyration / radius:.4g}, characteristic radius {characteristic / radius:.4g} grain radii",
    ]
    if gyration > 2 * NEAREST * radius:
        distance = np.array([NEAREST * radius, gyration])
        dimension = fractal_dimension(distance, grains_within(packing.position, distance, origins=ORIGINS))
        words.append(f"fractal dimension {dimension[0]:.2f}")
    return ", ".join(words)


def arrays_of_grains(packings):
    """{name: (N,)} of what a run's states have of the grains of its packings and YADE does not tell: the aggregate, of
    several materials material and mass [kg]."""
    found = {"aggregate": np.repeat(np.arange(len(packings)), [packing.grains for packing in packings])}
    if packings[0].kind is not None:
        mass = [4 / 3 * np.pi * packing.radius**3 * packing.density for packing in packings]
        found |= {"material": np.concatenate([packing.kind for packing in packings]), "mass": np.concatenate(mass)}
    return found


# ---- contacts at rest ----


def at_rest(position, radius, pairs, grain_radius, overlap, kind=None):
    """Bring the contacts of pairs (M, 2) to rest; grains that come to overlap on the way are contacts too.

    Newton's method on the distances of the grains that touch, each step the smallest motion that solves the linearised
    equations. Where there are more contacts than the grains can obey, the steps lead to the least elastic energy.

    overlap, kind: as of equilibrium_overlaps(). Returns positions (N, 3), pairs (M, 2) of contacts, and how much deeper
    each (M,) is than at rest, in equilibrium overlaps."""
    moved = position.copy()
    for move in progress(range(MOST_MOVES + 1), "bringing contacts to rest", MOST_MOVES + 1):
        pairs = np.unique(np.sort(np.concatenate([pairs, touching(moved, radius)]), axis=1), axis=0)
        depth = equilibrium_overlaps(radius, pairs, grain_radius, overlap, kind)
        missing = -surface_gaps(moved, radius, pairs) - depth
        deviation = missing / depth
        if move == MOST_MOVES or np.abs(deviation).max(initial=0.0) < AT_REST:
            return moved, pairs, deviation
        separation = moved[pairs[:, 0]] - moved[pairs[:, 1]]
        normal = separation / np.linalg.norm(separation, axis=1)[:, None]
        # k ~ a_0 ~ R^(2/3), as depth^2 (packing.touching_distance)
        moved = moved + _smallest_motion(normal, pairs, missing, depth / np.max(overlap), len(radius))


def brought_to_rest(packing, grain_radius, overlap, pairs=None, kind=None):
    """The packing with its contacts at rest, by the least motion of the grains.

    Parameters
    ----------
    packing : Packing
    grain_radius, overlap : float
        Of a grain, and of two such grains at rest [m]; of K materials overlaps (K, K).
    pairs : (M, 2) array, optional
        Its contacts, if not those that touch.
    kind : (N,) array of int, optional
        Which of several materials each grain is of; by default as the packing has it.

    Returns
    -------
    Packing
        How far the farthest grain was moved, largestMotion [m], is among its parameters.

    Raises
    ------
    PackingError
        Where a contact stays deeper than MOST_PRESSED or comes apart.
    """
    pairs, kind = contacts(packing) if pairs is None else pairs, packing.kind if kind is None else np.asarray(kind)
    position, _, deviation = at_rest(packing.position, packing.radius, pairs, grain_radius, np.asarray(overlap), kind)
    if deviation.min(initial=0.0) <= -1.0 or deviation.max(initial=0.0) >= MOST_PRESSED - 1:
        worst = deviation[np.abs(deviation).argmax()]
        must = f"must be at most {MOST_PRESSED:g}: a looser state"
        raise PackingError(f"contacts cannot come to rest together: one overlaps by {1 + worst:.3g}; {must}")
    motion = float(np.linalg.norm(position - packing.position, axis=1).max())
    about = dict(packing.parameters, grainRadius=grain_radius, largestMotion=motion)
    about |= {"overlap": float(np.reshape(overlap, -1)[0])}
    return replace(packing, position=position, parameters=about)


def _smallest_motion(normal, pairs, change, weight, grains):
    """Least motion (N, 3) that changes distances of pairs (M, 2) by change (M,), or with the least weighted squares."""
    rows = np.repeat(np.arange(len(pairs)), 3)
    columns = [(3 * pairs[:, side, None] + np.arange(3)).ravel() for side in (0, 1)]
    of_first = (weight[:, None] * normal).ravel()
    entries = np.concatenate([of_first, -of_first]), (np.tile(rows, 2), np.concatenate(columns))
    matrix = csr_matrix(entries, shape=(len(pairs), 3 * grains))
    return lsqr(matrix, weight * change, atol=1e-9, btol=1e-9, iter_lim=ITERATIONS)[0].reshape(-1, 3)


# ---- in files ----


def save(path, packing):
    """Write a packing as .npz: position (N, 3), radius (N,) in m, of several materials the number of each grain's,
    material (N,), seed, parameters (a JSON text); beside them, for whoever reads the file, gyration_radius and
    characteristic_radius [m]."""
    about = {"seed": packing.seed, "parameters": json.dumps(packing.parameters)}
    sizes = {"gyration_radius": gyration_radius(packing), "characteristic_radius": characteristic_radius(packing)}
    kind = {} if packing.kind is None else {"material": packing.kind}
    write_file(path, npz(position=packing.position, radius=packing.radius, **kind, **about, **sizes))


def is_packing(path):
    """Whether a file is one that save() wrote, be its grains right or not."""
    try:
        return zipfile.is_zipfile(path) and bool(read_arrays(path, ("seed",), texts=("parameters",)))
    except (RunFolderError, OSError):
        return False


def load(path):
    """Read a packing that save() wrote; raises PackingError when it is none."""
    try:
        spheres, about = read_quantities(path, SPHERES, FORMAT), read_arrays(path, ("seed",), texts=("parameters",))
        parameters, kind = dict(json.loads(about["parameters"])), spheres.pop("material", None)
        if kind is not None and not 0 <= kind.min() <= kind.max() < len(parameters.get("materials", ())):
            raise ValueError("'material' must number its materials")
        return Packing(**spheres, seed=int(about["seed"]), parameters=parameters, kind=kind)
    except (RunFolderError, ValueError, TypeError) as error:
        reason = one_line(error).removeprefix(f"{path}: ")
        must = "must be an .npz with position, radius, seed, parameters, as make_packing.py writes it"
        raise PackingError(f"{path}: not a packing ({reason}); {must}") from None


def packing_from_file(path, grains, overlap, planar=False):
    """The packing in a file, with its centre of mass at the origin and the sum of its grains among its parameters.

    grains: materials.GrainParameters of the run; overlap: of two of its grains at rest [m]; planar: whether all must
    lie in the plane z = 0. Raises PackingError for other grains."""
    packing = load(path)
    if packing.grains < 2:
        raise PackingError(f"{path}: holds {packing.grains} grains; must be N >= 2")
    if packing.kind is not None:
        _require_materials(path, packing, grains)
    elif len(grains.material_names) == 1:  # of two, the grains get their materials, and come to rest with these
        _require_material(path, packing, grains, overlap)
        _require_shallow(path, packing, grains.grainRadius, overlap)
    if planar and np.abs(packing.position[:, 2]).max() > 1e-9 * grains.grainRadius:
        raise PackingError(f"{path}: grains lie beside the plane z = 0; must all be in it with planar = 1")
    found = moved(packing, (centred(packing.position, packing.radius, packing.density) - packing.position)[0])
    return replace(found, parameters={**packing.parameters, SUM: _sum(packing)})


def sum_of_file(path):
    """SHA-256 of the grains in a packing's file, by which a run knows it again; None where it can't be read."""
    try:
        return _sum_as_written(path, os.stat(path).st_mtime_ns)
    except (OSError, PackingError):
        return None


@lru_cache
def _sum_as_written(path, _when):
    return _sum(load(path))


def _sum(packing):
    kind = b"" if packing.kind is None else packing.kind.astype(np.int32).tobytes()
    return hashlib.sha256(packing.position.tobytes() + packing.radius.tobytes() + kind).hexdigest()


def _require_materials(path, packing, grains):
    made_of, each = packing.parameters["materials"], grains.of_each()
    alike = len(each) == len(made_of) and all(
        same(made[name], getattr(own, name)) for made, own in zip(made_of, each) for name in OF_CONTACTS
    )
    if not alike:
        names = ",".join(material["name"] for material in made_of)
        raise PackingError(f"{path}: of grains of {names}, not {grains.material}; must be of the run's materials")


def _require_material(path, packing, grains, overlap):
    """Contacts of other grains would pull or press from the start on. Loose cpe packings are meant (initialOverlap)."""
    stored = {"grainRadius": float(np.median(packing.radius)), **packing.parameters}
    wanted = {name: (getattr(grains, name), 1e-6) for name in OF_CONTACTS}
    if np.ptp(packing.radius) == 0:  # of unlike ones a run's grainRadius is but the unit
        wanted["grainRadius"] = grains.grainRadius, 1e-6
    if stored.get("packing") != "cpe":
        wanted["overlap"] = overlap * np.cbrt(stored["grainRadius"] / grains.grainRadius), AT_REST
    for name, (value, tolerance) in wanted.items():
        if stored.get(name) is None or np.isclose(stored[name], value, rtol=tolerance, atol=0):
            continue
        must = "must be a packing of the run's grains"
        raise PackingError(f"{path}: made of grains with {name} = {stored[name]:.3g}, not {value:.3g}; {must}")


def _require_shallow(path, packing, grain_radius, overlap):
    """No contact may be far deeper than at rest."""
    pairs = contacts(packing)
    if not len(pairs):
        return
    deep = -surface_gaps(packing.position, packing.radius, pairs)
    at_rest = equilibrium_overlaps(packing.radius, pairs, grain_radius, overlap)
    worst = np.argmax(deep / at_rest)
    if deep[worst] > DEEPEST * at_rest[worst]:
        must = f"must be at most {DEEPEST:g} of the equilibrium overlap of {at_rest[worst]:.3g} m"
        first, second = pairs[worst]
        raise PackingError(f"{path}: grains {first} and {second} overlap by {deep[worst]:.3g} m; {must}")
