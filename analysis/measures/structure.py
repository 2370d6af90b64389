"""Structure of packings: grains within a distance, fractal dimension, radius of gyration, filling factor, contacts of
a grain.

K13 = Kataoka et al. 2013, S17 = Sirono & Ueno 2017, A22 = Arakawa et al. 2022, A24 = Arakawa et al. 2024. Functions
that return lengths return them in the unit of the positions.
"""

from itertools import product
from math import ceil

import numpy as np
from scipy.sparse.csgraph import dijkstra
from scipy.spatial import cKDTree

from ..arrays import numbers, pairs
from .network import contact_network

SCALES, MOST_ORIGINS = 12, 500  # of correlation_dimension; the latter of geodesic_radius, too
DEPTH = 0.25  # of the zone of zone_filling(), in radii of the aggregate


def grains_within(position, distance, cell_size=None, origins=None):
    """Mean number of grains, itself and images included, nearer than a distance (any shape) to a grain: N(r < r_in),
    K13 section 3.6.

    Parameters
    ----------
    position : (N, 3) array
    distance : array of any shape
    cell_size : (3,) array, optional
        Edges of the periodic cell; open space if left out.
    origins : int, optional
        At most so many grains, evenly chosen, are taken as centres.

    Examples
    --------
    >>> grains_within([[0.0, 0, 0], [1, 0, 0]], [0.5, 1.5]).tolist()
    [1.0, 2.0]
    """
    position, distance = _points(position), numbers("distance", distance, least=0)
    shifts = [np.zeros(3)]
    if cell_size is not None:
        cell_size = numbers("cell_size", cell_size, (3,), positive=True)
        position = position - cell_size * np.floor(position / cell_size)
        farthest = distance.max(initial=0.0)
        reach = [range(-ceil(farthest / edge), ceil(farthest / edge) + 1) for edge in cell_size]
        shifts = [cell_size * image for image in product(*reach)]
    chosen = position
    if origins is not None and numbers("origins", origins, (), least=1) < len(position):
        chosen = position[np.linspace(0, len(position) - 1, origins).round().astype(int)]
    tree, counts = cKDTree(position), np.zeros(distance.shape)
    for shift in shifts:
        counts += cKDTree(chosen + shift).count_neighbors(tree, distance.ravel()).reshape(distance.shape)
    return counts / len(chosen)


def fractal_dimension(distance, counts):
    """D (K-1,) of N ~ r^D between neighbouring distances (K,), from counts (K,)."""
    return np.diff(np.log(counts)) / np.diff(np.log(distance))


def correlation_dimension(position, radius):
    """Fractal dimension of a piece: slope of ln N(< s) against ln s, from 3 radii to 0.7 R_g; NaN if these differ by
    less than a factor of 1.5. position (N,3), radius (N,).

    The surface lowers it: of 256 to 4096 grains BCCA aggregates have 1.87 (scatter 0.05; infinite ones 1.9), BPCA
    aggregates 2.4 to 2.6 (3), close-packed spheres thinned to 0.4 some 2.85 (3). Grassberger & Procaccia (1983).

    >>> line = np.arange(100.0)[:, None] * [2, 0, 0]
    >>> round(correlation_dimension(line, np.ones(100)), 1)
    1.0
    """
    position = _points(position)
    low, high = 3.0 * float(np.max(_radii(radius, position))), 0.7 * gyration_radius(position)
    if not high >= 1.5 * low:
        return float("nan")
    distance = np.geomspace(low, high, SCALES)
    counts = grains_within(position, distance, origins=MOST_ORIGINS)
    return float(np.polyfit(np.log(distance), np.log(counts), 1)[0])


def gyration_radius(position, radius=None):
    """Radius of gyration of points (N,3) of equal mass (S17 eq 13); with radius (N,) of spheres of one density,
    R_g^2 = sum m_i (|x_i - x_c|^2 + 3/5 r_i^2)/sum m_i.

    >>> gyration_radius([[0.0, 0, 0], [2, 0, 0]]), round(gyration_radius([[0.0, 0, 0]], [1.0]) ** 2, 3)
    (1.0, 0.6)
    """
    position = _points(position)
    own = np.zeros(len(position)) if radius is None else _radii(radius, position)
    mass = None if radius is None else (own / own.max()) ** 3
    square = ((position - np.average(position, axis=0, weights=mass)) ** 2).sum(axis=1)
    return float(np.sqrt(np.average(square + 0.6 * own**2, weights=mass)))


