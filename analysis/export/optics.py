"""Some grains of one state as input of optics codes: spheres for MSTM, a lattice of dipoles for DDSCAT."""

from dataclasses import replace

import numpy as np

from ..measures.fragments import fragment_labels
from ..measures.network import images
from ..printable import Refused
from ..progress import progress
from ..runs.files import make_folder, write_file
from ..runs.folder import State
from ..runs.format import STATE
from .fields import UNITS, Exported

DIPOLES = 8  # along the radius of the smallest grain
MOST_SITES = 500_000_000


def chosen(run, state=None, fragment=None):
    """The RunFolder with one of its states (a number from 0, or "last"), and of each state one fragment's grains
    (fields.GRAINS; 0 the largest), whole and without the periodic cell unless it spans that; and the number of its
    first state. Refused where there is no such one."""
    states, first = run.states, 0
    if state is not None:
        first = len(states) - 1 if state == "last" else int(state)
        if not 0 <= first < len(states):
            raise Refused(f"--state {state}: {run.path} has states 0 to {len(states) - 1}")
        states = (states[first],)
    if fragment is not None:
        states = tuple(_fragment(each, fragment) for each in states)
    return replace(run, states=states), first


def _fragment(state, number):
    rows = np.flatnonzero(fragment_labels(len(state.radius), state.contact_pairs) == number)
    if not len(rows):
        raise Refused(f"--fragment {number}: no such fragment at {state.time:.4g} s")
    new = np.full(len(state.radius), -1)
    new[rows] = np.arange(len(rows))
    kept = (new[state.contact_pairs] >= 0).all(axis=1)
    of_axis, arrays = {"N": rows, "M": kept}, {}
    for quantity in STATE:
        value, axis = getattr(state, quantity.name), quantity.shape[0] if quantity.shape else None
        if value is not None and axis not in ("P", "K"):  # no planes
            arrays[quantity.name] = value[of_axis[axis]] if axis in of_axis else value
    arrays["contact_pairs"] = new[arrays["contact_pairs"]]
    return _whole(State(**arrays))


def _whole(state):
    """The state of a piece without its periodic cell, no contact broken; as it is where the piece spans the cell."""
    if state.cell_size is None:
        return state
    edges = np.diag(state.cell_size) if state.cell_vectors is None else state.cell_vectors
    first, second = state.contact_pairs.T
    between = state.position[first] - state.position[second]
    crossed = np.round(between @ np.linalg.inv(edges).T).astype(int)
    image = images(len(state.radius), state.contact_pairs, crossed)
    if np.any(image[second] - image[first] != crossed):
        return state
    whole = {"position": state.position + image @ edges.T, "cell_size": None, "cell_vectors": None}
    return State(**{**vars(state), **whole})


def write_mstm(run, folder, unit="m", first=0):
    """The spheres of each state as NNNNNN.pos, from the number `first` on, lines of x y z radius about their middle;
    returns the folder. MSTM's sphere_data_input_file, and what pymstm reads. (Grains in contact overlap a little, which
    MSTM does not take: give them apart there, by a gap_factor.)"""
    make_folder(folder)
    for number, state in enumerate(progress(run.states, "writing states"), first):
        table = np.column_stack([_middled(state), state.radius]) / UNITS[unit]
        text = "".join(" ".join(f"{value:.12e}" for value in row) + "\n" for row in table)
        write_file(folder / f"{number:06d}.pos", text)
    return folder


def write_ddscat(run, folder, unit="m", first=0):
    """Each state as NNNNNN.dat, from the number `first` on, DDSCAT's shape file for FROM_FILE: a dipole at every site
    of a cubic lattice that lies in a grain, with the number of its material from 1; returns the folder. The first line
    has the lattice's spacing d and the radius a_eff of the sphere of the same volume."""
    make_folder(folder)
    for number, state in enumerate(progress(run.states, "writing states"), first):
        spacing = state.radius.min() / DIPOLES
        sites, material = _dipoles(_middled(state) / spacing, state.radius / spacing, Exported(state, None).material())
        effective = spacing * (3 * len(sites) / (4 * np.pi)) ** (1 / 3)
        head = f"d = {spacing / UNITS[unit]:.6g} {unit}, a_eff = {effective / UNITS[unit]:.6g} {unit}\n"
        head += f"{len(sites)} = NAT\n1 0 0 = A_1 vector\n0 1 0 = A_2 vector\n"
        head += "1 1 1 = lattice spacings (d_x,d_y,d_z)/d\n"
        head += "0 0 0 = lattice offset x0(1-3)\nJA IX IY IZ ICOMP(x,y,z)\n"
        rows = np.column_stack([np.arange(1, len(sites) + 1), sites, *3 * [material + 1]])
        body = "".join("%d %d %d %d %d %d %d\n" % tuple(row) for row in rows.tolist())
        write_file(folder / f"{number:06d}.dat", head + body)
    return folder


def _middled(state):
    """Positions (N, 3) [m] about the middle of their box; in a periodic cell the images inside it."""
    position = Exported(state, None).inside()
    return position - (position.min(axis=0) + position.max(axis=0)) / 2


def _dipoles(position, radius, material):
    """(sites (D, 3) of whole numbers in spheres, the material (D,) of each); lengths in lattice spacings."""
    low = np.floor((position - radius[:, None]).min(axis=0)).astype(int)
    shape = np.ceil((position + radius[:, None]).max(axis=0)).astype(int) - low + 1
    if np.prod(shape.astype(float)) > MOST_SITES:
        raise Refused(f"{np.prod(shape.astype(float)):.3g} sites of a lattice: must be at most {MOST_SITES:.3g}")
    of_site = np.full(shape, -1, dtype=np.int16)
    for centre, reach, kind in zip(position - low, radius, material):
        first, last = np.ceil(centre - reach).astype(int), np.floor(centre + reach).astype(int) + 1
        axes = [np.arange(a, b) - c for a, b, c in zip(first, last, centre)]
        inside = sum(np.meshgrid(*(axis**2 for axis in axes), indexing="ij")) <= reach**2
        of_site[tuple(map(slice, first, last))][inside] = kind
    sites = np.argwhere(of_site >= 0)
    return sites + low, of_site[tuple(sites.T)].astype(int)
