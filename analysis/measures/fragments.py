"""Fragments: grains connected by contacts, and what became of two aggregates' mass. A22: Arakawa et al. (2022)."""

import numpy as np
from scipy.sparse.csgraph import connected_components

from ..arguments import GRAIN_COUNT, NOT_NAN, NOT_NEGATIVE, PAIRS, POSITIVE, WHOLE, numbers, takes
from .network import contact_network


@takes(grains=GRAIN_COUNT, contact_pairs=PAIRS)
def fragment_labels(grains, contact_pairs):
    """Fragment number (N,) int of each of N = `grains` grains, joined by contact_pairs (M,2) int. Number 0
    has the most grains, and so on; equally large ones are in the order of their first grain.

    >>> fragment_labels(5, [[1, 2], [2, 4]]).tolist()
    [1, 0, 0, 2, 0]
    """
    _, labels = connected_components(contact_network(grains, contact_pairs), directed=False)
    _, first, sizes = np.unique(labels, return_index=True, return_counts=True)
    rank = np.empty(len(sizes), dtype=np.intp)
    rank[np.lexsort((first, -sizes))] = np.arange(len(sizes))
    return rank[labels]


@takes(labels=numbers("N", WHOLE))
def fragment_sizes(labels):
    """Number of grains (K,) int of each fragment, for labels (N,) as fragment_labels returns them.

    >>> fragment_sizes([1, 0, 0]).tolist()
    [2, 1]
    """
    return np.bincount(labels)


@takes(labels=numbers("N", WHOLE), mass=numbers("N", NOT_NEGATIVE))
def fragment_masses(labels, mass):
    """Mass (K,) of each fragment, for labels (N,) and grain masses (N,) in any unit.

    >>> fragment_masses([1, 0, 0], [8.0, 1.0, 2.0]).tolist()
    [3.0, 8.0]
    """
    return np.bincount(labels, weights=mass)


def heaviest_fragment(labels, mass):
    """Number of the fragment with the most mass; of equal ones that with the most grains. Arguments as fragment_masses.

    >>> heaviest_fragment([1, 0, 0], [9.0, 1.0, 2.0])
    1
    """
    return int(np.argmax(fragment_masses(labels, mass)))


def belongs_to_an_aggregate(aggregate, contact_pairs, mass, least_fraction=0.1):
    """Mask (N,) of the grains that are part of an aggregate at the start: those in a piece, connected within
    their aggregate, that holds at least least_fraction of the aggregate's mass. Grains that a packing left
    isolated or in crumbs are not.

    aggregate (N,) int, contact_pairs (M,2) int, mass (N,) in any unit. ValueError where no grain of an aggregate is.
    """
    aggregate, mass = np.asarray(aggregate), np.asarray(mass, dtype=float)
    pairs = np.asarray(contact_pairs, dtype=np.intp).reshape(-1, 2)
    inside = pairs[aggregate[pairs[:, 0]] == aggregate[pairs[:, 1]]]
    labels = fragment_labels(len(aggregate), inside)
    whole = np.bincount(aggregate, weights=mass)
    found = fragment_masses(labels, mass)[labels] >= least_fraction * whole[aggregate] * (1.0 - 1e-12)
    for number in np.setdiff1d(aggregate, aggregate[found]):
        raise ValueError(
            f"aggregate {number} is in crumbs: its largest piece must hold {least_fraction:.0%} of its mass"
        )
    return found


@takes(largest=numbers(), target=numbers(), projectile=numbers(right=POSITIVE))
def growth_efficiency(largest, target, projectile):
    """f_gro = (N_lar - N_tar)/N_pro from the numbers of grains of the largest fragment, of target and
    projectile: A22 eq 28. Of grains of unlike size the masses stand for the numbers.

    >>> float(growth_efficiency(30, 20, 10))
    1.0
    """
    return np.subtract(largest, target) / projectile


@takes(sizes=numbers("K", NOT_NEGATIVE), numbers=numbers(right=NOT_NAN))
def cumulative_number(sizes, numbers):
    """Z_cum(>= N) (G,): fragments of N grains or more, from the fragments' grains `sizes` (K,) at N = numbers (G,): A22
    eq 31.

    >>> cumulative_number([5, 1, 1], [1, 2, 6]).tolist()
    [3, 1, 0]
    """
    sizes = np.sort(sizes)
    return len(sizes) - np.searchsorted(sizes, np.ceil(numbers), side="left")


@takes(sizes=numbers("K", NOT_NEGATIVE), numbers=numbers(right=NOT_NAN))
def cumulative_grains(sizes, numbers):
    """N_cum(<= N) (G,): grains in fragments of at most N grains; arguments as cumulative_number. A22 eq 32.

    >>> cumulative_grains([5, 1, 1], [1, 4.9, 5]).tolist()
    [2.0, 2.0, 7.0]
    """
    return _up_to(sizes, np.asarray(sizes, dtype=float), numbers)


@takes(sizes=numbers("K", NOT_NEGATIVE), numbers=numbers(right=NOT_NAN))
def cumulative_cross_section(sizes, numbers):
    """S_cum(<= N)/S_1 (G,): cross-sections N^(2/3) of the fragments of at most N grains, in units of one grain's pi r_1^2;
    arguments as cumulative_number. A22 eq 33.

    >>> cumulative_cross_section([8, 1, 1], [1, 8]).tolist()
    [2.0, 6.0]
    """
    return _up_to(sizes, np.cbrt(np.asarray(sizes, dtype=float)) ** 2, numbers)


def _up_to(sizes, values, numbers):
    order = np.argsort(sizes, kind="stable")
    sums = np.concatenate([[0.0], np.cumsum(values[order])])
    return sums[np.searchsorted(np.asarray(sizes)[order], np.floor(numbers), side="right")]
