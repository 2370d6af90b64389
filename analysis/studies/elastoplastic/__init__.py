"""Head-on collisions of close-packed aggregates, beside Arakawa et al. (2024, A24)."""
