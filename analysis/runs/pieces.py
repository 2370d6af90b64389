"""The pieces of a state as a pandas DataFrame."""

import numpy as np
import pandas

from ..arrays import numbers, pairs
from ..measures.fragments import fragment_labels, fragment_masses, fragment_sizes
from ..measures.structure import correlation_dimension, filling_factor, gyration_radius
from .table import Column, described

STRUCTURE = (
    Column("filling_factor", "1", "volume of its grains over that of a sphere of radius (5/3)^(1/2) R_g", gaps=True),
    Column("gyration_radius", "m", "R_g, of the grains as spheres of one density", gaps=True),
    Column("fractal_dimension", "1", "slope of N(< s) (structure.correlation_dimension); NaN of small ones", gaps=True),
)
PIECES = (
    Column("grains", "", "number of its grains", "i"),
    Column("mass_fraction", "1", "of the mass of all grains"),
    Column("projectile_fraction", "1", "of its mass, what was the projectile's (aggregate 1)"),
    *STRUCTURE,
    Column("coordination", "1", "mean number of contacts of a grain"),
)


def fragments(position, radius, contact_pairs, aggregate=None, cell_size=None, mass=None):
    """Table of the pieces of a state, numbered as fragment_labels does: how large each is, and how fluffy.

    Parameters
    ----------
    position : (N, 3) array [m]
    radius : (N,) array [m]
    contact_pairs : (M, 2) array of int
    aggregate : (N,) array of int, optional
        1 for grains of the projectile.
    cell_size : (3,) array, optional
        Edges of the periodic cell [m], in which a piece has no size.
    mass : (N,) array, optional
        In any unit; as of one density if left out.

    Returns
    -------
    pandas.DataFrame
        A row a piece, with the columns PIECES; units and meanings are in .attrs.

    Examples
    --------
    >>> found = fragments([[0.0, 0, 0], [2e-7, 0, 0], [9e-7, 0, 0]], [1e-7] * 3, [[0, 1]])
    >>> found.grains.tolist(), found.coordination.tolist(), found.filling_factor.round(3).tolist()
    ([2, 1], [1.0, 0.0], [0.459, 1.0])
    """
    radius = numbers("radius", radius, (None,), positive=True)
    position = numbers("position", position, (len(radius), 3))
    if not len(radius):
        raise ValueError("position: must have one grain or more")
    contact_pairs = pairs("contact_pairs", contact_pairs, len(radius))
    labels, volume = fragment_labels(len(radius), contact_pairs), (radius / radius.max()) ** 3
    mass = volume if mass is None else numbers("mass", mass, radius.shape, positive=True)
    sizes, masses = fragment_sizes(labels), fragment_masses(labels, mass)
    of_projectile = np.zeros(len(radius), dtype=bool)
    if aggregate is not None:
        of_projectile = numbers("aggregate", aggregate, radius.shape, least=0, whole=True) == 1
    contacts = np.bincount(labels[contact_pairs[:, 0]], minlength=len(sizes))
    order, ends = np.argsort(labels, kind="stable"), np.cumsum(sizes)
    of_pieces = np.split(order, ends[:-1])
    columns = {
        "grains": sizes,
        "mass_fraction": masses / mass.sum(),
        "projectile_fraction": fragment_masses(labels, mass * of_projectile) / masses,
        **structure_of(position, radius, of_pieces, cell_size),
        "coordination": 2.0 * contacts / sizes,
    }
    return described(pandas.DataFrame(columns), PIECES)


def structure_of(position, radius, pieces, cell_size=None):
    """{column of STRUCTURE: (K,)} of K pieces, each the rows of its grains; NaN in a periodic cell."""
    if cell_size is not None:
        values = np.full((len(pieces), len(STRUCTURE)), np.nan)
    else:
        values = np.array([_structure(position[own], radius[own]) for own in pieces])
    return {column.name: values[:, k] for k, column in enumerate(STRUCTURE)}


def _structure(position, radius):
    if len(radius) == 1:  # what the functions give, in less time: there may be very many
        return 1.0, np.sqrt(0.6 * radius[0] ** 2), np.nan
    return [measure(position, radius) for measure in (filling_factor, gyration_radius, correlation_dimension)]
