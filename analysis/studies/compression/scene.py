"""What tells one compression from another, in one list: the groups and the key of a run follow from it."""

from ..grains import OF_GRAINS

OF_CELL = ("grains", "strainRate", "linearDamping", "stepFraction")
# What the runs of a group have in common; seeds and the end of the compression differ.
KEYS = ("material", *OF_CELL, *OF_GRAINS)

# Parameters of the scene that must be numbers, and what is measured: two runs that share all of these are one run.
NUMBERS = (*OF_CELL, "finalFilling", "seed")
MEASURED = (*OF_GRAINS, "initial_filling", "largest_filling", "last_filling", "stretched_axes")
