"""The study's figures: modules with FIGURES."""
