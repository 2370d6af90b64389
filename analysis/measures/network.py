"""The network of contacts of a packing: grains joined by pairs."""

import numpy as np
from scipy.sparse import bmat, coo_matrix
from scipy.sparse.csgraph import breadth_first_order, connected_components


def contact_network(grains, pairs):
    """Sparse matrix (N,N) of N = `grains` grains with an entry for each of pairs (M,2) int, as scipy's csgraph takes it."""
    pairs = np.asarray(pairs, dtype=np.intp).reshape(-1, 2)
    return coo_matrix((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(grains, grains)).tocsr()


def spanning_forest(network):
    """(order (N,), parent (N,)) int of a tree of contacts in each piece of a contact_network, rooted in its last grain: every
    grain comes after its parent in `order`; parent is -1 for roots.

    >>> order, parent = spanning_forest(contact_network(4, [[1, 2], [2, 3]]))
    >>> order.tolist(), parent.tolist()
    ([0, 3, 2, 1], [-1, 2, 3, -1])
    """
    grains = network.shape[0]
    labels = connected_components(network, directed=False)[1]
    roots = np.sort(grains - 1 - np.unique(labels[::-1], return_index=True)[1])
    to_roots = coo_matrix((np.ones(len(roots)), (np.zeros(len(roots), dtype=int), roots)), shape=(1, grains))
    # One search from a node above all roots.
    order, before = breadth_first_order(bmat([[network, None], [to_roots, np.zeros((1, 1))]]), grains, directed=False)
    parent = before[:grains]
    return order[1:], np.where(parent == grains, -1, parent)


def depths(order, parent):
    """Contacts (N,) int between each grain and the root of its tree, of a spanning_forest.

    >>> depths(*spanning_forest(contact_network(4, [[1, 2], [2, 3]]))).tolist()
    [0, 2, 1, 0]
    """
    depth = np.zeros(len(parent), dtype=int)
    for grain in order[parent[order] >= 0]:
        depth[grain] = depth[parent[grain]] + 1
    return depth
