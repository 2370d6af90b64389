"""Size distributions of fragments, means over B_off (A22 eqs 31-33), and their fits (eqs 35-42)."""

from dataclasses import dataclass

import numpy as np

from ...measures.fragments import cumulative_cross_section, cumulative_grains, cumulative_number
from ...statistics import resampling_error
from . import paper
from .impact_mean import impact_mean, whole_impacts
from .measure import sizes_from_text

LARGEST_FITTED = 0.05  # of all grains, to which fragments are small
SHORTEST = 10.0  # largest over smallest N of a fit: less tells no power
SAMPLES = 60


@dataclass(frozen=True)
class PowerLaw:
    """f(N) = amplitude N^-exponent (A22 eq 39), with standard errors (None: no scatter known); values None where there is
    too little to fit."""

    exponent: float = None
    amplitude: float = None
    exponent_error: float = None
    amplitude_error: float = None


@dataclass(frozen=True)
class SizeDistribution:
    """<Z_cum(>= N)>, <N_cum(<= N)>, <S_cum(<= N)>/S_1 (G,) at N = numbers (G,); power_law fitted to N_cum up to LARGEST_FITTED of
    all grains, and large_law to it from paper.LARGE to the grains of an aggregate; large_share (value, error; None: not
    known): what fragments beyond LARGEST_FITTED have of the cross-section; pairs of aggregates."""

    numbers: np.ndarray
    number: np.ndarray
    grains: np.ndarray
    cross_section: np.ndarray
    power_law: PowerLaw
    large_law: PowerLaw
    large_share: tuple
    pairs: int


def whole_numbers(most, samples=SAMPLES):
    """About `samples` whole numbers from 1 to `most`, evenly in their logarithms."""
    return np.unique(np.geomspace(1, most, samples).round().astype(int))


def size_distribution(runs, draws):
    """SizeDistribution of a table of runs of one size, velocity and T_vis; None where their B_off don't go from 0 to 1."""
    runs, offsets = whole_impacts(runs)
    if not offsets:
        return None
    size, pairs = int(runs.grains.iloc[0]), runs.seed.nunique()
    numbers = whole_numbers(2 * size)
    sizes = [sizes_from_text(text) for text in runs.fragments]
    measures = (cumulative_number, cumulative_grains, cumulative_cross_section)
    means = [impact_mean(runs, [measure(s, numbers) for s in sizes], draws) for measure in measures]
    (_, (grains, resamples), (section, section_resamples)) = means
    small = numbers <= LARGEST_FITTED * 2 * size
    laws = [
        power_law_with_errors(numbers[fitted], grains[fitted], resamples[:, fitted] if pairs > 1 else None)
        for fitted in (small, (numbers >= paper.LARGE) & (numbers <= size))
    ]
    shares = 1 - section_resamples[:, small][:, -1] / section_resamples[:, -1]
    share = 1 - section[small][-1] / section[-1], resampling_error(shares) if pairs > 1 else None
    return SizeDistribution(numbers, *(mean for mean, _ in means), *laws, share, pairs)


def fit_power_law(numbers, grains):
    """(exponent alpha, amplitude c) of N_cum(<= N) = c N^(2-alpha)/(2-alpha) (A22 eq 41, alpha < 2), by least squares of the
    logarithms; numbers, grains (G,). (None, None) where fewer than three of the latter are positive, where these are of
    N within a factor of SHORTEST, or alpha >= 2 (an N_cum that hardly rises)."""
    there = grains > 0
    if np.count_nonzero(there) < 3 or numbers[there][-1] < SHORTEST * numbers[there][0]:
        return None, None
    slope, height = np.polyfit(np.log(numbers[there]), np.log(grains[there]), 1)
    return (float(2.0 - slope), float(np.exp(height) * slope)) if slope > 1e-6 else (None, None)


def power_law_with_errors(numbers, grains, resamples=None):
    """PowerLaw of N_cum (G,) at numbers (G,), with errors from resamples (B, G) where there are any."""
    exponent, amplitude = fit_power_law(numbers, grains)
    if exponent is None or resamples is None:
        return PowerLaw(exponent, amplitude)
    fits = np.array([fit_power_law(numbers, row) for row in resamples], dtype=float)
    return PowerLaw(exponent, amplitude, *(resampling_error(column) for column in fits.T))


def fitted_curves(numbers, total):
    """(Z_cum, N_cum, S_cum/S_1) (G,) that f(N) = 1/N gives at numbers (G,), of `total` grains: A22 eqs 37, 35, 38."""
    numbers = np.asarray(numbers, dtype=float)
    return np.log(total / numbers), numbers, 1.5 * np.cbrt(numbers) ** 2
