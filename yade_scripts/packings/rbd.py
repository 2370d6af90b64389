"""Layers by random ballistic deposition (RBD), as laboratories grow dust cakes (Blum & Schraepler 2004: a filling of 0.15).

The recipe: grains come one by one straight down at random places of a square that is periodic in x and y, and stay where they first touch
another grain or the plate at z = 0, at the equilibrium overlap. The hits are exact."""

from math import ceil, sqrt

import numpy as np

from yade_scripts.packings.packing import Packing, random_stream


def rbd(grains, grain_radius, overlap, overlap_with_plate, edge, seed):
    """A layer of `grains` grains on the plate z = 0 of a square of that edge [m] around the z axis; overlaps [m] are those at rest.

    The packing is a function of the arguments. Grains across an edge are there once; they touch the others' images.
    """
    places = edge * (random_stream(seed, 0).random((grains, 2)) - 0.5)
    touching = 2 * grain_radius - overlap
    cells = max(3, int(edge / touching))
    held = {}  # (x, y, z) of grains, by cells at least as wide as two grains reach
    height = np.empty(grains)
    for number, (x, y) in enumerate(places.tolist()):
        i, j = int((x / edge + 0.5) * cells) % cells, int((y / edge + 0.5) * cells) % cells
        z = grain_radius - overlap_with_plate
        for di in (-1, 0, 1):
            for dj in (-1, 0, 1):
                for other_x, other_y, other_z in held.get(((i + di) % cells, (j + dj) % cells), ()):
                    across_x, across_y = x - other_x, y - other_y
                    across_x -= edge * round(across_x / edge)
                    across_y -= edge * round(across_y / edge)
                    below = touching**2 - across_x**2 - across_y**2
                    if below > 0:
                        z = max(z, other_z + sqrt(below))
        held.setdefault((i, j), []).append((x, y, z))
        height[number] = z
    about = dict(packing="rbd", grains=grains, grainRadius=grain_radius, overlap=overlap, edge=edge)
    return Packing(np.column_stack([places, height]), np.full(grains, float(grain_radius)), seed, about)


def square_for(grains, filling):
    """Edge [grain radii] of the square on which so many grains make a layer of that filling as high as wide."""
    return ceil(100 * (grains * 4 / 3 * np.pi / filling) ** (1 / 3)) / 100
