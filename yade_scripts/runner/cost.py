"""How long the rows of a study take: from runs that have ended, else from a measured piece of one."""

import heapq
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

# Cost of a contact update grows with this power of the number of grains: 37, 34 and 28 million updates a second
# at 6,400, 51,200 and 409,600 grains.
CACHE_EXPONENT = 0.07
SIMILAR = 1.3  # ratio of sizes up to which ended runs count as equals, their median the estimate
TYPICAL = 3e7  # contact updates a second
TELLING = 2.0  # s that an ended run must have taken to tell of others: shorter ones mostly make packings and files


@dataclass
class Cost:
    """seconds(row) that the run of a runner.rows.StudyRow takes.

    ended: [(row, wall time [s])] of runs that came to their end; measured: (a row, contact updates a second of a piece
    of its run, seconds of setting it up), or None.
    """

    measured: tuple = None
    ended: list = field(default_factory=list)

    @cached_property
    def _ended(self):
        """{(name of the kind, engine): (sizes, times [s])} of what has ended."""
        by_kind = {}
        for row, time in self.ended:
            by_kind.setdefault((row.kind.name, row.parameters.engine), []).append((run_size(row), time))
        return {key: np.array(found).T for key, found in by_kind.items()}

    def seconds(self, wanted):
        """Estimated wall time [s] of a row's run, or None when too little is known."""
        if wanted.kind is None:
            return None
        size = run_size(wanted)
        sizes, times = self._ended.get((wanted.kind.name, wanted.parameters.engine), np.empty((2, 0)))
        ratios = np.maximum(sizes / size, size / sizes)
        similar = (times >= TELLING) | (ratios < SIMILAR)
        if not similar.any():
            return self._from_measured(wanted)
        near = similar & (ratios <= SIMILAR * ratios[similar].min())
        return float(size * np.median(times[near] / sizes[near]))

    def _from_measured(self, wanted):
        if self.measured is None:
            return None
        row, rate, setup = self.measured
        stepping = run_size(wanted) / row.estimate.grains**CACHE_EXPONENT / rate
        return stepping + setup * wanted.estimate.grains / row.estimate.grains


def contact_updates(row):
    """Steps times contacts of a row's run, as its kind estimates them."""
    return row.estimate.contacts * row.estimate.steps


def typical_seconds(row):
    """Seconds that the run of a row takes on a usual processor, where nothing is known of it but the row."""
    return contact_updates(row) / TYPICAL


def run_size(row):
    """Contact updates, weighted with CACHE_EXPONENT."""
    return contact_updates(row) * row.estimate.grains**CACHE_EXPONENT


def makespan(running, waiting, at_once):
    """Seconds until all is done: times left of what runs [s], times of what waits in its order, jobs at once."""
    ends = sorted(running) + [0.0] * (at_once - len(running))
    heapq.heapify(ends)
    for time in waiting:
        heapq.heappush(ends, heapq.heappop(ends) + time)
    return max(ends, default=0.0)
