"""Studies: what is made of many runs, beside a paper's numbers. Each has a folder here, and nothing else names it:

    NAME/study.py     STUDY, a definition.Study: which runs, what is measured of a run, results, sections of the report
    NAME/figures.py   FIGURES, a tuple of definition.StudyFigure; may be left out
    NAME/paper.toml   the paper's numbers and the page's words (paper.py); may be left out
    NAME/predictions.csv   what was foretold (predictions.py); may be left out

`python3 -m analysis study NAME RUNS` does the rest: analyse.py."""
