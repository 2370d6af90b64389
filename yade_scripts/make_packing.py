"""Make aggregates and save them as .npz; needs no YADE.

    python3 yade_scripts/make_packing.py a.npz b.npz filling=0.4 radius=20 seed=3
    python3 yade_scripts/make_packing.py a.npz packing=bpca grains=50000
    python3 yade_scripts/make_packing.py a.npz from=agg.xyz unit=um radius=0.1         of another program
    python3 yade_scripts/make_packing.py a.npz from=RUN/states/000059.npz radius=8     cut out of a compression

The first file gets aggregate 0 of the seed, the second (if any) aggregate 1, as in collide.py.

Other programs' aggregates may be npz, csv, xyz, extended xyz, LAMMPS data or dump, VTK, YAML of pyFracAggregate, or
text of DustCollider, FracVAL, PyFracVAL, aggregate_gen or YADE. Their contacts are brought to rest for the grains of
`material`; packings and states of collisions, RUN/states/NNNNNN.npz, name their own.
"""

import os
import signal
import sys
from dataclasses import dataclass

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
from analysis.startup import end_quietly, require_libraries

end_quietly(signal.SIGINT, signal.SIGTERM)
require_libraries()
from analysis.printable import printable, shell_line
from analysis.runs.files import require_output
from analysis.version import version_text
from yade_scripts import materials, packings
from yade_scripts.packings.aggregate import MADE, AggregateParameters, make
from yade_scripts.packings.from_run import CutParameters, cut, holds, read_periodic_state
from yade_scripts.packings.imported import ImportParameters, grains_of, imported
from yade_scripts.packings.packing import description
from yade_scripts.parameters import ParameterError, one_line_errors, one_of, parameter, show
from yade_scripts.run.parameters import from_arguments


@dataclass(frozen=True)
class MadeParameters(AggregateParameters):
    """How the aggregates are made."""

    packing: str = parameter("cpe", one_of(MADE), "close-packed and extracted, cluster-cluster or particle-cluster")


def _save(file, packing):
    packings.save(file, packing)
    print(printable(f"{file}: {description(packing)}"))


def _save_from(source, files, texts):
    """Save what is cut out of the state of a compression, or the aggregate of another program."""
    if holds(source, "cell_size"):
        state, parameters = read_periodic_state(source), CutParameters.parse(texts)
        for index, file in enumerate(files):
            _save(file, cut(state, parameters, index))
        return
    if len(files) > 1:
        raise ParameterError(f"{files[1]}: from = {source} is one aggregate; must be one file")
    packing, lines = imported(source, texts)
    print("\n".join(map(printable, lines)))
    _save(files[0], packing)
    print("in a run: " + shell_line(["packing=file", f"file={files[0]}", *grains_of(packing, texts.get("material"))]))


def main(arguments):
    files = [argument for argument in arguments if "=" not in argument]
    texts = from_arguments(argument for argument in arguments if "=" in argument)
    options = [argument for argument in files if argument.startswith("-")]
    if "--version" in options:
        print(f"make_packing.py {version_text()}")
        return 0
    if "--help" in options:
        show(
            f"{__doc__}\n{MadeParameters.help_text()}\n\nWith from=FILE of another program:\n"
            f"{ImportParameters.help_text()}\n\nWith from=RUN/states/NNNNNN.npz of a compression:\n"
            f"{CutParameters.help_text()}"
        )
        return 0
    if options:
        raise ParameterError(f"{options[0]}: not understood; must be name=value, or --help")
    if not 1 <= len(set(map(os.path.realpath, files))) == len(files) <= 2:
        raise ParameterError(f"{len(files)} files given; must be one or two to write, a.npz b.npz (names without =)")
    for file in files:
        if not file.endswith(".npz"):
            raise ParameterError(f"{file}: a packing is saved as .npz; must end in .npz")
        require_output(file, inputs=[texts["from"]] if "from" in texts else ())
        if os.path.exists(file) and not packings.is_packing(file):
            raise ParameterError(f"{file}: is there, and no packing; must be a new file, or a packing to replace")
    if "from" in texts:
        _save_from(texts.pop("from"), files, texts)
        return 0
    parameters = MadeParameters.parse(texts)
    materials.require_small_contacts(parameters)
    for index, file in enumerate(files):
        _save(file, make(parameters, materials.equilibrium_overlap(parameters), index))
    return 0


if __name__ == "__main__":
    with one_line_errors("make_packing.py"):
        sys.exit(main(sys.argv[1:]))
