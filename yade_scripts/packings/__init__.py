"""Packings of spheres, made without YADE: numpy and scipy, and numba for BPCA. Lengths in m."""

# ruff: noqa: F401
from yade_scripts.packings.ballistic import bcca, bpca
from yade_scripts.packings.lattice import cpe, grain_number, maximum_filling
from yade_scripts.packings.packing import (
    Packing,
    PackingError,
    brought_to_rest,
    centred,
    characteristic_radius,
    contacts,
    extent,
    gyration_radius,
    is_packing,
    largest_piece,
    load,
    moved,
    random_stream,
    require_connected,
    save,
)
