"""Studies: many runs beside a paper's numbers. A paper is one module that reads from top to bottom.

    NAME.py        STUDY: which runs, what is measured of each, statistics, a paper's numbers beside ours, figures
    study.py       what STUDY is made of, and a study of one's own (collision_study)
    columns.py     columns of runs.csv, and how a run folder fills them
    gather.py      from paths to one table of runs
    estimates.py   a number of a table of runs with its standard error
    comparison.py  a paper's number beside it, in one of four words; tables in pages, the page of a user's runs
    figures.py     curves of estimates, states of collisions

`python3 -m analysis study NAME RUNS` runs one; analysis/STUDIES.md says how to write one."""
