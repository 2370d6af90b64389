"""Make aggregates and save them as .npz; needs no YADE.

    python3 yade_scripts/make_packing.py a.npz b.npz filling=0.4 radius=20 seed=3
    python3 yade_scripts/make_packing.py a.npz packing=bpca grains=50000
    python3 yade_scripts/make_packing.py a.npz from=RUN/states/000059.npz radius=8     cut out of a compression

The first file gets aggregate 0 of the seed, the second (if any) aggregate 1, as in collide.py. Parameters that a packing
doesn't depend on (density, criticalRolling, viscoelasticTime) are refused.
"""

import os
import signal
import sys
from dataclasses import dataclass

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
from analysis.signals import end_quietly

end_quietly(signal.SIGINT)
from analysis.runs.write import require_file
from analysis.version import version_text
from yade_scripts import materials, packings
from yade_scripts.packings.aggregate import MADE, AggregateParameters, make
from yade_scripts.packings.cut import CutParameters, cut, read_periodic_state
from yade_scripts.parameters import ParameterError, one_of, parameter
from yade_scripts.run.arguments import from_arguments

WITHOUT_EFFECT = ("density", "criticalRolling", "viscoelasticTime")


@dataclass(frozen=True)
class MadeParameters(AggregateParameters):
    """How the aggregates are made."""

    packing: str = parameter(
        "cpe", one_of(MADE), "close-packed and extracted, cluster-cluster or particle-cluster aggregation"
    )


def make_packing(file, parameters, index):
    """Make aggregate number index, save it, print one line about it."""
    constants = materials.pair_constants(parameters)
    materials.require_small_contacts(constants)
    _save(file, make(parameters, constants["equilibriumOverlap"], index))


def _save(file, packing):
    packings.save(file, packing)
    coordination = 2 * len(packings.contacts(packing)) / packing.grains
    characteristic = packings.characteristic_radius(packing) / packing.radius.mean()
    print(
        f"{file}: {packing.grains} grains, mean coordination number {coordination:.3f}, characteristic radius "
        f"{characteristic:.4g} grain radii"
    )


def main(arguments):
    if "--version" in arguments:
        print(f"make_packing.py {version_text()}")
        return 0
    files = [argument for argument in arguments if "=" not in argument]
    if "--help" in arguments or not 1 <= len(files) <= 2:
        print(
            f"{__doc__}\n{MadeParameters.help_text((*WITHOUT_EFFECT, 'file'))}\n\nWith from=:\n{CutParameters.help_text()}"
        )
        return 0 if "--help" in arguments else 2
    if len(set(map(os.path.realpath, files))) < len(files):
        raise ParameterError(f"{files[1]}: given twice; must be two files, one for each aggregate")
    texts = from_arguments(argument for argument in arguments if "=" in argument)
    for file in files:
        require_file(file, inputs=[texts["from"]] if "from" in texts else ())
    if "from" in texts:
        state, parameters = read_periodic_state(texts.pop("from")), CutParameters.parse(texts)
        for index, file in enumerate(files):
            _save(file, cut(state, parameters, index))
        return 0
    for name in WITHOUT_EFFECT:
        if name in texts:
            raise ParameterError(f"{name}: a packing doesn't depend on it; must be left out")
    parameters = MadeParameters.parse(texts)
    for index, file in enumerate(files):
        make_packing(file, parameters, index)
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1:]))
    except (ParameterError, packings.PackingError) as error:
        sys.exit(f"make_packing.py: {error}")
    except OSError as error:
        sys.exit(f"make_packing.py: {error.filename}: {error.strerror}")
