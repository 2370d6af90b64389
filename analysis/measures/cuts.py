"""Where a piece may still break: cuts through its contacts, the energy of the motion of the two sides against each other, and the energy that the
contacts of the cut hold."""

import numpy as np

from .free_flight import motion_in_pieces
from .network import contact_network, depths, spanning_forest


def loose_cuts(position, velocity, mass, pairs, labels, aggregate, strength):
    """(pieces (K,), masses (K,) of the smaller sides) of the cuts whose sides move against each other with more kinetic energy than the contacts of
    the cut hold, the motion of the piece as a rigid body left out.

    Cuts are: through every contact that alone connects two parts of a piece, and between a piece's grains of either aggregate.
    position, velocity (N,3) [m, m/s], mass (N,) [kg], pairs (M,2) with strength (M,) [J], the energy that breaks each contact;
    labels (N,) as fragments.fragment_labels has them, aggregate (N,) 0 or 1. Beside a plate, the last grain and of aggregate 1 (plate.py), the
    others' masses are lost in rounding: sides are summed without it.
    """
    momentum = mass[:, None] * motion_in_pieces(position, velocity, mass, labels)
    whole = np.bincount(labels, weights=mass)
    piece, side, pushed, held = (
        np.concatenate(parts)
        for parts in zip(
            _between_aggregates(mass, momentum, pairs, labels, aggregate, strength),
            _through_one_contact(mass, momentum, pairs, labels, strength),
        )
    )
    rest = whole[piece] - side
    with np.errstate(divide="ignore", invalid="ignore"):
        energy = 0.5 * np.einsum("ij,ij->i", pushed, pushed) * (1 / side + 1 / rest)
    loose = (side > 0) & (rest > 0) & (energy > held)
    return piece[loose], np.minimum(side, rest)[loose]


def _between_aggregates(mass, momentum, pairs, labels, aggregate, strength):
    """(piece, mass, momentum (K,3), energy that holds) of the side of aggregate 0 in every piece."""
    number, first = labels.max() + 1, aggregate == 0
    across = aggregate[pairs[:, 0]] != aggregate[pairs[:, 1]]
    held = np.bincount(labels[pairs[across, 0]], weights=strength[across], minlength=number)
    pushed = [np.bincount(labels[first], weights=p, minlength=number) for p in momentum[first].T]
    return (
        np.arange(number),
        np.bincount(labels[first], weights=mass[first], minlength=number),
        np.stack(pushed, 1),
        held,
    )


def _through_one_contact(mass, momentum, pairs, labels, strength):
    """The same of the part of a piece that one contact connects with the rest.

    Such contacts are found on a spanning tree: each of the other contacts closes a loop, and marks both of its ends with
    a random number. Where the marks beyond a contact of the tree cancel out (exclusive or), no loop leads around it.
    """
    order, parent = spanning_forest(contact_network(len(mass), pairs))
    contact = np.full(len(mass), -1)  # of the tree, with the parent
    marks = np.random.default_rng(0).integers(1, 2**63, len(pairs), dtype=np.uint64)
    for one, other in (pairs.T, pairs.T[::-1]):
        in_tree = parent[one] == other
        contact[one[in_tree]] = np.flatnonzero(in_tree)
        marks[in_tree] = 0
    mark, beyond = np.zeros(len(mass), dtype=np.uint64), np.column_stack([mass, momentum])
    for end in pairs.T:
        np.bitwise_xor.at(mark, end, marks)
    farther = np.flatnonzero(np.diff(depths(order, parent)[order])) + 1
    for level in np.split(order, farther)[:0:-1]:  # without the roots
        np.add.at(beyond, parent[level], beyond[level])
        np.bitwise_xor.at(mark, parent[level], mark[level])
    single = np.flatnonzero((contact >= 0) & (mark == 0))
    return labels[single], beyond[single, 0], beyond[single, 1:], strength[contact[single]]
