"""The largest connected piece of a packing."""

import numpy as np
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import connected_components

from yade_scripts.packings.packing import Packing, contacts


def largest_piece(packing):
    """The Packing of the grains that are connected with the most others, where they were; parameters: with `dropped`, how
    many are gone."""
    kept, _ = largest_cluster(packing.grains, contacts(packing))
    about = {**packing.parameters, "dropped": packing.grains - len(kept)}
    return Packing(packing.position[kept], packing.radius[kept], packing.seed, about)


def largest_cluster(grains, pairs):
    """(grains of the largest cluster that pairs (M,2) connect, its pairs in their rows)."""
    graph = csr_matrix((np.ones(len(pairs)), pairs.T), shape=(grains, grains))
    _, cluster = connected_components(graph, directed=False)
    kept = np.flatnonzero(cluster == np.bincount(cluster).argmax()) if grains else np.zeros(0, int)
    row = np.full(grains, -1)
    row[kept] = np.arange(len(kept))
    rows = row[pairs]
    return kept, rows[(rows >= 0).all(axis=1)]
