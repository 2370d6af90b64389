"""Least squares for the yield stress and E* of Andrews's model, of many sets of data at once."""

import numpy as np

from ...theory.andrews import (
    Spheres,
    elastic_compression,
    elastic_time,
    largest_compression,
    plastic_compression,
    plastic_time,
    time_of_largest_compression,
)
from .levenberg import least_squares

# sigma and E* where the search begins, in rho v^2 (A24's are at 1,100 and 7,900).
_GRID = (np.geomspace(10.0, 3e4, 45), np.geomspace(50.0, 1e7, 55))
_CHUNK = 50  # sets of data compared with the grid at a time, for the memory
# A limit of the model is taken where its chi square is no higher than that of the best finite moduli by more:
# towards it chi square is flat, so that the search stops anywhere.
NO_WORSE = 2e-3


class ModuliSearch:
    """The best (sigma, E*) at fixed velocities [m/s] (K,) and density [kg/m^3] of the aggregates: the best
    place of a wide grid first, then levenberg.least_squares in ln sigma, ln E*."""

    def __init__(self, velocity, density):
        self.velocity, self.density = velocity, density
        pressure = density * np.exp(np.mean(np.log(velocity))) ** 2
        moduli = [axis.ravel() for axis in np.meshgrid(*(pressure * places for places in _GRID))]
        self._grid = np.log(moduli).T
        # Everything in the model is proportional to R*.
        self._on_grid = np.concatenate(self._model(self._grid, 1.0), axis=1)

    def best(self, delta, tau, delta_error, tau_error, radius):
        """(sigma, E*) (B, 2) [Pa] and chi square (B,) for B sets of delta_max [m], tau_max [s] and reduced
        radii [m] (B, K), with errors (K,). sigma is inf where spheres that never yield fit as well, E* inf
        where rigid ones do."""
        radius = np.concatenate([radius, radius], axis=1)
        error = np.concatenate(
            [np.broadcast_to(delta_error, self.velocity.shape), np.broadcast_to(tau_error, self.velocity.shape)]
        )
        data, scale = np.concatenate([delta, tau], axis=1) / error, radius / error
        x = self._on_the_grid(data, scale)
        x, chi_square = self._refined(x, data, scale)
        moduli = np.exp(x)
        for i, (power, shape) in enumerate(self._limits()):
            # In the limit the model is a power of the one modulus that is left, so that the fit is linear.
            model = shape * scale
            factor = np.sum(model * data, axis=1) / np.sum(model**2, axis=1)
            limit = np.sum((factor[:, None] * model - data) ** 2, axis=1)
            take = (limit <= chi_square + NO_WORSE) & (factor > 0)
            moduli[take, i] = np.inf
            moduli[take, 1 - i] = factor[take] ** power
            chi_square = np.where(take, limit, chi_square)
        return moduli, chi_square

    def _limits(self):
        """(power, delta_max and tau_max (2 K,) of a unit modulus and R* = 1) without yield, and without
        elasticity: modulus = factor^power."""
        unit, v = Spheres(1.0, self.density, 1.0, 1.0), self.velocity
        yield -2.5, np.concatenate([elastic_compression(v, unit), elastic_time(v, unit)])
        yield -2.0, np.concatenate([plastic_compression(v, unit), np.broadcast_to(plastic_time(v, unit), v.shape)])

    def _model(self, x, radius):
        """delta_max and tau_max, each (B, K), for ln moduli x (B, 2)."""
        spheres = Spheres(radius, self.density, *np.exp(x).T[:, :, None])
        return largest_compression(self.velocity, spheres), time_of_largest_compression(self.velocity, spheres)

    def _on_the_grid(self, data, scale):
        starts = []
        for k in range(0, len(data), _CHUNK):
            difference = self._on_grid * scale[k : k + _CHUNK, None] - data[k : k + _CHUNK, None]
            starts.append(np.argmin(np.einsum("bgk,bgk->bg", difference, difference), axis=1))
        return self._grid[np.concatenate(starts)]

    def _refined(self, x, data, scale):
        """x (B, 2) and chi square (B,) at the minimum next to each of the places x."""
        low, high = self._grid.min(axis=0) - 1.0, self._grid.max(axis=0) + 1.0

        def residuals(place):
            return np.concatenate(self._model(place, 1.0), axis=1) * scale - data

        return least_squares(residuals, x, low, high)
