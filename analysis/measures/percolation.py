"""Whether the contacts of a periodic cell reach from it to its own images, and along how many axes."""

import numpy as np
from scipy.sparse.csgraph import connected_components

from .network import contact_network, spanning_forest


def spanned_axes(position, pairs, cell_size):
    """Number of independent directions, 0 to 3, along which a piece of the network is connected with its own images.

    position (N,3) [m], anywhere; pairs (M,2): rows of the grains in contact, which meet as nearest images; cell_size (3,)
    [m]. A loop of contacts that comes back to an image of the grain that it left winds around the cell; the number of
    independent windings of a piece is counted, the largest is returned. A network with less than three bears no load along
    some direction.

    >>> spanned_axes(np.zeros((1, 3)), np.empty((0, 2)), np.ones(3))
    0
    """
    pairs = np.asarray(pairs, dtype=np.intp).reshape(-1, 2)
    grains = len(position)
    if not len(pairs):
        return 0
    first, second = pairs.T
    crossed = np.round((position[first] - position[second]) / cell_size).astype(int)
    network = contact_network(grains, pairs)
    image = _images(network, {**_steps(first, second, crossed), **_steps(second, first, -crossed)})
    windings = crossed - (image[second] - image[first])
    piece = connected_components(network, directed=False)[1][first]
    wound = windings.any(axis=1)
    ranks = [np.linalg.matrix_rank(windings[wound & (piece == name)]) for name in np.unique(piece[wound])]
    return int(max(ranks, default=0))


def _steps(here, there, crossed):
    """{(grain, its neighbour): boundaries (3,) between them}."""
    return {(a, b): step for a, b, step in zip(here.tolist(), there.tolist(), crossed)}


def _images(network, steps):
    """(N,3) int: in which image of the cell each grain is, seen along the contacts from the first grain of its piece."""
    order, parent = spanning_forest(network)
    image = np.zeros((len(parent), 3), dtype=int)
    for grain in order[parent[order] >= 0]:
        image[grain] = image[parent[grain]] + steps[int(parent[grain]), int(grain)]
    return image
