"""A layer between two plates, of which the upper one comes down (compress.py boundary=walls): scene and series.

The sides are periodic and stay as they are, so that the layer is one of a wide cake; the cell is so high that nothing meets its images
across the plates. The filling factor is that between the plates, the pressure the mean of the forces on both over their area."""

import numpy as np

from analysis.measures.periodic_cell import filling_factor
from yade_scripts.packings.ballistic import rbd, square_for

DEPOSITED = 0.15  # filling of a deep layer, which sets the square on which it is grown
GAP = 0.1  # grain radii between the highest grain and the upper plate at the start
AXIS = 2


def layer(parameters, constants, on_plate):
    """(Packing, edge of the square [m], height of the upper plate [m]); on_plate: constants of a grain and a plate."""
    radius = parameters.grainRadius
    edge = square_for(parameters.grains, DEPOSITED) * radius
    packing = rbd(
        parameters.grains,
        radius,
        constants["equilibriumOverlap"],
        on_plate["equilibriumOverlap"],
        edge,
        parameters.seed,
    )
    return packing, edge, packing.position[:, AXIS].max() + (1 + GAP) * radius


def build(packing, edge, height, velocity, material):
    """The bodies: grains, the plate at rest, the piston that comes down at `velocity` [m/s]."""
    from yade.wrapper import Omega

    from yade_scripts.run import scene as yade_scene

    omega = Omega()
    omega.periodic = True
    omega.cell.setBox(edge, edge, 2 * height + 10 * packing.radius.max())
    omega.cell.homoDeform = 0
    yade_scene.add_bodies([packing], [(0, 0, 0)], material)
    yade_scene.add_plane(AXIS, 0.0, material)
    yade_scene.add_plane(AXIS, height, material, -velocity)


def move(rate):
    """Have the upper plate come down at `rate` [1/s] times its height from now on."""
    piston = _piston()
    piston.vel = [0.0, 0.0, -rate * piston.pos[AXIS]]


def _piston():
    from yade.wrapper import Omega

    return Omega().bodies[-1].state


def _edges(state):
    """Edges (3,) [m] of the space between the plates."""
    return np.array([*state["cell_size"][:AXIS], np.ptp(state["plane_position"])])


def _pressures(state):
    """Pressure [Pa] on each of the two plates."""
    area = np.prod(state["cell_size"][:AXIS])
    plane, force = state["plane_contacts"][:, 1], state["plane_contact_normal_force"]
    return np.bincount(plane, weights=force, minlength=2) / area


def series(state):
    """{name: value} of a compression's own series; edges, filling and pressure are of the space between the plates."""
    edges, of_plates = _edges(state), _pressures(state)
    contacts = 2 * len(state["contact_pairs"]) + len(state["plane_contacts"])
    return {
        "filling": filling_factor(state["radius"], edges),
        "pressure": of_plates.mean(),
        "kinetic_pressure": 0.0,
        "piston_pressure": of_plates[1],
        "coordination": contacts / len(state["radius"]),
        **{f"edge_{axis}": edge for axis, edge in zip("xyz", edges)},
    }
