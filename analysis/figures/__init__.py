"""Figures, drawn without a display and saved as PNG: those of one run (of_run), and what all have in common (style,
panels, save)."""
