"""Static compression of fluffy aggregates: the figures and numbers of K13 from run folders, beside the paper's.

Data goes one way: measure (one row a run) -> groups (seeds of one parameter set) -> strength_fit -> results -> comparison
and figures. paper.py holds what K13 reports; theory.compression its formulae, and those of T19 and T23."""
