"""Means over the impact parameter, and fits to the sizes of fragments (A22 sections 2.4 and 4)."""

import numpy as np

from ..curves import power

SQUARES = tuple(i / 12 for i in range(13))  # B_off^2 of A22
FEW = 2  # grains of the fragments whose number A22's section 3.1 tells of
SMALL = 10  # grains of a fragment that counts as small
MERGED = 0.5  # f_gro above which two aggregates have merged; two remnants have some 0, all in one piece is 1
SMALL_FITTED = 0.05  # of all grains, to which fragments count as small in a fit
LARGE_FITTED = 100  # grains: A22's alpha = 1 is for N much larger (section 3.4)


def offset_weights(squares):
    """Weights (K,) of A at rising B_off^2 = squares (K,), from 0 to 1, in <A> = int_0^1 2 B A dB = int_0^1 A d(B^2): A22
    eq 29, by the trapezoidal rule in B_off^2, which is exact for A linear in it.

    >>> offset_weights([0.0, 0.5, 1.0]).tolist()
    [0.25, 0.5, 0.25]
    """
    steps = np.diff(squares)
    return 0.5 * (np.append(steps, 0.0) + np.append(0.0, steps))


def fragment_exponent(numbers, grains):
    """alpha of N_cum(<= N) = c N^(2 - alpha)/(2 - alpha) (A22 eq 41), from grains (..., G) in fragments of at most numbers (G,)."""
    return 2.0 - power(numbers, grains)
