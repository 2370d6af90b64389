"""Outcomes as rules on columns of the table of runs (DataFrame, or a mapping of arrays or numbers): whoever draws other lines needs no runs.

A target is the larger aggregate, m_t and m_p are the masses of target and projectile over the total. `gain` is what the largest piece has
more than the target had, over the projectile's mass (the growth efficiency of Arakawa et al. 2022, eq 28).

    sticking        S   gain of at least STAYS: no less than four fifths of the projectile stay
    bouncing        B1  the two aggregates part again: each side keeps STAYS of the projectile's mass or more, and OWN of what it holds is its
                        own; with compaction where the filling has risen
    mass transfer   B2, F3  neither, and the target is heavier than before
    erosion         F2  the target is not heavier, and keeps at least KEPT of its mass
    fragmentation   F1  it keeps less

Names: Guettler et al. (2010, section 4); mass transfer and erosion as Windmark et al. (2012, section 2) tell them apart, by the sign of the
target's change; KEPT is the usual line of catastrophic disruption. Sticking, STAYS and OWN are those of measures.outcome. Its
bouncing asks that both aggregates together lose no more than a fifth of the projectile's mass to other pieces, B1 that the projectile alone does."""

import numpy as np

from ..measures.outcome import OWN, STAYS, sticks

KINDS = ("sticking", "bouncing", "mass_transfer", "erosion", "fragmentation")
KEPT = 0.5
# What the larger aggregate gains or loses where that is the outcome: columns of tables of outcomes.
OF_KIND = {"gain_mass_transfer": "mass_transfer", "loss_erosion": "erosion", "largest_fragmentation": "fragmentation"}


def gain(row):
    """Mass that the largest piece has gained over the target's, over the projectile's.

    >>> gain({"mass_ratio": 0.25, "largest": 0.9})
    0.5
    """
    return (row["largest"] - _target(row)) / (1 - _target(row))


def change(row):
    """The same where the target is heavier; where it is lighter, what it has lost over its own mass, below 0.

    >>> float(change({"mass_ratio": 0.25, "largest": 0.4})), float(change({"mass_ratio": 0.25, "largest": 0.9}))
    (-0.5, 0.5)
    """
    more = row["largest"] - _target(row)
    return more / np.where(more > 0, 1 - _target(row), _target(row))


def largest_after(changed, mass_ratio):
    """`largest` (mass of the largest piece over the total) by change()."""
    target = _target({"mass_ratio": mass_ratio})
    return target + changed * np.where(changed > 0, 1 - target, target)


def sticking(row):
    """Whether it is, by the rules of this module; so are the others."""
    return sticks(row["largest"], _target(row))


def bouncing(row):
    """Columns mass_ratio, largest, second, own."""
    projectile = 1 - _target(row)
    back = (np.abs(gain(row)) <= 1 - STAYS) & (row["second"] >= STAYS * projectile)
    return back & (row["own"] >= OWN)


def mass_transfer(row):
    """Columns as bouncing()."""
    return ~sticking(row) & ~bouncing(row) & (gain(row) > 0)


def erosion(row):
    """Columns as bouncing()."""
    return ~bouncing(row) & (gain(row) <= 0) & (row["largest"] >= KEPT * _target(row))


def fragmentation(row):
    """Columns as bouncing()."""
    return ~bouncing(row) & (gain(row) <= 0) & (row["largest"] < KEPT * _target(row))


def outcome(row):
    """The name of KINDS of a row, a mapping of numbers.

    >>> outcome({"mass_ratio": 1.0, "largest": 0.5, "second": 0.5, "own": 1.0}), outcome({"mass_ratio": 0.1, "largest": 0.8, "second": 0.01, "own": 1.0})
    ('bouncing', 'erosion')
    """
    values = {name: np.float64(row[name]) for name in ("mass_ratio", "largest", "second", "own")}
    rules = (sticking, bouncing, mass_transfer, erosion, fragmentation)
    return next(name for name, rule in zip(KINDS, rules) if rule(values))


def _target(row):
    """m_t."""
    return 1 / (1 + row["mass_ratio"])
