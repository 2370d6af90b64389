"""Aggregates that were saved as packings, checked before anything runs."""

import hashlib
import os
from dataclasses import replace
from functools import lru_cache

import numpy as np

from analysis.runs.files import SUM
from yade_scripts.packings.cut import OF_CONTACTS
from yade_scripts.packings.packing import PackingError, centred, contacts, load, moved, surface_gaps
from yade_scripts.packings.rest import AT_REST, equilibrium_overlaps

DEEPEST = 1.1  # equilibrium overlaps: what grains pressed together a little may have, and no more


def packing_from_file(path, grain_radius, overlap, planar=False, grains=None):
    """The packing that save() wrote to a file, its centre of mass at the origin, with sum_of_file() among its parameters.

    grain_radius: that of the run, overlap: of two such grains at rest, in m; grains: of the run, anything with the
    attributes OF_CONTACTS (None: not known). Raises PackingError, one line, when the file is none, an array has another
    shape or is not finite, it was made of grains of another radius or (as far as it says of what) material, grains overlap
    more deeply than DEEPEST of the equilibrium, or lie beside the plane z = 0 of a planar run.
    """
    packing = load(path)
    if packing.grains < 2:
        raise PackingError(f"{path}: holds {packing.grains} grains; must be N >= 2")
    _require_radius(path, packing, grain_radius)
    _require_material(path, packing.parameters, grains)
    _require_rest(path, packing.parameters, overlap)
    _require_contacts(path, packing, grain_radius, overlap)
    if planar and np.abs(packing.position[:, 2]).max() > 1e-9 * grain_radius:
        raise PackingError(f"{path}: grains lie beside the plane z = 0; must all be in it with planar = 1")
    found = moved(packing, (centred(packing.position, packing.radius) - packing.position)[0])
    return replace(found, parameters={**packing.parameters, SUM: _sum(packing)})


def sum_of_file(path):
    """SHA-256 of the grains in a packing's file, by which a run tells whether it is still the one that it had; None where it can't be read."""
    try:
        return _sum_as_written(path, os.stat(path).st_mtime_ns)
    except (OSError, PackingError):
        return None


@lru_cache
def _sum_as_written(path, _when):
    return _sum(load(path))


def _sum(packing):
    return hashlib.sha256(packing.position.tobytes() + packing.radius.tobytes()).hexdigest()


def _require_radius(path, packing, grain_radius):
    made_of = packing.parameters.get("grainRadius", float(np.median(packing.radius)))
    if not isinstance(made_of, (int, float)):
        raise PackingError(f"{path}: grainRadius among its parameters is {made_of!r}; must be a number [m]")
    if not np.isclose(made_of, grain_radius, rtol=1e-6, atol=0):
        raise PackingError(
            f"{path}: made of grains of {made_of:g} m, not {grain_radius:g} m; must be a packing of such grains, or "
            f"grainRadius = {made_of:g} (one for all packings of a run)"
        )


def _require_material(path, made_of, grains):
    """Of packings that say of which material they are (cut.py)."""
    for name in OF_CONTACTS:
        stored, wanted = made_of.get(name), getattr(grains, name, None)
        if stored is None or wanted is None:
            continue
        _require_number(path, name, stored)
        if not np.isclose(stored, wanted, rtol=1e-6, atol=0):
            raise PackingError(
                f"{path}: made of grains with {name} = {stored:g}, not {wanted:g}; must be a packing of such grains, or "
                f"{name} = {stored:g} (one for all packings of a run)"
            )


def _require_rest(path, made_of, overlap):
    """Contacts of a packing were made with the overlap that it says: where that is not at rest in this run, they pull or
    press, with an energy that was not put in. A cpe packing may have been made loose on purpose (initialOverlap)."""
    stored = made_of.get("overlap")
    if stored is None or made_of.get("packing") == "cpe":
        return
    _require_number(path, "overlap", stored)
    if abs(stored - overlap) > AT_REST * overlap:
        raise PackingError(
            f"{path}: its contacts overlap by {stored:.3g} m, those of these grains at rest by {overlap:.3g} m; must be a "
            "packing of grains of the same material"
        )


def _require_number(path, name, value):
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise PackingError(f"{path}: {name} among its parameters is {value!r}; must be a number")


def _require_contacts(path, packing, grain_radius, overlap):
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
