"""The kinds of run, one file each: parameters, scene, series, estimate. The script of the same name runs it.

To add one: its name, series and states as a RunKind in analysis/runs/format.py; a file here with a dataclass of
parameters (run.parameters.RunParameters and materials.GrainParameters or packings.aggregate.AggregateParameters),
prepare(), estimate() and a KIND of run.kind.Kind; a script like collide.py. Tables name that script in the column
!SCRIPT. tests/scripts/test_second_kind_of_run.py has a whole one.
"""
