"""Elastoplastic collisions of aggregates: the figures and numbers of A24 from run folders, beside the paper's.

Data goes one way: measure (one row a run) -> points (seeds of one parameter set) -> fits, offset -> results ->
comparison and figures. collision_points and collision_sections are what studies of collisions have in common. paper.py holds what A24 reports; theory.andrews and theory.aggregates its models."""
