"""Theory in closed form, written from the papers alone: nothing here comes from the simulation code, but for what our
own runs measured (measured: values with errors).

Two grains: jkr, pair_constants, bonds, sticking (names below). Aggregates: andrews (two elastoplastic spheres),
aggregates (elastic constants, coordination, strength).

A22 = Arakawa et al. 2022 (viscous dissipation), A24 = Arakawa et al. 2024 (elastoplastic collisions), K13 = Kataoka
et al. 2013, S17 = Sirono & Ueno 2017 (sintered aggregates).
"""
# ruff: noqa: F401, I001

from .bonds import BondConstants, bond_constants, shrunk_radius
from . import measured
from .jkr import contact_radius, contact_radius_root, normal_energy, normal_force, normalised_energy, normalised_force
from .pair_constants import GRAIN_RADIUS, ICE, MATERIALS, SILICATE, Material, PairConstants
from .pair_constants import breaking_velocity, interaction_energies, pair_constants, time_unit
from .sticking import PairCollision, collide_pair, pair_motion, sticking_velocity, sticking_velocity_without_drag
