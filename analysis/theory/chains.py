"""When sintered aggregates bounce: the chain model of Sirono & Ueno (2017, S17) section 5.4, eqs 14 to 19.

An aggregate is a triangular lattice of chains of N grains; a chain is bent to a triangle with a base L and a height
L/2. It bounces where the largest force in a chain is above the pull-off force of an unsintered contact. Lengths in m.

Eq 14 is printed with the denominator 2R - 1 and eq 17 with L/(2R - 1), which have no sensible unit. Here both are
L/(2R) - 1, and eq 17's length is in units of R: then F_c/F_max is 0.75 for N = 22, beta = 0.7, 10 m/s (Fig. 17 right,
the square: "almost unity"), and V_g = 3 m/s bounces from beta = 0.2 on if its grains have 2.36 contacts or more. In
units of 2R all ratios double."""

from math import pi, sqrt

import numpy as np

from .bonds import neck_length


def rolling_stiffness(beta, radius, young):
    """k_sr [N m] of a neck, S17 eq 5."""
    return pi * (beta * radius) ** 4 * young / (4.0 * neck_length(beta, radius))


def chain_of_contacts(contacts):
    """N of the chains of an aggregate with so many contacts a grain (> 2): S17 eq 16 solved for N; inf at 2."""
    contacts = np.asarray(contacts, dtype=float)
    with np.errstate(divide="ignore"):
        found = (5.0 * contacts - 6.0) / (3.0 * contacts - 6.0)
    return np.where(contacts > 2.0, found, np.inf)[()]


def chain_stiffness(grains, beta, radius, young):
    """k_chain [N/m] of N = `grains` > 3, S17 eq 17 (see the module): softer the longer the chain; 0 at infinity."""
    grains = np.asarray(grains, dtype=float)
    if np.any(grains <= 3):
        raise ValueError(f"grains = {grains}: must be above 3, the pole of S17 eq 17")
    finite = np.where(np.isfinite(grains), grains, 4.0)
    lever = (0.5 * finite - 1.0) * radius
    stiffness = 12.0 * (finite - 1.0) / ((finite - 3.0) * (finite + 1.0)) * rolling_stiffness(beta, radius, young)
    return np.where(np.isfinite(grains), stiffness / lever**2, 0.0)[()]


def largest_force(velocity, grains, beta, radius, young, mass):
    """F_max [N] at the collision velocity V_c [m/s], S17 eq 18; mass: of a grain [kg]. 0 for infinite chains."""
    stiffness, grains = chain_stiffness(grains, beta, radius, young), np.asarray(grains, dtype=float)
    finite = np.where(np.isfinite(grains), grains, 0.0)
    return (velocity * np.sqrt(stiffness * mass * finite / 2.0))[()]


def sticking_ratio(velocity, grains, beta, radius, young, mass, surface_energy):
    """F_c/F_max, S17 eq 19: below 1 aggregates bounce. F_c = 3 pi gamma R/2, unsintered, of two equal grains."""
    force = largest_force(velocity, grains, beta, radius, young, mass)
    with np.errstate(divide="ignore"):
        return (3.0 * pi * surface_energy * 0.5 * radius / np.asarray(force))[()]


def stretching_period(pair):
    """Period [s] of two equal grains that vibrate along an unsintered contact, S17's unit of time; pair:
    PairConstants. At equilibrium dF/d(delta) = (6/5) F_c/delta_0 (S17 eqs 8, 9)."""
    return 2.0 * pi * sqrt(pair.reduced_mass * pair.equilibrium_overlap / (1.2 * pair.pull_off_force))
