"""Studies: many runs beside a paper's numbers. A paper is one module that reads from top to bottom and defines STUDY
(study.py); analysis/STUDIES.md says how to write one, and `python3 -m analysis study NAME RUNS` runs it.
"""
