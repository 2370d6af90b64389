"""A24's collisions with one thing changed that its text leaves open: differences of d_max and t_max from the same pairs."""
