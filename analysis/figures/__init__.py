"""Figures of a run folder, drawn without a display and saved as PNG."""

from .draw import FIGURES, draw_all

__all__ = ["FIGURES", "draw_all"]
