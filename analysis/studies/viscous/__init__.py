"""Oblique collisions of BPCA aggregates with viscous drag: the figures and numbers of A22 from run folders, beside the
paper's.

Data goes one way: measure (one row a run) -> impact_mean (seeds of one parameter set, means over B_off) -> results
(thresholds, size distributions) -> lines and figures. paper.py holds what A22 reports; theory.sticking two grains."""
