"""The study's figures, one file each, drawn without a display; A24's numbers stand in them as dashed lines
and open stars."""

from .draw import FIGURES, draw

__all__ = ["FIGURES", "draw"]
