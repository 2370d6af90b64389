"""What tells one compression from another, in one list: the groups, the key of a run and its columns follow from it."""

# The grains, and the law between them: everything that sets a pressure, E_roll or t0.
OF_GRAINS = (
    "grainRadius",
    "young",
    "poisson",
    "density",
    "surfaceEnergy",
    "criticalRolling",
    "slidingStiffnessFactor",
)
OF_CELL = ("grains", "strainRate", "linearDamping", "stepFraction")
# What the runs of a group have in common; seeds and the end of the compression differ.
KEYS = ("material", *OF_CELL, *OF_GRAINS)

# Parameters of the scene that must be numbers, and what is measured: two runs that share all of these are one run.
NUMBERS = (*OF_CELL, "finalFilling", "seed")
MEASURED = (*OF_GRAINS, "initial_filling", "largest_filling", "last_filling", "stretched_axes")
