"""Aggregates of other programs: which grains touch, and their contacts brought to rest.

Programs write grains that touch 2 r apart, or at the overlap of their own contact law, with the digits that they happen
to write; in a run a gap of 1e-16 m is no contact, and a contact out of rest pulls. Grains are taken to touch where the
gap between them is within what the digits hide; then all are moved as little as it takes."""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import minimum_spanning_tree
from scipy.spatial import cKDTree

from analysis.measures.fragments import fragment_labels, fragment_sizes
from analysis.measures.network import images
from yade_scripts import materials
from yade_scripts.materials import GrainParameters
from yade_scripts.packings import Packing, PackingError, centred, contacts, is_packing, largest_piece, load
from yade_scripts.packings.aggregate import MOST_GRAINS
from yade_scripts.packings.from_run import NO_RUN, holds, record_of_state
from yade_scripts.packings.packing import DEEPEST, OF_CONTACTS, at_rest, equilibrium_overlaps, surface_gaps, touching
from yade_scripts.packings.spheres import IN_A_METRE, read_spheres
from yade_scripts.parameters import POSITIVE, Check, ParameterError, one_line, one_of, parameter

OF_RADIUS = "radius"
SMALLEST, LARGEST = 1e-9, 1e-3  # m: radii of grains
SMALLEST_GAP, LARGEST_GAP = 1e-4, 0.05  # grain radii: within these a tolerance follows from the digits of the file
LARGEST_TOLERANCE = 0.5  # radii of the smallest grain
DEEPEST_OVERLAP = 0.1  # grain radii beyond that at rest, as under pressure; deeper ones have another radius or unit
LARGEST_PIECE = "largest"


@dataclass(frozen=True)
class ImportParameters(GrainParameters):
    """The aggregate of another program (from=FILE)."""

    unit: str | None = parameter(
        None,
        one_of([*IN_A_METRE, OF_RADIUS]),
        f"of the lengths in the file (m, unless the file names it); {OF_RADIUS}: they are in units of grainRadius",
    )
    radius: float | None = parameter(None, POSITIVE, "of the grains, where the file has no radii", "unit")
    names: str | None = parameter(
        None, Check("such as x,y,z,-,radius", lambda text: text != ""), "of a table's columns; - for those without use"
    )
    tolerance: float | None = parameter(
        None,
        Check(f"> 0 and at most {LARGEST_TOLERANCE:g}", lambda x: 0 < x <= LARGEST_TOLERANCE),
        f"gap up to which grains touch (what the digits of the file hide, {SMALLEST_GAP:g} to {LARGEST_GAP:g})",
        "radii of the smallest grain",
    )
    pieces: int = parameter(
        1, Check(f"a whole number > 0, or {LARGEST_PIECE}", lambda x: x > 0), "of the aggregate", word=LARGEST_PIECE
    )


