"""How long the rows of a study take: from runs that have ended, else from a measured piece of one."""

import heapq
import re
from dataclasses import dataclass, field
from functools import lru_cache
from statistics import median

from yade_scripts.materials import MATERIALS, equilibrium_overlap
from yade_scripts.packings import maximum_filling
from yade_scripts.parameters import DURATION_PER_RADIUS, ParameterError, complete
from yade_scripts.step_choice import AUTO, SHORTEST

# Cost of a contact update grows with this power of the number of grains: 37, 34 and 28 million updates a second
# at 6,400, 51,200 and 409,600 grains (tests/benchmarks/results/speed.md).
CACHE_EXPONENT = 0.07
ALIKE = 1.3  # ratio of costs up to which ended runs count as equals, their median the estimate
TELLING = 10.0  # s that an ended run must have taken to tell of others: shorter ones mostly start up
NEIGHBOURS = 12  # of a site of the close-packed lattice
PLANAR_NEIGHBOURS = 6


@dataclass
class Cost:
    """seconds(values) that a run takes.

    timeUnit: {material: t0 [s]}; ended: [(values, wall time [s])] of runs that came to their end; measured:
    (values of a scene, contact updates a second, seconds of setting it up), or None.
    """

    timeUnit: dict
    measured: tuple = None
    ended: list = field(default_factory=list)

    def seconds(self, values):
        """Estimated wall time [s] of a run with these parameters, or None when too little is known."""
        if values["duration"] is not None and values["material"] not in self.timeUnit:
            return None
        wanted = self.size(values)
        alike = [
            (run, time)
            for run, time in self.ended
            if run["engine"] == values["engine"] and (time >= TELLING or 1 / ALIKE < self.size(run) / wanted < ALIKE)
        ]
        if not alike:
            return self._from_measured(values)
        sizes = [self.size(run) for run, _ in alike]
        nearest = min(max(size / wanted, wanted / size) for size in sizes)
        times = [
            time / size for (_, time), size in zip(alike, sizes) if max(size / wanted, wanted / size) <= ALIKE * nearest
        ]
        return wanted * median(times)

    def size(self, values):
        """Contact updates of a run, weighted with CACHE_EXPONENT: grains, contacts of a CPE packing, steps."""
        return self.contact_updates(values) * values["grains"] ** CACHE_EXPONENT

    def contact_updates(self, values):
        """Steps times contacts; each grain has NEIGHBOURS/2 times the share of sites that is filled (A24 eq 39), in BCCA one."""
        material = MATERIALS[values["material"]]
        planar = bool(values["planar"])
        share = values["filling"] / maximum_filling(material.grainRadius, equilibrium_overlap(material), planar)
        neighbours = 2 if values["packing"] == "bcca" else share * (PLANAR_NEIGHBOURS if planar else NEIGHBOURS)
        duration = DURATION_PER_RADIUS * values["radius"]
        if values["duration"] is not None:
            duration = values["duration"] / self.timeUnit[values["material"]]
        return 2 * values["grains"] * neighbours / 2 * duration / step_of(values)

    def _from_measured(self, values):
        if self.measured is None:
            return None
        scene, rate, setup = self.measured
        time = self.size(values) / scene["grains"] ** CACHE_EXPONENT / rate
        return time + setup * values["grains"] / scene["grains"]


def step_of(values):
    """stepFraction as a run will have it; AUTO is resolved from the theory's constants, without the plugin."""
    if values["stepFraction"] != AUTO:
        return values["stepFraction"]
    material, viscoelastic_time = MATERIALS[values["material"]], values["viscoelasticTime"]
    try:
        return complete(values, pair_constants(material, viscoelastic_time), values["threads"] or 1)["stepFraction"]
    except ParameterError:  # the run will say what is wrong
        return SHORTEST


@lru_cache
def pair_constants(material, viscoelastic_time):
    """Constants of a contact of two grains, by the names that the plugin gives them."""
    from analysis import theory  # takes a moment, and only few studies need it

    pair = theory.pair_constants(
        theory.Material(
            young=material.young,
            poisson=material.poisson,
            density=material.density,
            surface_energy=material.surfaceEnergy,
            critical_rolling=material.criticalRolling,
            viscoelastic_time=viscoelastic_time,
        ),
        material.grainRadius,
    )
    return {re.sub("_(.)", lambda letter: letter[1].upper(), name): value for name, value in vars(pair).items()}


def makespan(running, waiting, at_once):
    """Seconds until all is done: times left of what runs [s], times of what waits in its order, jobs at once."""
    ends = sorted(running) + [0.0] * (at_once - len(running))
    heapq.heapify(ends)
    for time in waiting:
        heapq.heappush(ends, heapq.heappop(ends) + time)
    return max(ends, default=0.0)
