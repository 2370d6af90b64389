"""Sintered aggregates: the collisions of Sirono & Ueno (2017, S17)."""
