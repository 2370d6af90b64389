# SPDX-License-Identifier: MIT
"""Ordinary differential equations by extrapolated midpoint steps (Gragg, Bulirsch & Stoer), in mpmath's numbers."""

from mpmath import mpf

MOST = 16  # columns of an extrapolation


def integrate(rate, start, end, y, first, tolerance=mpf(10) ** -22):
    """y (list) at `end` of y' = rate(t, y), from `start`, by steps of `first` or shorter; each to a tolerance relative to the
    largest change of its component in the step or the component itself."""
    t, step = start, first if end > start else -first
    while t != end:
        if abs(end - t) <= abs(step) * mpf("1.0000001"):
            step = end - t
        found = extrapolated(rate, t, y, step, tolerance)
        if found is None:
            step /= 2
        else:
            t, y = (end if step == end - t else t + step), found
    return y


def extrapolated(rate, t, y, step, tolerance):
    rows, slope = [], rate(t, y)
    for k in range(MOST):
        row = [midpoint(rate, t, y, step, 2 * (k + 1), slope)]
        for j in range(k):
            factor = (mpf(k + 1) / (k - j)) ** 2 - 1
            row.append([a + (a - b) / factor for a, b in zip(row[j], rows[j])])
        if k > 2:
            scales = [max(abs(now), abs(now - then)) for now, then in zip(row[-1], y)]
            if all(abs(a - b) <= tolerance * s for a, b, s in zip(row[-1], row[-2], scales)):
                return row[-1]
        rows = row
    return None


def midpoint(rate, t, y, step, n, slope):
    h = step / n
    before, now = y, [a + h * b for a, b in zip(y, slope)]
    for k in range(1, n):
        before, now = now, [a + 2 * h * b for a, b in zip(before, rate(t + k * h, now))]
    return [(a + b + h * c) / 2 for a, b, c in zip(before, now, rate(t + step, now))]
