"""How many necks break, and which aggregates bounce: S17's laws (Fig. 15, section 5.4), and the fit of the first to runs."""

import numpy as np

from ...theory import ICE
from ...theory.chains import chain_of_contacts, sticking_ratio

AMPLITUDE, EXPONENT = 3.7e-2, 0.97  # S17's fit (section 5.3)
LOOP_GRAINS = 22  # N of eq 18 in a BCCA aggregate that has formed loops (section 5.4)
STIFFEST = 3.0  # chains of so many grains or fewer have no stiffness in the model (eq 17 diverges)
ROUNDS = 60  # of Newton's method


def papers_necks(ratio):
    """N_cut/N_t at E_k/E_sint = ratio, by S17's fit."""
    return AMPLITUDE * ratio**EXPONENT


def fit_necks(rows, weights):
    """Amplitude and exponent (B, 2) of N_cut/N_t = amplitude (E_k/E_sint)^exponent: maximum likelihood of Poisson counts, which
    knows runs without a broken neck, of rows with broken, grains, energy_ratio, weights (B, n). NaN with one energy, or no neck.

    With the best amplitude for each exponent, the likelihood is largest where the mean of x = ln E_k/E_sint over the broken necks is that
    over all grains weighted with exp(exponent x)."""
    x, broken, grains = (rows[name].to_numpy(dtype=float) for name in ("energy_ratio", "broken", "grains"))
    x = np.log(x)
    if len(np.unique(x[broken > 0].round(3))) < 2:
        return np.full((len(weights), 2), np.nan)
    target, exponent = (weights @ (broken * x)) / (weights @ broken), np.ones(len(weights))
    for _ in range(ROUNDS):
        share = weights * grains * np.exp(exponent[:, None] * (x - x.max()))
        share /= share.sum(axis=1, keepdims=True)
        mean = share @ x
        exponent += np.clip((target - mean) / (share @ x**2 - mean**2), -0.5, 0.5)
    amplitude = (weights @ broken) / (weights * grains * np.exp(exponent[:, None] * x)).sum(axis=1)
    return np.stack([amplitude, exponent], axis=1)


def chain_ratio(contacts, neck, velocity, radius):
    """F_c/F_max (n,) of S17 eq 19, below 1 for bouncing, of compacted aggregates with so many contacts a grain (n,) (eq 16), NaN: of BCCA
    ones, with loops of LOOP_GRAINS. neck, velocity [m/s], radius of a grain [m] (n,). 0 for chains of STIFFEST grains or fewer."""
    contacts, neck, velocity, radius = (np.asarray(own, dtype=float) for own in (contacts, neck, velocity, radius))
    number = np.where(np.isnan(contacts), LOOP_GRAINS, chain_of_contacts(contacts))
    mass = 4.0 / 3.0 * np.pi * ICE.density * radius**3
    soft = np.where(number > STIFFEST, number, STIFFEST + 1.0)
    ratio = sticking_ratio(velocity, soft, neck, radius, ICE.young, mass, ICE.surface_energy)
    return np.where(number > STIFFEST, ratio, 0.0)
