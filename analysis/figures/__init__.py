"""Figures, drawn without a display and saved as PNG: of one run (collision, energy; listed in draw), and what all
figures have in common (style, colours of grains, spheres as pixels)."""
