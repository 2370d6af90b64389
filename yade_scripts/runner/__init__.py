"""Runs tables of any kind of run: rows, yade-batch, estimates, what is shown."""
