"""What is measured of a collision: pure functions of plain arrays, usable without a run folder.

Every docstring says shapes, units and the defining equation. of_run.py takes the arrays from a run folder."""
