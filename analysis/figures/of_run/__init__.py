"""Figures of one run, one a module: FIGURE(run) makes it, the module's name is the file's, KINDS are the kinds of run
(runs.format) that have it, all where it is left out."""
