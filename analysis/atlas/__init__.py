"""The collision atlas: outcomes of collisions of two aggregates.

To be read in this order: columns (of the table of runs), rules (which outcome a run has), variables (coordinates,
and the region that the runs fill), model (fitted to the runs), outcome_table and make (the model on a grid, for other
programs), query (analysis.outcome), adapters (DustPy, Fortran). How well the tables predict runs that they were not
fitted to is in the study (studies/atlas.py).
"""
