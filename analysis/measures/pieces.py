"""The pieces of a state: how large each is, and how fluffy."""

from inspect import cleandoc

import numpy as np
import pandas

from ..arguments import PAIRS, POSITIVE, WHOLE, numbers, takes
from ..runs.table import Column, columns_text, described
from .fragments import fragment_labels, fragment_masses, fragment_sizes
from .structure import POINTS, RADII, correlation_dimension, filling_factor, gyration_radius

STRUCTURE = (
    Column("filling_factor", "1", "volume of its grains over that of a sphere of radius (5/3)^(1/2) R_g", gaps=True),
    Column("gyration_radius", "m", "R_g, of the grains as spheres of one density", gaps=True),
    Column(
        "fractal_dimension", "1", "slope of N(< s) (structure.correlation_dimension); none of small ones", gaps=True
    ),
)
PIECES = (
    Column("grains", "", "number of its grains", "i"),
    Column("mass_fraction", "1", "of the mass of all grains"),
    Column("projectile_fraction", "1", "of its mass, what was the projectile's (aggregate 1)"),
    *STRUCTURE,
    Column("coordination", "1", "mean number of contacts of a grain"),
)


@takes(
    position=POINTS, radius=RADII, contact_pairs=PAIRS, aggregate=numbers("N", WHOLE), cell_size=numbers("3", POSITIVE)
)
def fragments(position, radius, contact_pairs, aggregate=None, cell_size=None):
    """DataFrame with a row a piece, the most grains first, numbered as fragments.fragment_labels does.

    position (N,3) [m], radius (N,) [m], contact_pairs (M,2): rows of the grains in contact, aggregate (N,): 1 for grains of the
    projectile, cell_size (3,): of a periodic cell, in which a piece has no size. Columns: PIECES, SI units, which are in
    .attrs["units"] too.

    >>> found = fragments([[0.0, 0, 0], [2e-7, 0, 0], [9e-7, 0, 0]], [1e-7] * 3, [[0, 1]])
    >>> found.grains.tolist(), found.coordination.tolist(), found.filling_factor.round(3).tolist()
    ([2, 1], [1.0, 0.0], [0.459, 1.0])
    """
    position, radius = np.asarray(position, dtype=float), np.asarray(radius, dtype=float)
    labels, mass = fragment_labels(len(radius), contact_pairs), (radius / radius.max()) ** 3
    sizes, masses = fragment_sizes(labels), fragment_masses(labels, mass)
    of_projectile = np.zeros(len(radius)) if aggregate is None else (np.asarray(aggregate) == 1).astype(float)
    contacts = np.bincount(labels[np.asarray(contact_pairs, dtype=np.intp).reshape(-1, 2)[:, 0]], minlength=len(sizes))
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


fragments.__doc__ = f"{cleandoc(fragments.__doc__)}\n\n{columns_text(PIECES)}"


def structure_of(position, radius, pieces, cell_size=None):
    """{column of STRUCTURE: (K,)} of K pieces, each the rows of its grains; NaN in a periodic cell."""
    of = _no_structure if cell_size is not None else _structure
    values = [of(position[own], radius[own]) for own in pieces]
    return {column.name: np.array(each) for column, each in zip(STRUCTURE, np.transpose(values))}


def _structure(position, radius):
    if len(radius) == 1:  # as the functions have it: there may be very many
        return 1.0, np.sqrt(0.6 * radius[0] ** 2), np.nan
    return [measure(position, radius) for measure in (filling_factor, gyration_radius, correlation_dimension)]


def _no_structure(*_):
    return [np.nan] * 3
