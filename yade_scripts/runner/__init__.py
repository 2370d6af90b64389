"""Runs tables of any kind of run: rows at work, estimates, what is shown."""
