"""What one parameter changes, told by the same clusters.

K13 finds that P r0^3/E_roll at a filling depends neither on the boundaries' speed nor on the damping (sections 3.2, 3.4), nor on
xi_crit up to 8 Å (section 3.5). Runs of one seed and size start from one cluster, whose own scatter drops out of their ratio."""

from dataclasses import dataclass

import numpy as np

from ...statistics import mean_and_error, student_chance
from .curve import FILLINGS
from .paper import EXPONENT, VALID_TO
from .scene import KEYS
from .strength_fit import within

CHANGED = ("strainRate", "linearDamping", "criticalRolling", "stepFraction")


@dataclass(frozen=True)
class Change:
    """Runs of `group` beside those of `base`, of which they differ in the parameter `name`, by the `seeds` that both have:
    ratio of P r0^3/E_roll, the mean of its logarithm and its error (None: one seed)."""

    name: str
    base: object
    group: object
    seeds: int
    ratio: float
    error: float | None

    @property
    def chance(self):
        """Of a ratio as far from 1, by Student's t; None for one seed."""
        return None if not self.error else student_chance(np.log(self.ratio) / self.error, self.seeds - 1)


def changes(results):
    """[Change] for each material and size: from its group that has most others one parameter away, or from that with another
    step, to every group that is one parameter away."""
    found = []
    for base in _bases(results.groups):
        steps = [group for group in results.groups if _different(base, group) == ["stepFraction"]]
        for group in (group for group in results.groups if group is not base):
            name, other = next(_one_away(group, (base, *steps)), (None, None))
            change = _change(name, other, group) if name in CHANGED else None
            found += [change] if change else []
    return sorted(found, key=lambda c: (CHANGED.index(c.name), c.group.parameters[c.name]))


def _one_away(group, others):
    """(name, other) of those that differ from a group in one parameter."""
    for other in others:
        different = _different(other, group)
        if len(different) == 1:
            yield different[0], other


def _bases(groups):
    families = {}
    for group in groups:
        families.setdefault((group.parameters["material"], group.parameters["grains"]), []).append(group)
    for own in families.values():
        neighbours = [sum(len(_different(group, other)) == 1 for other in own) for group in own]
        yield own[int(np.argmax(neighbours))]


def _different(first, second):
    return [name for name in KEYS if first.parameters[name] != second.parameters[name]]


def _change(name, base, group):
    low = max(base.fit.between[0], group.fit.between[0])
    used = within(FILLINGS, low, VALID_TO) & base.covered & group.covered
    sums = [
        dict(zip(g.table.seed, (g.pressure / FILLINGS**EXPONENT)[:, used].sum(axis=1) / g.scale)) for g in (group, base)
    ]
    seeds = [seed for seed in sums[0] if min(sums[0][seed], sums[1].get(seed, 0.0)) > 0]
    if not seeds:
        return None
    mean, error = mean_and_error([np.log(sums[0][seed] / sums[1][seed]) for seed in seeds])
    return Change(name, base, group, len(seeds), float(np.exp(mean)), error)
