"""The collision atlas: outcomes of collisions of two aggregates.

To be read in this order: columns (of the table of runs), rules (which outcome a run has), variables (coordinates,
and the region that the runs fill), model (fitted to the runs), outcome_table and make (the model on a grid, for other
programs), query (analysis.outcome), adapters (DustPy, Fortran).
"""
