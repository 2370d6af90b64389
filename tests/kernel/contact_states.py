"""Contacts and bonds at random, and the gradient of their energy."""

import numpy as np


def unit(v):
    return np.asarray(v) / np.linalg.norm(v)


def states(random, count):
    """(axis, pointers of both grains a little off it, twist), turned at random."""
    for _ in range(count):
        axis = unit(random.normal(size=3))
        n1, n2 = unit(-axis + 0.02 * random.normal(size=3)), unit(axis + 0.02 * random.normal(size=3))
        yield axis, n1, n2, 0.02 * random.normal()


def force_and_torques(kernel, energy, x, n1, n2, twist, move, turn):
    """(force, torque on each grain) by central differences of energy(x, n1, n2, twist) over a displacement and an angle
    of such sizes."""

    def after(move=0.0, turn1=np.zeros(3), turn2=np.zeros(3)):
        grown = twist + np.dot(turn1 - turn2, unit(x + move))  # dphi = (w1 - w2).n dt
        return energy(x + move, kernel.turn(n1, turn1), kernel.turn(n2, turn2), grown)

    def minus_slope(name, size):
        changes = size * np.eye(3)
        return [-(after(**{name: change}) - after(**{name: -change})) / (2 * size) for change in changes]

    return minus_slope("move", move), minus_slope("turn1", turn), minus_slope("turn2", turn)
