"""Make aggregates, close-packed and extracted (cpe) or by ballistic cluster-cluster aggregation (bcca), and save them as .npz; needs no YADE.

    python3 yade_scripts/make_packing.py a.npz b.npz filling=0.4 radius=20 material=ice seed=3

The first file gets aggregate 0 of the seed, the second (if any) aggregate 1, as in collide.py.
"""

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
from yade_scripts import aggregates, packings
from yade_scripts.arguments import from_arguments
from yade_scripts.materials import MATERIALS, equilibrium_overlap
from yade_scripts.parameters import ParameterError, parse

TAKEN = ("packing", "filling", "radius", "grains", "planar", "material", "seed")


def make_packing(file, values, index):
    """Make aggregate number index, save it, print one line about it."""
    material = MATERIALS[values["material"]]
    packing = aggregates.make(values, material.grainRadius, equilibrium_overlap(material), index)
    packings.save(file, packing)
    coordination = 2 * len(packings.contacts(packing)) / packing.grains
    print(f"{file}: {packing.grains} grains, mean coordination number {coordination:.3f}")


def main(arguments):
    files = [argument for argument in arguments if "=" not in argument]
    if "--help" in arguments or not 1 <= len(files) <= 2:
        print(__doc__ + "\nparameters: " + ", ".join(TAKEN))
        return 0 if "--help" in arguments else 2
    texts = from_arguments(argument for argument in arguments if "=" in argument)
    for name in texts:
        if name not in TAKEN:
            raise ParameterError(f'{name}: no parameter of a packing; allowed: {", ".join(TAKEN)}')
    for index, file in enumerate(files):
        make_packing(file, parse(texts), index)
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1:]))
    except (ParameterError, packings.PackingError, OSError) as error:
        sys.exit(f"make_packing.py: {error}")
