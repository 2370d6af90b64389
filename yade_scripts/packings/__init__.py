"""Packings of spheres, made without YADE: numpy and scipy, and numba for BPCA. Lengths in m."""

from yade_scripts.packings.bcca import bcca  # noqa: F401
from yade_scripts.packings.bpca import bpca  # noqa: F401
from yade_scripts.packings.filling import grain_number, maximum_filling  # noqa: F401
from yade_scripts.packings.largest_piece import largest_piece  # noqa: F401
from yade_scripts.packings.lattice import cpe  # noqa: F401
from yade_scripts.packings.packing import (  # noqa: F401
    Packing,
    PackingError,
    centred,
    characteristic_radius,
    contacts,
    extent,
    gyration_radius,
    is_packing,
    load,
    moved,
    random_stream,
    require_apart,
    require_connected,
    save,
)
