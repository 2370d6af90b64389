# SPDX-License-Identifier: MIT
"""The JKR-Wada law in the terms of ON-DEM's open file format (github.com/ON-DEM/ON-DEM-WG3-FileFormat, b8e6fb2):
classes for its materials.py and interaction.py, which define base_material, normal, shear and Vector3.

yade_mapping.json beside it says where they are in YADE with this plugin. A run needs besides, from its script: k_n,
slidingStiffnessFactor, whether springs are held or cut at their limits, and with bonds each one's neck and the radii to
which grains have shrunk; to go on to the same bits each contact's relative velocity of the last step.
"""

from base_types import Vector3
from interaction import normal, shear
from materials import base_material

# ---- for materials.py ----


class jkr_wada(base_material):
    """Elastic adhesive spheres with springs against sliding, rolling and twisting (JKR 1971; Wada et al. 2007)."""

    young_modulus: float = None
    """**[mandatory]** Young's modulus, $E$, [$FL^{-2}$]"""

    poisson_ratio: float = None
    """**[mandatory]** Poisson's ratio, $\\nu$, [$-$]"""

    surface_energy: float = None
    """**[mandatory]** energy of one surface, $\\gamma$; the pull-off force is $3\\pi\\gamma R^*$, [$FL^{-1}$]"""

    critical_rolling_displacement: float = None
    """**[mandatory]** displacement at which the rolling spring is held, $\\xi_\\mathrm{crit}$, [$L$]"""

    viscoelastic_time: float = 0.0
    """*[optional]* time of the viscous normal drag (Arakawa et al. 2022, eq 7), $T_\\mathrm{vis}$, [$T$]"""


# ---- for interaction.py ----


class jkr_wada_interaction(normal, shear):
    """Contact of two jkr_wada materials; stiffnesses and limits follow from these and the radii."""

    touching: bool = None
    """**[mandatory]** whether the neck exists: it forms at zero overlap and is kept until $-\\delta_c$"""

    pointer1: Vector3 = Vector3(0, 0, 0)
    """**[mandatory]** contact pointer of body 1, a unit vector, turns with it, global frame, $\\mathbf{n}_1$, [$-$]"""

    pointer2: Vector3 = Vector3(0, 0, 0)
    """**[mandatory]** contact pointer of body 2, likewise, $\\mathbf{n}_2$, [$-$]"""

    twist: float = 0.0
    """**[mandatory]** angle of the twisting spring, $\\phi$, [$-$]"""

    overlap: float = 0.0
    """**[mandatory]** overlap of the last step, for drag and for events within a step, $\\delta$, [$L$]"""

    bonded: bool = False
    """*[optional]* whether a sintered bond joins the bodies (Sirono & Ueno 2017)"""

    rest_distance: float = 0.0
    """*[optional]* distance of the centres at which a bond is unstrained, [$L$]"""

    drag_force: float = 0.0
    """*[optional]* viscous normal force of the last step, positive in traction as normal_force is, [$F$]"""
