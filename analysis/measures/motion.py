"""How pieces and grains move against each other: on straight lines, as rigid bodies, and neighbours in the whole."""

import numpy as np
from scipy.spatial import cKDTree

_CHUNK = 4_000_000  # pairs of pieces compared at once
NEAR = 2.2  # A22's threshold distance of neighbours, in grain radii


def pieces_can_meet(position, velocity, radius, mass, labels, time):
    """Whether two pieces may touch within `time` [s] when every piece moves on with the velocity of its centre of
    mass: whether the spheres around any two of them meet.

    position, velocity (N,3) [m, m/s], radius (N,) [m], mass (N,) in any unit, labels (N,) as fragments.fragment_labels
    has them.
    """
    flight = _flight(position, velocity, radius, mass, labels)
    number = labels.max() + 1
    rows = max(1, _CHUNK // number)
    for first in range(0, number - 1, rows):
        part = np.arange(first, min(first + rows, number - 1))
        if (_meet(*flight, part, time) & (np.arange(number) > part[:, None])).any():
            return True
    return False


def pieces_that_can_meet(piece, position, velocity, radius, mass, labels, time):
    """Which pieces (K,) bool may touch the piece of this number; arguments as pieces_can_meet."""
    found = _meet(*_flight(position, velocity, radius, mass, labels), np.array([piece]), time)[0]
    found[piece] = False
    return found


def inner_kinetic_energy(position, velocity, mass, labels):
    """Kinetic energy [J] (K,) of each of K pieces beside that of its motion as a rigid body, the rotation of the
    grains themselves left out; position, velocity (N,3) [m, m/s], mass (N,) [kg], labels (N,)."""
    remaining = motion_in_pieces(position, velocity, mass, labels)
    return 0.5 * np.bincount(labels, weights=mass * np.einsum("ij,ij->i", remaining, remaining))


def motion_in_pieces(position, velocity, mass, labels):
    """Velocities (N,3) [m/s] of grains relative to their pieces, moving and turning as rigid bodies do that have the
    same momentum and angular momentum. Arguments as inner_kinetic_energy."""
    number = labels.max() + 1
    place = position - means_of_pieces(position, labels, mass)[labels]
    remaining = velocity - means_of_pieces(velocity, labels, mass)[labels]
    spin = np.stack([np.bincount(labels, weights=mass * c, minlength=number) for c in np.cross(place, remaining).T], 1)
    square = np.einsum("ij,ij->i", place, place)
    inertia = np.empty((number, 3, 3))
    for i in range(3):
        for j in range(3):
            product = (square if i == j else 0.0) - place[:, i] * place[:, j]
            inertia[:, i, j] = np.bincount(labels, weights=mass * product, minlength=number)
    # A piece of one or two grains has axes without inertia, about which it doesn't turn.
    turning = np.einsum("ijk,ik->ij", np.linalg.pinv(inertia, rcond=1e-9, hermitian=True), spin)
    return remaining - np.cross(turning[labels], place)


def means_of_pieces(values, labels, mass):
    """Mass-weighted means (K,3) over pieces of values (N,3)."""
    sums = [np.bincount(labels, weights=mass * component) for component in values.T]
    return np.stack(sums, 1) / np.bincount(labels, weights=mass)[:, None]


def pair_velocities(position, velocity, distance):
    """Normal component (M,) [m/s] of the relative velocity of the pairs of grains nearer than `distance` [m],
    positive where they approach (A22 section 5.1); position (N,3) [m], velocity (N,3) [m/s]."""
    pairs = cKDTree(position).query_pairs(distance, output_type="ndarray")
    apart = position[pairs[:, 1]] - position[pairs[:, 0]]
    relative = velocity[pairs[:, 1]] - velocity[pairs[:, 0]]
    length = np.linalg.norm(apart, axis=1)
    keep = length > 0
    return -np.einsum("ij,ij->i", apart, relative)[keep] / length[keep]


def root_mean_square(values):
    """(mean of the squares of values (M,))^(1/2); NaN without any."""
    return float(np.sqrt(np.mean(np.square(values)))) if len(values) else float("nan")


def _flight(position, velocity, radius, mass, labels):
    """Centres, velocities (K,3) and radii of the spheres (K,) around all pieces."""
    centre, motion = means_of_pieces(position, labels, mass), means_of_pieces(velocity, labels, mass)
    reach = np.zeros(len(centre))
    np.maximum.at(reach, labels, np.linalg.norm(position - centre[labels], axis=1) + radius)
    return centre, motion, reach


def _meet(centre, motion, reach, part, time):
    """(rows, number) bool: which pieces of a part meet which others, or themselves."""
    apart = centre[None, :] - centre[part, None]
    relative = motion[None, :] - motion[part, None]
    square = np.einsum("ijk,ijk->ij", relative, relative)
    towards = -np.einsum("ijk,ijk->ij", apart, relative)
    with np.errstate(invalid="ignore", divide="ignore"):
        nearest = np.clip(np.where(square > 0, towards / square, 0.0), 0.0, time)
    closest = apart + nearest[..., None] * relative
    return np.einsum("ijk,ijk->ij", closest, closest) < (reach[None, :] + reach[part, None]) ** 2
