"""A24's collisions with the viscous drag of A22 left on: differences of d_max and t_max from the same pairs without it."""
