"""Packings of spheres, made without YADE: numpy and scipy, and numba for BPCA. Lengths in m."""

from yade_scripts.packings.ballistic import bcca, bpca  # noqa: F401
from yade_scripts.packings.files import is_packing, load, save  # noqa: F401
from yade_scripts.packings.lattice import cpe, grain_number, maximum_filling  # noqa: F401
from yade_scripts.packings.packing import (  # noqa: F401
    Packing,
    PackingError,
    centred,
    characteristic_radius,
    contacts,
    extent,
    gyration_radius,
    largest_piece,
    moved,
    random_stream,
    require_connected,
)
