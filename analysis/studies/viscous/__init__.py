"""Oblique collisions of BPCA aggregates with viscous drag, beside Arakawa, Tanaka & Kokubo (2022, A22)."""
