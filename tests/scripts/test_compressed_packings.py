"""Spheres cut out of compressed cells, at the filling of the table."""

import os

import numpy as np
import pytest

from yade_scripts import packings
from yade_scripts.materials import MATERIALS, equilibrium_overlap
from yade_scripts.packings.from_run import PeriodicState
from yade_scripts.studies import compressed

R = MATERIALS["ice"].grainRadius
OVERLAP = equilibrium_overlap(MATERIALS["ice"])


def diluted_crystal(filling):
    """PeriodicState of a cubic cell with fcc sites, some of them empty."""
    spacing, cells = 2 * R - OVERLAP, 12
    edge = 2**0.5 * spacing
    basis = np.array([[0, 0, 0], [0, 0.5, 0.5], [0.5, 0, 0.5], [0.5, 0.5, 0]])
    corners = np.stack(np.meshgrid(*3 * [np.arange(cells)], indexing="ij"), axis=-1).reshape(-1, 1, 3)
    sites = ((corners + basis) * edge).reshape(-1, 3)
    wanted = round(filling * (cells * edge) ** 3 / (4 / 3 * np.pi * R**3))
    kept = np.sort(np.random.default_rng(5).choice(len(sites), wanted, replace=False))
    packing = packings.Packing(sites[kept], np.full(wanted, R), 0)
    cell = np.full(3, cells * edge)
    return PeriodicState(packing.position, packing.radius, packings.contacts(packing), cell, OVERLAP)


@pytest.fixture
def made_cell(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(compressed, "RADIUS", 8)
    monkeypatch.setattr(compressed, "read_periodic_state", lambda path: diluted_crystal(0.4))
    states = os.path.join(compressed.CELLS, "f0.4-s3", "states")
    os.makedirs(states)
    os.makedirs(compressed.PACKINGS)
    return open(os.path.join(states, "000001.npz"), "w").close()


def test_both_spheres_have_the_filling_of_the_table(made_cell):
    compressed.cut_pair(0.4, 3)
    pair = list(map(packings.load, compressed.files_of(0.4, 3)))
    for packing in pair:
        assert packing.grains / 8**3 == packing.parameters["filling"] == pytest.approx(0.4, rel=compressed.TOLERANCE)
        assert (packing.parameters["cell"], packing.parameters["nominal"]) == (3, 0.4)
        assert packings.extent(packing) < 8.6 * R
    assert pair[0].grains != pair[1].grains or not np.allclose(pair[0].position, pair[1].position)
    before = os.stat(compressed.files_of(0.4, 3)[1]).st_mtime_ns
    compressed.cut_pair(0.4, 3)
    assert os.stat(compressed.files_of(0.4, 3)[1]).st_mtime_ns == before
