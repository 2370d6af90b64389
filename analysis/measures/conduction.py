"""Heat through the contacts of grains in a periodic cell (Arakawa et al. 2017, 2019).

A contact of radius a_c conducts H = 2 k_mat a_c between two grains of conductivity k_mat, each of one temperature: the
constriction is all of the resistance. For a mean gradient of temperature across the cell, one linear solve gives the
temperatures with which no heat stays in a grain, and what flows then. Radiation and gas are left out."""

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.sparse.linalg import spsolve

from ..arrays import numbers
from ..arrays import pairs as checked
from .periodic_cell import nearest_image


def conductivity(position, contact_pairs, contact_radius, cell_size):
    """Conductivity of a packing over that of its material, along each axis.

    Parameters
    ----------
    position : (N, 3) array [m]
        Anywhere; two grains meet as their nearest images.
    contact_pairs : (M, 2) array of int
        Rows of the grains of each contact.
    contact_radius : (M,) array [m]
        a_c of each contact (theory.contact_radius; of a bond its neck).
    cell_size : (3,) array [m]
        Edges of the cell.

    Returns
    -------
    (3,) array
        k/k_mat along x, y and z; 0 where no contacts lead through the cell.

    Examples
    --------
    A chain of grains 2 r apart along x: k = H d/A.

    >>> chain = np.array([[0.5, 0.0, 0.0], [2.5, 0.0, 0.0], [4.5, 0.0, 0.0]])
    >>> conductivity(chain, [[0, 1], [1, 2], [0, 2]], [0.1, 0.1, 0.1], [6.0, 4.0, 4.0]).round(6).tolist()
    [0.025, 0.0, 0.0]
    """
    position = numbers("position", position, (None, 3))
    cell_size = numbers("cell_size", cell_size, (3,), positive=True)
    first, second = checked("contact_pairs", contact_pairs, len(position)).T
    conductance = 2.0 * numbers("contact_radius", contact_radius, first.shape, least=0.0)
    between = nearest_image(position[second] - position[first], cell_size)
    # Sum_j H_ij (T_j - T_i + g . d_ij) = 0 of every grain, for gradients g along x, y and z
    rows, columns = np.concatenate([first, second, first, second]), np.concatenate([second, first, first, second])
    entries = np.concatenate([conductance, conductance, -conductance, -conductance])
    laplacian = coo_matrix((entries, (rows, columns)), (len(position),) * 2).tocsr()
    pieces = connected_components(laplacian)[1]
    pushed = np.zeros((len(position), 3))
    np.add.at(pushed, first, -conductance[:, None] * between)
    np.add.at(pushed, second, conductance[:, None] * between)
    held = np.zeros(len(position), dtype=bool)
    held[np.unique(pieces, return_index=True)[1]] = True  # one grain of each piece, whose temperature is free
    temperature = np.zeros((len(position), 3))
    if not held.all():
        temperature[~held] = spsolve(laplacian[~held][:, ~held].tocsc(), pushed[~held]).reshape(-1, 3)
    flow = conductance[:, None] * (temperature[second] - temperature[first] + between)
    return np.einsum("ij,ij->j", flow, between) / np.prod(cell_size)
