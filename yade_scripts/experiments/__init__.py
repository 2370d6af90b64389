"""The kinds of run, one module each (parameters, scene, series, estimate); the script of the same name runs it.

To add one: its name, series and states as a RunKind in analysis/runs/format.py; a module here with a dataclass of
parameters (run.parameters.RunParameters and materials.GrainParameters or packings.aggregate.AggregateParameters),
prepare(), estimate() and a KIND of run.kind.Kind; a script like collide.py. Tables name that script in the column
!SCRIPT. tests/scripts/shrinking_cell.py is a whole one in a file of its own.
"""
