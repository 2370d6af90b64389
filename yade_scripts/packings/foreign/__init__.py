"""Spheres that other programs wrote: which format a file has is told by what it holds, not by its name."""

from yade_scripts.packings.foreign.read import read_spheres  # noqa: F401
from yade_scripts.packings.foreign.spheres import IN_A_METRE, Spheres  # noqa: F401
