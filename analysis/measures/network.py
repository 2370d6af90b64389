"""The network of contacts of a packing: trees, loops, and whether it spans a periodic cell."""

import numpy as np
from scipy.sparse import bmat, coo_matrix
from scipy.sparse.csgraph import breadth_first_order, connected_components


def contact_network(grains, pairs, lengths=None):
    """Sparse matrix (N,N) of N = `grains` grains with an entry for each of pairs (M,2) int, 1 or of lengths (M,), for
    scipy's csgraph."""
    pairs = np.asarray(pairs, dtype=np.intp).reshape(-1, 2)
    entries = np.ones(len(pairs)) if lengths is None else lengths
    return coo_matrix((entries, (pairs[:, 0], pairs[:, 1])), shape=(grains, grains)).tocsr()


def spanning_forest(network):
    """(order (N,), parent (N,)) int of a tree of contacts in each piece of a contact_network, rooted in its last grain.

    Every grain comes after its parent in `order`; the parent of a root is -1."""
    grains = network.shape[0]
    labels = connected_components(network, directed=False)[1]
    roots = np.sort(grains - 1 - np.unique(labels[::-1], return_index=True)[1])
    to_roots = coo_matrix((np.ones(len(roots)), (np.zeros(len(roots), dtype=int), roots)), shape=(1, grains))
    # One search from a node above all roots.
    order, before = breadth_first_order(bmat([[network, None], [to_roots, np.zeros((1, 1))]]), grains, directed=False)
    parent = before[:grains]
    return order[1:], np.where(parent == grains, -1, parent)


def depths(order, parent):
    """Contacts (N,) int between each grain and the root of its tree, of a spanning_forest."""
    depth = np.zeros(len(parent), dtype=int)
    for grain in order[parent[order] >= 0]:
        depth[grain] = depth[parent[grain]] + 1
    return depth


def loops(grains, pairs):
    """(independent loops, grains in loops) of N = `grains` grains joined by pairs (M,2), each pair once (S17 section
    5.4).

    Independent are M - N + pieces. A grain is in a loop if contacts lead from it back to it without using one twice.

    >>> loops(5, [[0, 1], [1, 2], [2, 0], [2, 3], [3, 4]])
    (1, 3)
    """
    pairs = np.asarray(pairs, dtype=np.intp).reshape(-1, 2)
    order, parent = spanning_forest(contact_network(grains, pairs))
    depth = depths(order, parent)
    inside = np.zeros(grains, dtype=bool)
    for i, j in pairs[(parent[pairs[:, 0]] != pairs[:, 1]) & (parent[pairs[:, 1]] != pairs[:, 0])]:
        while i != j:  # up the tree to where both ways meet
            inside[[i, j]] = True
            i, j = (parent[i], j) if depth[i] >= depth[j] else (i, parent[j])
        inside[i] = True
    return len(pairs) - grains + int((parent < 0).sum()), int(inside.sum())


def images(grains, pairs, crossed):
    """In which image of a periodic cell (N, 3) int each of N = `grains` grains is, followed along a spanning_forest.

    crossed (M, 3) int: of each pair, how many edges the second grain has to be moved to be beside the first. A piece is
    whole there unless it winds around the cell: then image[second] - image[first] is not `crossed` for all its pairs.
    """
    steps = {(a, b): step for (a, b), step in zip(np.asarray(pairs).tolist(), crossed)}
    steps |= {(b, a): -step for (a, b), step in steps.items()}
    order, parent = spanning_forest(contact_network(grains, pairs))
    image = np.zeros((grains, 3), dtype=int)
    for grain in order[parent[order] >= 0]:
        image[grain] = image[parent[grain]] + steps[int(parent[grain]), int(grain)]
    return image


def spanned_axes(position, pairs, cell_size):
    """Number of independent directions, 0 to 3, along which a piece of a periodic cell is connected with its own
    images.

    position (N,3) [m], anywhere; pairs (M,2) of grains that meet as nearest images; cell_size (3,) [m]. A loop of
    contacts that comes back to an image of the grain that it left winds around the cell; the largest number of
    independent windings of a piece is returned. With less than three the network bears no load along some direction."""
    pairs = np.asarray(pairs, dtype=np.intp).reshape(-1, 2)
    if not len(pairs):
        return 0
    first, second = pairs.T
    crossed = np.round((position[first] - position[second]) / cell_size).astype(int)
    image = images(len(position), pairs, crossed)
    windings = crossed - (image[second] - image[first])
    piece = connected_components(contact_network(len(position), pairs), directed=False)[1][first]
    wound = windings.any(axis=1)
    ranks = [np.linalg.matrix_rank(windings[wound & (piece == name)]) for name in np.unique(piece[wound])]
    return int(max(ranks, default=0))
