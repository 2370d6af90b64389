"""Elastoplastic collisions of aggregates: the figures and numbers of A24 from run folders, beside the
paper's.

Data goes one way: collect (run folders) -> measure (one row a run) -> points (seeds of one parameter set) ->
fits, bounce, offset -> study (all results) -> comparison (text, markdown, JSON) and figures. andrews and
andrews_motion hold the theory, aggregate_constants that of section 5, paper what A24 reports."""
