"""Which outcome a collision has: rules on columns of the table of runs, so that other rules need no new runs.

The target is the larger aggregate; m_t and m_p are the masses of target and projectile over the total. The gain is
the mass of the largest piece less m_t, over m_p: the growth efficiency of Arakawa et al. (2022, eq 28).

    sticking        S       gain of at least STAYS: four fifths of the projectile or more stay
    bouncing        B1      the two part again: the gain is within 1 - STAYS of 0, the second piece has STAYS of m_p or
                            more, and of either piece at least OWN was its own before
    mass transfer   B2, F3  neither, and the target is heavier than before
    erosion         F2      the target is not heavier, and keeps at least KEPT of its mass
    fragmentation   F1      it keeps less

Names of the kinds: Guettler et al. (2010, section 4). Mass transfer and erosion differ, as in Windmark et al.
(2012, section 2), by the sign of the target's change. KEPT is the usual line of catastrophic disruption. Sticking,
STAYS and OWN are those of measures.outcome; its bouncing counts what both aggregates lose, B1 what the projectile does.
"""

import numpy as np

from ..measures.outcome import OWN, STAYS, sticks

KINDS = ("sticking", "bouncing", "mass_transfer", "erosion", "fragmentation")
KEPT = 0.5
# What the larger aggregate gains or loses where that is the outcome: columns of tables of outcomes.
OF_KIND = {"gain_mass_transfer": "mass_transfer", "loss_erosion": "erosion", "largest_fragmentation": "fragmentation"}


def outcome(row):
    """Outcomes, of KINDS (n,) or (), by the rules of this module, of the columns (n,) or numbers mass_ratio, largest,
    second and own of a DataFrame or mapping."""
    target = _target(row["mass_ratio"])
    projectile = 1 - target
    gain = (row["largest"] - target) / projectile
    parts = (np.abs(gain) <= 1 - STAYS) & (row["second"] >= STAYS * projectile) & (row["own"] >= OWN)
    rules = [sticks(row["largest"], target), parts, gain > 0, row["largest"] >= KEPT * target]
    return np.select(np.broadcast_arrays(*rules), KINDS[:-1], KINDS[-1])


def change(largest, mass_ratio):
    """What the target gains over the projectile's mass; where it is lighter, what it loses over its own, below 0."""
    target = _target(mass_ratio)
    more = largest - target
    return more / np.where(more > 0, 1 - target, target)


def largest_after(changed, mass_ratio):
    """Mass of the largest piece over the total, by change()."""
    target = _target(mass_ratio)
    return target + changed * np.where(changed > 0, 1 - target, target)


def _target(mass_ratio):
    """m_t."""
    return 1 / (1 + mass_ratio)
