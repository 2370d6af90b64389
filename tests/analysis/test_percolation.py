"""How many axes a periodic network reaches across, on chains, sheets and lattices that are cut."""

import numpy as np
import pytest

from analysis.measures.percolation import spanned_axes

SIDE = 4


def lattice(axes):
    """(position, pairs, cell): a cubic lattice in its cell, connected with its images along these axes."""
    site = np.stack(np.meshgrid(*3 * [np.arange(SIDE)], indexing="ij"), axis=-1).reshape(-1, 3)
    pairs = []
    for k, place in enumerate(site):
        for axis in range(3):
            if place[axis] == SIDE - 1 and axis not in axes:
                continue
            pairs.append((k, int((place + np.eye(3, dtype=int)[axis]) % SIDE @ (SIDE**2, SIDE, 1))))
    return 1.0 * site, np.array(pairs), np.full(3, float(SIDE))


@pytest.mark.parametrize("axes", [(), (0,), (1, 2), (0, 1, 2)])
def test_lattices_connected_along_some_axes(axes):
    position, pairs, cell = lattice(axes)
    assert spanned_axes(position, pairs, cell) == len(axes)
    # Wherever the grains are: the same network.
    image = np.random.default_rng(1).integers(-2, 3, position.shape)
    assert spanned_axes(position + image * cell, pairs, cell) == len(axes)
    assert spanned_axes(position, pairs[:, ::-1], cell) == len(axes)


def test_a_diagonal_chain_spans_one_direction_only():
    """It crosses all three boundaries, and bears a load along its own direction alone."""
    position = np.arange(4)[:, None] * np.ones(3)
    pairs = np.array([(k, (k + 1) % 4) for k in range(4)])
    assert spanned_axes(position, pairs, np.full(3, 4.0)) == 1


def test_pieces_are_not_added_up_and_a_free_cluster_spans_nothing():
    """Two chains that cross without touching, along x and along y: no piece spans two directions."""
    along = np.arange(4.0)
    x = np.stack([along, np.zeros(4), np.zeros(4)], axis=1)
    y = np.stack([np.full(4, 2.0), along, np.full(4, 2.0)], axis=1)
    ring = np.array([(k, (k + 1) % 4) for k in range(4)])
    both = np.concatenate([ring, ring + 4])
    assert spanned_axes(np.concatenate([x, y]), both, np.full(3, 4.0)) == 1
    # One contact between them makes a network of two directions.
    assert spanned_axes(np.concatenate([x, y]), np.concatenate([both, [(2, 4)]]), np.full(3, 4.0)) == 2
    assert spanned_axes(np.eye(3), [(0, 1), (1, 2), (2, 0)], np.full(3, 9.0)) == 0
    assert spanned_axes(np.eye(3), [], np.full(3, 9.0)) == 0
