#!/usr/bin/python3
"""Makes contact_radius_coefficients.hpp: the root of 3u^4 - 2u = delta/delta0 as a polynomial.

u = (a/a0)^(1/2) has a square-root branch point at pull-off and is smooth in
y = (delta/delta0 + (9/16)^(1/3))^(1/2); it is interpolated there at Chebyshev nodes in 50-digit arithmetic and
written in powers of t = 2y/y_max - 1. Run it (no arguments) to write the header anew; the tests compare the
result with roots found another way.
"""

import math
from decimal import Decimal, getcontext
from pathlib import Path

getcontext().prec = 60
DEGREE = 22
LARGEST_OVERLAP = 4  # in units of delta0; beyond it the kernel iterates

SIXTH_ROOT = Decimal(6) ** (Decimal(-1) / 3)
PULL_OFF = (Decimal(9) / 16) ** (Decimal(1) / 3)
PI = Decimal("3.14159265358979323846264338327950288419716939937510582097494459")


def cosine(x):
    """cos x by its series, to the working precision."""
    term, total, n = Decimal(1), Decimal(1), 0
    while abs(term) > Decimal(10) ** -58:
        n += 2
        term *= -x * x / (n * (n - 1))
        total += term
    return total


def root(y):
    """The root u >= 6^(-1/3) for one y, by Newton's method."""
    overlap = y * y - PULL_OFF
    u = SIXTH_ROOT + y / (Decimal(18).sqrt() * SIXTH_ROOT)
    for _ in range(200):
        step = (3 * u**4 - 2 * u - overlap) / (12 * u**3 - 2)
        u -= step
        if abs(step) < Decimal(10) ** -50:
            return u
    raise ArithmeticError(f"no root found at y = {y}")


def powers_of_t():
    """(coefficients of 1, t, t^2, ..., largest y): Chebyshev interpolation, then powers."""
    n = DEGREE + 1
    y_max = (Decimal(LARGEST_OVERLAP) + PULL_OFF).sqrt()
    angles = [PI * (2 * k + 1) / (2 * n) for k in range(n)]
    values = [root((cosine(angle) + 1) / 2 * y_max) for angle in angles]
    chebyshev = [sum(v * cosine(j * angle) for v, angle in zip(values, angles)) * (2 if j else 1) / n for j in range(n)]
    total = [Decimal(0)] * n
    previous, current = [Decimal(1)], [Decimal(0), Decimal(1)]
    for j, weight in enumerate(chebyshev):
        basis = previous if j == 0 else current
        for power, c in enumerate(basis):
            total[power] += weight * c
        if j >= 1:
            following = [Decimal(0)] + [2 * c for c in current]
            for power, c in enumerate(previous):
                following[power] -= c
            previous, current = current, following
    return total, y_max


def main():
    coefficients, y_max = powers_of_t()
    lines = [
        "// Written by fit_contact_radius.py: do not edit.",
        "#pragma once",
        "",
        "namespace contact_law {",
        "",
        f"constexpr double largestFittedOverlap = {LARGEST_OVERLAP}; // in units of the equilibrium overlap",
        f"constexpr double fittedScale = {float(2 / y_max)!r}; // t = fittedScale * y - 1",
        f"constexpr double contactRadiusCoefficients[{DEGREE + 1}] = {{ // of 1, t, t^2, ...",
    ]
    lines += [f"\t{float(c)!r}," for c in coefficients]
    lines += ["};", "", "} // namespace contact_law", ""]
    assert all(math.isfinite(float(c)) for c in coefficients)
    Path(__file__).with_name("contact_radius_coefficients.hpp").write_text("\n".join(lines))


if __name__ == "__main__":
    main()