def imported(path, texts):
    """(Packing, lines about what was read and how far grains were moved) of another program's aggregate, around the
    origin, its contacts at rest. texts: {name: text} of ImportParameters. Grains are of the file's material, unless one
    is given. Raises ParameterError and PackingError."""
    parameters = ImportParameters.parse(texts if "material" in texts else {**_material_of(path), **texts})
    if len(parameters.material_names) > 1:
        raise ParameterError(
            f"material = {parameters.material}: of an imported aggregate; must be one (a run mixes them)"
        )
    spheres = read_spheres(path, MOST_GRAINS, parameters.names and parameters.names.split(","))
    position, radius, tolerance, cell = _in_metres(path, spheres, parameters, "grainRadius" in texts)
    grain_radius = float(np.sort(radius)[len(radius) // 2])  # by which they are known
    parameters = parameters.changed(grainRadius=grain_radius)
    constants = materials.pair_constants(parameters)
    materials.require_small_contacts(parameters)
    overlap = constants["equilibriumOverlap"]
    wanted, lines = parameters.pieces, []
    if cell is not None and len(_pieces(position, radius, tolerance)) != wanted:
        position, across = unwrapped(path, position, radius, tolerance, cell)
        lines = [f"{path}: periodic; {across} grains were put back beside those that they touch across the box"]
    pairs = _contacts_in_file(path, position, radius, tolerance, grain_radius, overlap)
    rested, at_end, deviation = at_rest(position, radius, pairs, grain_radius, overlap)
    if np.abs(deviation).max(initial=0.0) > DEEPEST - 1:
        worst = np.abs(deviation).argmax()
        first, second = at_end[worst]
        what = f"grains {first} and {second} keep {1 + deviation[worst]:.3g} of the overlap at rest"
        must = f"must be {2 - DEEPEST:g} to {DEEPEST:g}"
        raise PackingError(f"{path}: the contacts cannot be brought to rest together: {what}; {must}")
    moved = float(np.linalg.norm(rested - position, axis=1).max())
    about = {"packing": "imported", "grainRadius": grain_radius, "overlap": overlap}
    about |= {"tolerance": tolerance, "largestMotion": moved}
    about |= {name: getattr(parameters, name) for name in OF_CONTACTS}
    packing = Packing(centred(rested, radius), radius, 0, about)
    lines += [
        f"{path}: {spheres.about}, {len(radius)} grains; those touch that are at most "
        f"{tolerance / radius.min():.2g} radii of the smallest apart: {len(pairs)} contacts",
        f"brought to rest: grains moved by up to {moved / grain_radius:.2g} grain radii, contacts are within "
        f"{np.abs(deviation).max(initial=0.0):.1g} of their overlap at rest, "
        f"{len(at_end) - len(pairs)} more came about",
    ]
    if wanted == LARGEST_PIECE:
        return largest_piece(packing), lines
    sizes = fragment_sizes(fragment_labels(packing.grains, contacts(packing)))
    if len(sizes) != wanted:
        shown = ", ".join(map(str, sizes[:4])) + (", ..." if len(sizes) > 4 else "")
        one = f", {_apart(position, radius)}" if len(sizes) > 1 else ""
        raise PackingError(
            f"{path}: in {len(sizes)} piece{'s' * (len(sizes) > 1)} of {shown} grains{one}; must be {wanted}: pieces="
            f"{len(sizes)} or {LARGEST_PIECE} if that is meant, or another tolerance, radius or unit"
        )
    return packing, lines


def grains_of(packing, material=None):
    """Arguments of a run with the grains of an imported packing: the material most like them, and what differs."""
    made_of = {name: packing.parameters[name] for name in ("grainRadius", *OF_CONTACTS)}

    def others(usual):
        usual = materials.MATERIALS[usual]
        same = {name: np.isclose(x, getattr(usual, name), rtol=1e-6, atol=0) for name, x in made_of.items()}
        return [f"{name}={x:.10g}" for name, x in made_of.items() if not same[name]]

    found = material or min(materials.MATERIALS, key=lambda name: len(others(name)))
    named = material is not None or found != ImportParameters().material
    return [f"material={found}"] * named + others(found)


def _material_of(path):
    """{name: value} of OF_CONTACTS in a state of a run or a packing of make_packing.py; {} of other files."""
    if is_packing(path):
        made_of = load(path).parameters
    elif not holds(path, "contact_pairs"):
        return {}
    else:
        try:
            made_of = record_of_state(path)["derived"]
        except NO_RUN as error:
            must = "must be in RUN/states, or material be given"
            raise PackingError(f"{path}: a state of a run, but {one_line(error)}; {must}") from None
    if made_of.get("materials"):
        raise PackingError(f"{path}: of several materials; must be of one, or material be given")
    return {name: made_of[name] for name in OF_CONTACTS if name in made_of}


def _in_metres(path, spheres, parameters, grain_radius_given):
    """(position (N, 3), radius (N,), gap up to which grains touch, edges (3,) of a periodic cell or None), in m."""
    unit = parameters.unit or spheres.unit or "m"
    if spheres.unit and unit != spheres.unit:
        raise ParameterError(f"unit = {unit}: {path} is in {spheres.unit}; must be left out")
    if grain_radius_given and unit != OF_RADIUS:
        raise ParameterError(f"grainRadius: follows from the file with unit = {unit}; must be left out")
    radius = spheres.radius
    if radius is not None and parameters.radius is not None:
        raise ParameterError(f"radius = {parameters.radius:g}: {path} has radii of its own; must be left out")
    if radius is None:
        if parameters.radius is None and unit != OF_RADIUS:
            raise ParameterError(f"radius: not given, and {path} has no radii; must be that of its grains [{unit}]")
        radius = np.full(len(spheres.position), parameters.radius or 1.0)
    in_unit = 1 / parameters.grainRadius if unit == OF_RADIUS else IN_A_METRE[unit]
    if unit != OF_RADIUS:
        typical = float(np.median(radius))
        fits = [f"unit={other}" for other, number in IN_A_METRE.items() if SMALLEST <= typical / number <= LARGEST]
        if f"unit={unit}" not in fits:
            raise PackingError(
                f"{path}: grains of {typical:g} {unit}; must be of {SMALLEST:g} to {LARGEST:g} m, as with "
                f"{' or '.join(fits) or 'no unit of length'}"
            )
    hidden = (np.sqrt(3.0) + 1.0) * spheres.resolution
    smallest = radius.min()
    gap = (parameters.tolerance or np.clip(hidden / smallest, SMALLEST_GAP, LARGEST_GAP)) * smallest
    # divided, not multiplied: 0.1 um is then 1e-7 m to the bit
    position, radius = (np.asarray(lengths / in_unit, dtype=float) for lengths in (spheres.position, radius))
    return position, radius, float(gap / in_unit), None if spheres.cell is None else spheres.cell / in_unit


def _contacts_in_file(path, position, radius, tolerance, grain_radius, overlap):
    """Pairs (M, 2) of grains that touch by the digits of the file; PackingError where they overlap too deeply."""
    pairs = touching(position, radius, tolerance)
    if not len(pairs):
        return pairs
    gaps, depth = surface_gaps(position, radius, pairs), equilibrium_overlaps(radius, pairs, grain_radius, overlap)
    smaller = radius[pairs].min(axis=1)
    beyond, allowed = -gaps - depth, np.maximum(tolerance, DEEPEST_OVERLAP * smaller)
    if (beyond > allowed).any():
        worst = np.argmax(beyond / smaller)
        first, second = pairs[worst]
        what = f"overlap by {beyond[worst] / smaller[worst]:.3g} radii of the smaller one more than at rest"
        must = f"must be at most {allowed[worst] / smaller[worst]:.2g}: another radius or unit, or a larger tolerance"
        raise PackingError(f"{path}: grains {first} and {second} {what}; {must}")
    # In a file of our own most are at the overlap of these grains, and so far from those that don't touch.
    at_rest_there = abs(np.median(gaps / depth) + 1.0) < 0.1
    return pairs[gaps <= np.maximum(0.0, tolerance - at_rest_there * depth)]


def _pieces(position, radius, gap):
    """Numbers of grains of the pieces of grains that are at most `gap` apart."""
    return fragment_sizes(fragment_labels(len(radius), touching(position, radius, gap)))


def _apart(position, radius):
    """How far the pieces of a file are apart, at the widest of the gaps that would join them."""
    smallest = radius.min()
    pairs = touching(position, radius, LARGEST_TOLERANCE * smallest)
    gaps = surface_gaps(position, radius, pairs)
    shift = smallest - gaps.min(initial=0.0)  # no edge of a sparse graph may be 0
    tree = minimum_spanning_tree(coo_matrix((gaps + shift, pairs.T), shape=(len(radius),) * 2))
    if tree.nnz < len(radius) - 1:
        return f"more than {LARGEST_TOLERANCE:g} radii of the smallest apart"
    return f"up to {1.005 * (tree.data.max() - shift) / smallest:.3g} radii of the smallest apart"


def unwrapped(path, position, radius, gap, edges):
    """(positions (N, 3) with every piece in one place, number of grains that were moved) of grains in a periodic cell.

    edges: (3,) of the cell, infinite across open sides; gap: up to which grains touch; all in one unit. PackingError
    where a piece touches its own image."""
    sides = np.where(np.isfinite(edges), edges, 0.0)  # 0: open, as cKDTree has it
    folded = np.where(sides > 0, np.mod(position, edges), position)
    folded[folded == edges] = 0.0  # by rounding
    pairs = cKDTree(folded, boxsize=sides).query_pairs(2 * radius.max() + gap, output_type="ndarray")
    between = position[pairs[:, 1]] - position[pairs[:, 0]]
    crossed = -np.round(between / edges).astype(int)  # by the second grain, beside the first
    touch = np.linalg.norm(between + crossed * sides, axis=1) - radius[pairs].sum(axis=1) <= gap
    pairs, crossed = pairs[touch], crossed[touch]
    image, labels = images(len(radius), pairs, crossed), fragment_labels(len(radius), pairs)
    image -= image[np.unique(labels, return_index=True)[1]][labels]  # the first grain of every piece stays
    if np.any(image[pairs[:, 1]] - image[pairs[:, 0]] != crossed):
        must = "must be an aggregate with room around it, or in coordinates that go on beyond the box"
        raise PackingError(f"{path}: grains touch their own images across the box of the file; {must}")
    return position + image * sides, int(np.any(image, axis=1).sum())
