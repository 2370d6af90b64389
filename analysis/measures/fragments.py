"""Fragments: grains connected by contacts, and what became of two aggregates' mass. A22: Arakawa et al. (2022)."""

import numpy as np
from scipy.sparse.csgraph import connected_components

from ..arrays import numbers, pairs
from .network import contact_network


def fragment_labels(grains, contact_pairs):
    """Fragment to which each grain belongs (N,) int, of N = `grains` grains joined by contact_pairs (M,2).

    Number 0 has the most grains, and so on; equally large ones are in the order of their first grain.

    >>> fragment_labels(5, [[1, 2], [2, 4]]).tolist()
    [1, 0, 0, 2, 0]
    """
    grains = int(numbers("grains", grains, (), least=0, whole=True))
    network = contact_network(grains, pairs("contact_pairs", contact_pairs, grains))
    _, labels = connected_components(network, directed=False)
    _, first, sizes = np.unique(labels, return_index=True, return_counts=True)
    rank = np.empty(len(sizes), dtype=np.intp)
    rank[np.lexsort((first, -sizes))] = np.arange(len(sizes))
    return rank[labels]


def fragment_sizes(labels):
    """Number of grains (K,) of each fragment, of labels (N,) as fragment_labels returns them.

    >>> fragment_sizes([1, 0, 0]).tolist()
    [2, 1]
    """
    return np.bincount(numbers("labels", labels, (None,), least=0, whole=True))


def grain_masses(state):
    """Masses (N,) of the grains of a state (a mapping): `mass` [kg] where grains are of several materials, else
    radius^3 [m^3]."""
    mass = state.get("mass")
    return state["radius"] ** 3 if mass is None else mass


def fragment_masses(labels, mass):
    """Mass (K,) of each fragment, of labels (N,) and the grains' mass (N,), in any unit.

    >>> fragment_masses([1, 0, 0], [8.0, 1.0, 2.0]).tolist()
    [3.0, 8.0]
    """
    labels = numbers("labels", labels, (None,), least=0, whole=True)
    return np.bincount(labels, weights=numbers("mass", mass, labels.shape, least=0))


def heaviest_fragment(labels, mass):
    """Number of the fragment with the most mass, of equal ones that with the most grains; arguments as
    fragment_masses."""
    return int(np.argmax(fragment_masses(labels, mass)))


def belongs_to_an_aggregate(aggregate, contact_pairs, mass, least_fraction=0.1):
    """Mask (N,) of the grains that are part of an aggregate at the start, not of crumbs that a packing left beside it.

    These are in a piece, connected within its aggregate, that holds at least least_fraction of the aggregate's mass.
    aggregate (N,) int, contact_pairs (M,2) int, mass (N,) in any unit. ValueError if an aggregate has no such grain.
    """
    aggregate, mass = np.asarray(aggregate), np.asarray(mass, dtype=float)
    contact_pairs = np.asarray(contact_pairs, dtype=np.intp).reshape(-1, 2)
    inside = contact_pairs[aggregate[contact_pairs[:, 0]] == aggregate[contact_pairs[:, 1]]]
    labels = fragment_labels(len(aggregate), inside)
    whole = np.bincount(aggregate, weights=mass)
    found = fragment_masses(labels, mass)[labels] >= least_fraction * whole[aggregate] * (1.0 - 1e-12)
    for number in np.setdiff1d(aggregate, aggregate[found]):
        must = f"its largest piece must hold {least_fraction:.0%} of its mass"
        raise ValueError(f"aggregate {number} is in crumbs: {must}")
    return found


def growth_efficiency(largest, target, projectile):
    """Growth efficiency (N_lar - N_tar)/N_pro from the numbers of grains of the largest fragment, the target and the
    projectile, or from their masses: A22 eq 28.

    >>> float(growth_efficiency(30, 20, 10))
    1.0
    """
    gained = numbers("largest", largest) - numbers("target", target)
    return (gained / numbers("projectile", projectile, positive=True))[()]


def cumulative_grains(sizes, upto):
    """Number of grains (G,) in fragments of at most N = upto (G,) grains, from the fragments' grains (K,): A22 eq 32.

    >>> cumulative_grains([5, 1, 1], [1, 4.9, 5]).tolist()
    [2.0, 2.0, 7.0]
    """
    sizes = numbers("sizes", sizes, (None,), least=0)
    return _sum_up_to(sizes, sizes, upto)


def cumulative_cross_section(sizes, upto):
    """Cross-sections N^(2/3) (G,) of fragments of at most N = upto (G,) grains, over one grain's: A22 eq 33.

    >>> cumulative_cross_section([8, 1, 1], [1, 8]).tolist()
    [2.0, 6.0]
    """
    sizes = numbers("sizes", sizes, (None,), least=0)
    return _sum_up_to(sizes, np.cbrt(sizes) ** 2, upto)


def _sum_up_to(sizes, values, upto):
    order = np.argsort(sizes, kind="stable")
    sums = np.concatenate([[0.0], np.cumsum(values[order])])
    return sums[np.searchsorted(sizes[order], np.floor(numbers("upto", upto, gaps=True)), side="right")]
