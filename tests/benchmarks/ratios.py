"""Rates and ratios out of the results of speed.measure()."""

import statistics
from dataclasses import dataclass

INSTRUCTIONS = {"engine": "best"}  # of the codes that have a choice, what is meant unless said


@dataclass(frozen=True)
class Spread:
    """Median, least and most of the rounds."""

    median: float
    least: float
    most: float

    @classmethod
    def of(cls, values):
        return cls(statistics.median(values), min(values), max(values))

    def text(self, digits):
        return f"{self.median:.{digits}f} ({self.least:.{digits}f} - {self.most:.{digits}f})"


def by_processor_time(result):
    """Contact updates a second of processor time: what a program does when others take part of the machine. One core only: waiting threads spin."""
    return result["rate"] / result["fraction"]


class Speeds:
    """Looks up what was measured of a code (the labels of speed.py); None where it was not."""

    def __init__(self, results, reference):
        self.results, self.reference = results, reference

    def find(self, code, threads=1, radius=None, kind="uniform", instructions=None):
        wanted = {
            "code": code,
            "threads": threads,
            "radius": self.reference if radius is None else radius,
            "kind": kind,
            "instructions": instructions or INSTRUCTIONS.get(code, ""),
        }
        return [result for result in self.results if all(result[name] == value for name, value in wanted.items())]

    def rate(self, *code, **labels):
        """Spread of the contact updates a second."""
        found = self.find(*code, **labels)
        return Spread.of([result["rate"] for result in found]) if found else None

    def ratio(self, first, second, rate=lambda result: result["rate"]):
        """Spread over the rounds of the ratio of two codes, each a dict of labels; rate: function of a result."""
        a, b = self.find(**first), self.find(**second)
        if not a or not b:
            return None
        return Spread.of([rate(x) / rate(y) for x, y in zip(a, b)])
