"""What is measured of a run: pure functions of plain arrays, usable without a run folder.

Docstrings say shapes, units and the defining equation. runs/measured.py takes the arrays from a run folder.
"""
