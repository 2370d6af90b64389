"""Whether the pieces of a collision can still meet or break: grains that fly apart on straight lines."""

import numpy as np
from scipy.sparse import coo_matrix

from .fragments import fragment_labels

_CHUNK = 4_000_000  # pairs of pieces compared at once


def pieces_can_meet(position, velocity, radius, labels, time):
    """Whether two pieces may touch within `time` [s] when every piece moves on with the velocity of its centre of mass:
    whether the spheres around any two of them meet. Grains of one density.

    position, velocity (N,3) [m, m/s], radius (N,) [m], labels (N,) as fragments.fragment_labels has them.
    """
    number = labels.max() + 1
    mass = radius**3
    centre, motion = _means(position, labels, mass), _means(velocity, labels, mass)
    reach = np.zeros(number)
    np.maximum.at(reach, labels, np.linalg.norm(position - centre[labels], axis=1) + radius)
    rows = max(1, _CHUNK // number)
    for first in range(0, number - 1, rows):
        part = slice(first, min(first + rows, number - 1))
        if _meet(centre, motion, reach, part, time).any():
            return True
    return False


def _meet(centre, motion, reach, part, time):
    """(rows, number) bool: which pieces of a part meet which others with a larger number."""
    apart = centre[None, :] - centre[part, None]
    relative = motion[None, :] - motion[part, None]
    square = np.einsum("ijk,ijk->ij", relative, relative)
    towards = -np.einsum("ijk,ijk->ij", apart, relative)
    with np.errstate(invalid="ignore", divide="ignore"):
        nearest = np.clip(np.where(square > 0, towards / square, 0.0), 0.0, time)
    closest = apart + nearest[..., None] * relative
    near = np.einsum("ijk,ijk->ij", closest, closest) < (reach[None, :] + reach[part, None]) ** 2
    others = np.arange(len(centre))[None, :] > np.arange(part.start, part.stop)[:, None]
    return near & others


def inner_kinetic_energy(position, velocity, mass, labels):
    """Kinetic energy [J] (K,) of each of K pieces beside that of its motion as a rigid body, the rotation of the grains
    themselves left out; position, velocity (N,3) [m, m/s], mass (N,) [kg], labels (N,)."""
    remaining = motion_in_pieces(position, velocity, mass, labels)
    return 0.5 * np.bincount(labels, weights=mass * np.einsum("ij,ij->i", remaining, remaining))


def motion_in_pieces(position, velocity, mass, labels):
    """Velocities (N,3) [m/s] of grains relative to their pieces, moving and turning as rigid bodies do that have the
    same momentum and angular momentum. Arguments as inner_kinetic_energy."""
    number = labels.max() + 1
    place = position - _means(position, labels, mass)[labels]
    remaining = velocity - _means(velocity, labels, mass)[labels]
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


def bulk_kinetic_energy(position, velocity, mass, labels, aggregate):
    """Kinetic energy [J] (K,) of the motion in each piece (motion_in_pieces) of its target's grains as a whole and its
    projectile's as a whole; aggregate (N,) 0 or 1. While a piece is being drawn out this is not small."""
    remaining = motion_in_pieces(position, velocity, mass, labels)
    group = 2 * labels + aggregate
    number = 2 * (labels.max() + 1)
    whole = np.bincount(group, weights=mass, minlength=number)
    momentum = np.stack([np.bincount(group, weights=mass * c, minlength=number) for c in remaining.T], 1)
    energy = 0.5 * np.einsum("ij,ij->i", momentum, momentum) / np.where(whole > 0, whole, 1.0)
    return energy.reshape(-1, 2).sum(axis=1)


def _means(values, labels, mass):
    """Mass-weighted means (K,3) over pieces of values (N,3)."""
    rows = np.arange(len(labels))
    sums = coo_matrix((mass, (labels, rows)), shape=(labels.max() + 1, len(labels))).tocsr()
    return (sums @ values) / np.bincount(labels, weights=mass)[:, None]


def has_come_to_rest(state, mass, breaking, time, per_grain=0.02, bulk=10.0):
    """Whether no fragment can change any more within `time` [s], as far as free flight tells.

    No two pieces can meet (pieces_can_meet), and none can break: in every piece the kinetic energy of the motion within
    is below per_grain * breaking a grain, and that of target against projectile below bulk * breaking. state: a mapping
    with position, velocity (N,3), radius, aggregate (N,), contact_pairs (M,2), SI; mass (N,) [kg]; breaking: energy
    [J] that breaks a contact (A22 eq 12).
    """
    position, velocity = state["position"], state["velocity"]
    labels = fragment_labels(len(mass), state["contact_pairs"])
    numbers = np.bincount(labels)
    if np.any(inner_kinetic_energy(position, velocity, mass, labels) > per_grain * breaking * numbers):
        return False
    if np.any(bulk_kinetic_energy(position, velocity, mass, labels, state["aggregate"]) > bulk * breaking):
        return False
    return not pieces_can_meet(position, velocity, state["radius"], labels, time)