def geodesic_radius(position, contact_pairs):
    """Root of half the mean square of the shortest way along contacts between two grains: of a straight chain its
    radius of gyration. Infinite where no contacts lead from one grain to another.

    position (N,3), contact_pairs (M,2); of more than MOST_ORIGINS grains ways start at so many, evenly chosen. After
    Arakawa et al. (2019), whose abstract has R_geo ~ N^0.710 of BCCA clusters.

    >>> corner = [[4.0, 0, 0], [0, 0, 0], [0, 4, 0]]
    >>> round(geodesic_radius(corner, [[0, 1], [1, 2]]) ** 2, 3)
    10.667
    """
    position = _points(position)
    grains = len(position)
    contact_pairs = pairs("contact_pairs", contact_pairs, grains)
    lengths = np.linalg.norm(np.subtract(*position[contact_pairs.T]), axis=1)
    origins = np.unique(np.linspace(0, grains - 1, MOST_ORIGINS).round().astype(int))
    ways = dijkstra(contact_network(grains, contact_pairs, lengths), directed=False, indices=origins)
    return float(np.sqrt((ways**2).mean() / 2.0))


def filling_factor(position, radius):
    """Volume of spheres, position (N,3), radius (N,), over that of a homogeneous sphere of their radius of gyration,
    which is r_c = (5/3)^(1/2) R_g (Mukai et al. 1992; A22 section 2.4). Overlaps count twice; of one grain it is 1.

    >>> round(filling_factor([[-1.0, 0, 0], [1, 0, 0]], [1.0, 1.0]), 3)
    0.459
    """
    whole = np.sqrt(5.0 / 3.0) * gyration_radius(position, radius)
    return float(((np.asarray(radius, dtype=float) / whole) ** 3).sum())


def mean_coordination(grains, contact_pairs):
    """Mean number of contacts of a grain, 2 M/N, for N = `grains` and contact_pairs (M,2).

    >>> mean_coordination(4, [[0, 1], [2, 3]])
    1.0
    """
    return 2.0 * len(pairs("contact_pairs", contact_pairs)) / int(numbers("grains", grains, (), least=1, whole=True))


def of_members(state, members):
    """(filling factor, mean coordination, R_g [m]) of the grains of a folder.State in a mask (N,), not empty, by their
    contacts with each other."""
    position, radius = state.position[members], state.radius[members]
    own = state.contact_pairs[members[state.contact_pairs].all(axis=1)]
    grains = int(members.sum())
    return filling_factor(position, radius), mean_coordination(grains, own), gyration_radius(position, radius)


def inner_coordination(position, contact_pairs, centre, reach):
    """Mean number of contacts of the grains nearer than `reach` to a point; NaN if there is none. position (N,3),
    contact_pairs (M,2), centre (3,) or, one for each grain, (N,3).

    >>> inner_coordination([[0.0, 0, 0], [2, 0, 0], [4, 0, 0]], [[0, 1], [1, 2]], [2.0, 0, 0], 1.0)
    2.0
    """
    position = _points(position)
    contacts = np.bincount(pairs("contact_pairs", contact_pairs, len(position)).ravel(), minlength=len(position))
    place = position - numbers("centre", centre, (3,) if np.ndim(centre) == 1 else position.shape)
    inside = np.einsum("ij,ij->i", place, place) < numbers("reach", reach, (), least=0) ** 2
    return float(contacts[inside].mean()) if inside.any() else float("nan")


def zone_filling(position, centre, radius, side):
    """Number density of grains at the place where an aggregate is hit over that of the whole: 1 in the mean over
    packings.

    position (N,3) of the grains of one aggregate, centre (3,) of its sphere, radius of the sphere that holds the
    centres of its grains; side: +1 or -1, the pole along x at which it meets the other. The zone is a cylinder about
    the axis below the cap of that sphere, DEPTH radii wide and deep.
    """
    place = np.asarray(position, dtype=float) - centre
    inside = (side * place[:, 0] > (1.0 - DEPTH) * radius) & (np.hypot(place[:, 1], place[:, 2]) < DEPTH * radius)
    cap = 1.0 - np.sqrt(1.0 - DEPTH**2)
    volume = (np.pi * DEPTH**2 * (DEPTH - cap) + np.pi * cap**2 * (1.0 - cap / 3.0)) * radius**3
    return float(inside.mean() * (4.0 / 3.0 * np.pi * radius**3) / volume)


def _points(position):
    array = numbers("position", position, (None, 3))
    if not len(array):
        raise ValueError("position: must have one grain or more")
    return array


def _radii(radius, position):
    return numbers("radius", radius, (len(position),), positive=True)
