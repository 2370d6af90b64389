"""Grains of ice, of which packings here are made unless a test says another thing."""

import numpy as np

from yade_scripts.materials import MATERIALS, GrainParameters, equilibrium_overlap

ICE = MATERIALS["ice"]
GRAINS = GrainParameters().filled_in()
RADIUS = ICE.grainRadius
OVERLAP = equilibrium_overlap(ICE)
SPACING = 2 * RADIUS - OVERLAP  # of grains at rest
PAIR = np.array([[0.0, 0, 0], [SPACING, 0, 0]])
