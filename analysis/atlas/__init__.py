"""The collision atlas: outcomes of collisions of two aggregates, for those who need them."""
