"""Kataoka et al. (2013): static compression of fluffy aggregates in shrinking periodic cells."""
