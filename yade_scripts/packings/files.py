"""Packings in files: written by save(), read back by load(), and checked for a run by packing_from_file()."""

import hashlib
import json
import os
import zipfile
from dataclasses import replace
from functools import lru_cache

import numpy as np

from analysis.runs.files import RunFolderError, npz, read_arrays, write_file
from analysis.runs.folder import read_quantities
from analysis.runs.format import FORMAT, STATE
from yade_scripts.packings.packing import (
    AT_REST,
    Packing,
    PackingError,
    centred,
    characteristic_radius,
    contacts,
    equilibrium_overlaps,
    gyration_radius,
    moved,
    surface_gaps,
)

SUM = "sha256"  # of a packing, among its parameters
SPHERES = [quantity for quantity in STATE if quantity.name in ("position", "radius")]
OF_CONTACTS = ("young", "poisson", "surfaceEnergy")  # what contacts at rest depend on, beside the radius
DEEPEST = 1.1  # equilibrium overlaps that a contact of a run's packing may have, as if pressed a little
CONTENT = "an .npz with position, radius, seed, parameters, as make_packing.py writes it"


def save(path, packing):
    """Write a packing as .npz: position (N, 3), radius (N,) in m, seed, parameters (a JSON text).

    gyration_radius and characteristic_radius [m] stand beside them, for whoever reads the file.
    """
    content = npz(
        position=packing.position,
        radius=packing.radius,
        seed=packing.seed,
        parameters=json.dumps(packing.parameters),
        gyration_radius=gyration_radius(packing),
        characteristic_radius=characteristic_radius(packing),
    )
    write_file(path, content)


def is_packing(path):
    """Whether a file is one that save() wrote, be its grains right or not."""
    try:
        return zipfile.is_zipfile(path) and bool(read_arrays(path, ("seed",), texts=("parameters",)))
    except (RunFolderError, OSError):
        return False


def load(path):
    """Read a packing that save() wrote; raises PackingError when it is none."""
    try:
        spheres, about = read_quantities(path, SPHERES, FORMAT), read_arrays(path, ("seed",), texts=("parameters",))
        return Packing(**spheres, seed=int(about["seed"]), parameters=dict(json.loads(about["parameters"])))
    except (RunFolderError, ValueError, TypeError) as error:
        reason = " ".join(str(error).removeprefix(f"{path}: ").split())
        raise PackingError(f"{path}: not a packing ({reason}); must be {CONTENT}") from None


def packing_from_file(path, grain_radius, overlap, planar=False, grains=None):
    """The packing in a file, with its centre of mass at the origin and the sum of its grains among its parameters.

    grain_radius, overlap: of the run's grains, and of two of them at rest [m]; planar: whether all grains must lie in
    the plane z = 0; grains: of the run, anything with the attributes OF_CONTACTS. Raises PackingError when it is made
    of other grains, or grains overlap too deeply.
    """
    packing = load(path)
    if packing.grains < 2:
        raise PackingError(f"{path}: holds {packing.grains} grains; must be N >= 2")
    _require_material(path, packing, grain_radius, overlap, grains)
    _require_shallow(path, packing, grain_radius, overlap)
    if planar and np.abs(packing.position[:, 2]).max() > 1e-9 * grain_radius:
        raise PackingError(f"{path}: grains lie beside the plane z = 0; must all be in it with planar = 1")
    found = moved(packing, (centred(packing.position, packing.radius) - packing.position)[0])
    return replace(found, parameters={**packing.parameters, SUM: _sum(packing)})


def sum_of_file(path):
    """SHA-256 of the grains in a packing's file, which a run keeps, to notice another file; None where it can't be
    read."""
    try:
        return _sum_as_written(path, os.stat(path).st_mtime_ns)
    except (OSError, PackingError):
        return None


@lru_cache
def _sum_as_written(path, _when):
    return _sum(load(path))


def _sum(packing):
    return hashlib.sha256(packing.position.tobytes() + packing.radius.tobytes()).hexdigest()


def _require_material(path, packing, grain_radius, overlap, grains):
    """The file's grains must be those of the run: contacts of others would pull or press from the start on. A cpe
    packing may have been made loose on purpose (initialOverlap)."""
    stored = {"grainRadius": float(np.median(packing.radius)), **packing.parameters}
    wanted = {name: (getattr(grains, name, None), 1e-6) for name in OF_CONTACTS}
    wanted["grainRadius"] = grain_radius, 1e-6
    if stored.get("packing") != "cpe":
        wanted["overlap"] = overlap, AT_REST
    for name, (value, tolerance) in wanted.items():
        if None in (stored.get(name), value) or np.isclose(stored[name], value, rtol=tolerance, atol=0):
            continue
        raise PackingError(
            f"{path}: made of grains with {name} = {stored[name]:.3g}, not {value:.3g}; must be a packing of such "
            f"grains, or the run's grains be those (one material for all packings of a run)"
        )


def _require_shallow(path, packing, grain_radius, overlap):
    """No contact may be far deeper than at rest."""
    pairs = contacts(packing)
    if not len(pairs):
        return
    deep = -surface_gaps(packing.position, packing.radius, pairs)
    at_rest = equilibrium_overlaps(packing.radius, pairs, grain_radius, overlap)
    worst = np.argmax(deep / at_rest)
    if deep[worst] > DEEPEST * at_rest[worst]:
        raise PackingError(
            f"{path}: grains {pairs[worst, 0]} and {pairs[worst, 1]} overlap by {deep[worst]:.3g} m; must be at most "
            f"{DEEPEST:g} of the equilibrium overlap of {at_rest[worst]:.3g} m"
        )
