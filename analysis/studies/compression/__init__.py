"""Kataoka et al. (2013, K13): static compression of fluffy aggregates in shrinking periodic cells."""
