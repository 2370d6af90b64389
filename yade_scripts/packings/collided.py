"""Aggregates that a collision left: the largest piece of its last state, at rest, for the next collision (S17 section 4).

Grains of a run's last state still vibrate. Contacts are brought to rest as in cut.py, by the smallest motion that gives
each its equilibrium overlap; a run starts from contacts that have neither slid, rolled nor twisted.
"""

import numpy as np
from scipy.spatial.transform import Rotation

from analysis.runs.files import RunFolderError
from analysis.runs.folder import open_run
from yade_scripts.packings.cut import unpressed
from yade_scripts.packings.largest_piece import largest_cluster
from yade_scripts.packings.packing import Packing, PackingError, centred, random_stream


def largest_piece_of_run(path):
    """Packing of the largest piece in the last state of a run folder, around the origin, and about what it came from among
    its parameters: grains of the run (`of`), largest motion to rest [m]. Raises PackingError."""
    try:
        run = open_run(path)
        state, overlap = run.last, float(run.derived["equilibriumOverlap"])
        grain_radius = float(run.derived["grainRadius"])
    except (RunFolderError, KeyError, TypeError, ValueError) as error:
        raise PackingError(f"after = {path}: {' '.join(str(error).split())}; must be a run folder") from None
    if state.cell_size is not None or state.contact_bonded.any():
        raise PackingError(f"after = {path}: periodic, or with sintered bonds; must be a collision without them")
    inside, pairs = largest_cluster(len(state.radius), state.contact_pairs)
    position, radius = state.position[inside], state.radius[inside]
    moved = unpressed(position, radius, pairs, grain_radius, overlap)
    about = dict(
        packing="collided",
        grainRadius=grain_radius,
        overlap=overlap,
        of=len(state.radius),
        largestMotion=float(np.linalg.norm(moved - position, axis=1).max()),
    )
    return Packing(centred(moved, radius), radius, int(run.parameters.get("seed", 0)), about)


def turned(packing, seed, index=0):
    """The packing in a random orientation, of a seed and the number of the aggregate; one in the plane z = 0 stays in it."""
    stream = random_stream(seed, index)
    if np.any(packing.position[:, 2] != 0):
        rotation = Rotation.random(random_state=stream)
    else:
        rotation = Rotation.from_rotvec([0, 0, stream.uniform(0, 2 * np.pi)])
    position = rotation.apply(packing.position)
    position[:, 2] *= np.any(packing.position[:, 2] != 0)
    return Packing(position, packing.radius, seed, {**packing.parameters, "index": index})
