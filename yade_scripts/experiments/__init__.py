"""The kinds of run, one file each: parameters, scene, series, estimate. The script of the same name runs it."""
