"""The normal stress in the contact of Andrews's model, of which its forces are integrals (A24 B13-B22)."""

import numpy as np

from analysis.theory.andrews import return_compression


def elastic_stress(delta, distance, spheres):
    """Hertz's stress [Pa] at a distance [m] from the centre of the contact: B14; 0 outside a = (R*
    delta)^(1/2)."""
    inside = np.maximum(1.0 - distance**2 / (spheres.reduced_radius * delta), 0.0)
    return 2.0 * spheres.young * np.sqrt(delta) / (np.pi * np.sqrt(spheres.reduced_radius)) * np.sqrt(inside)


def compression_stress(delta, distance, spheres):
    """Stress [Pa] while the compression grows: B16."""
    return np.minimum(elastic_stress(delta, distance, spheres), spheres.yield_stress)


def return_stress(delta, distance, largest, spheres):
    """Stress [Pa] while the spheres part after the largest compression [m]: B21, B22."""
    yielded = plastic_radius(largest, spheres)
    inner = elastic_stress(delta, yielded, spheres)
    elastic = elastic_stress(delta, distance, spheres)
    return np.where(distance < yielded, np.minimum(elastic, inner), elastic)


def plastic_radius(delta, spheres):
    """Radius [m] of the yielded part of the contact: B18, B20; 0 below delta_crit."""
    return np.sqrt(spheres.reduced_radius * return_compression(spheres, delta))


def contact_force(stress, delta, spheres, nodes=4000):
    """F [N] = integral of 2 pi a' stress(a') over the contact: B13, by the midpoint rule in a'^2."""
    square = (np.arange(nodes) + 0.5) / nodes * spheres.reduced_radius * delta
    return np.pi * spheres.reduced_radius * delta * np.mean(stress(np.sqrt(square)))
