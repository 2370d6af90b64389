"""What a packing is like, in a line."""

import numpy as np

from analysis.measures.fragments import fragment_labels
from analysis.measures.structure import fractal_dimension, grains_within, mean_coordination
from yade_scripts.packings.packing import characteristic_radius, contacts, gyration_radius

NEAREST = 3.0  # grain radii: nearer than that the number of grains says how they touch
ORIGINS = 2000


def description(packing):
    """Grains, pieces, contacts, mean coordination, filling factor, radii of gyration and characteristic radius, fractal
    dimension; lengths in mean grain radii.

    The filling factor is the grains' volume over that of the sphere of the characteristic radius, the fractal dimension the
    mean slope of the number of grains about a grain (analysis.measures.structure) from NEAREST to the radius of gyration."""
    pairs, radius = contacts(packing), packing.radius.mean()
    pieces = int(fragment_labels(packing.grains, pairs).max()) + 1
    characteristic, gyration = characteristic_radius(packing), gyration_radius(packing)
    words = [
        f"{packing.grains} grains in {pieces} piece{'s' * (pieces > 1)}, {len(pairs)} contacts",
        f"mean coordination number {mean_coordination(packing.grains, pairs):.3f}",
        f"filling factor {(packing.radius**3).sum() / characteristic**3:.3g}",
        f"radius of gyration {gyration / radius:.4g}, characteristic radius {characteristic / radius:.4g} grain radii",
    ]
    if gyration > 2 * NEAREST * radius:
        distance = np.array([NEAREST * radius, gyration])
        dimension = fractal_dimension(distance, grains_within(packing.position, distance, origins=ORIGINS))
        words.append(f"fractal dimension {dimension[0]:.2f}")
    return ", ".join(words)
