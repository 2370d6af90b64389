"""The collision atlas: outcomes over structure, size, mass ratio, velocity and impact parameter, and where aggregates bounce."""
