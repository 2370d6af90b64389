"""Collisions of dust aggregates with YADE: scripts to run, and what they are made of."""
