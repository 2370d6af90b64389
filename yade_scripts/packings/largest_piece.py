"""The largest connected piece of a packing."""

import numpy as np

from analysis.measures.fragments import fragment_labels
from yade_scripts.packings.packing import Packing, contacts


def largest_piece(packing):
    """The Packing of the grains that are connected with the most others, where they were; parameters: with `dropped`, how
    many are gone."""
    kept, _ = largest_cluster(packing.grains, contacts(packing))
    about = {**packing.parameters, "dropped": packing.grains - len(kept)}
    return Packing(packing.position[kept], packing.radius[kept], packing.seed, about)


def largest_cluster(grains, pairs):
    """(grains of the largest cluster that pairs (M,2) connect, its pairs in their rows)."""
    kept = np.flatnonzero(fragment_labels(grains, pairs) == 0)
    row = np.full(grains, -1)
    row[kept] = np.arange(len(kept))
    rows = row[pairs]
    return kept, rows[(rows >= 0).all(axis=1)]
