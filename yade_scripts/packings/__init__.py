"""Packings of spheres, made without YADE: numpy and scipy only. Lengths in m."""

from yade_scripts.packings.bcca import bcca  # noqa: F401
from yade_scripts.packings.filling import grain_number, maximum_filling  # noqa: F401
from yade_scripts.packings.lattice import cpe  # noqa: F401
from yade_scripts.packings.packing import (  # noqa: F401
    Packing,
    PackingError,
    contacts,
    extent,
    load,
    moved,
    random_stream,
    require_apart,
    save,
)
