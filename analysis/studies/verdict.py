"""A paper's claims beside our estimates: reproduced yes, no, or untested.

yes       our 95 % interval lies within the claim's margin (about a value: the interval of the difference, with the error of
          the paper's own runs, taken to scatter as ours; about limits: our own interval)
no        ours lies beyond it: p < 0.05 after Holm's correction over all tests of the page, with the error of the paper's own runs
          (both after Bonferroni's for every look at a claim's pairs after which more were added)
untested  neither, or not run at that size, or not declared a test; `why` says which, and how many pairs would decide"""

import math
from dataclasses import dataclass

from scipy.stats import norm
from scipy.stats import t as student

from .estimate import CONFIDENCE, EXACT, Fraction, number_text, range_text
from .paper import Claim

YES, NO, UNTESTED = "yes", "no", "untested"
LEVEL = 1 - CONFIDENCE
POWER = 0.8


@dataclass(frozen=True)
class Judgement:
    """claim; unit; ours (Estimate or Fraction in that unit; None: not run); p (every look counted; None: not tested); corrected (p after Holm); verdict; why."""

    claim: Claim
    unit: str
    ours: object
    p: float
    corrected: float
    verdict: str
    why: str

    @property
    def state(self):
        """'reproduced', 'contradicted', or why it is neither: 'undecided', 'without a test' (or without an error of ours), 'not run'."""
        if self.verdict != UNTESTED:
            return "reproduced" if self.verdict == YES else "contradicted"
        return "not run" if self.ours is None else "without a test" if self.p is None else "undecided"

    @property
    def ours_text(self):
        """'54.0 ± 1.0 (4)', with the number of pairs; '-' where it is not known."""
        return "-" if self.ours is None else self.ours.text

    @property
    def record(self):
        """All of it for JSON (dict)."""
        said = ("quantity", "label", "where", "printed", "source", "runs", "looks", "margin", "test", "row")
        return {
            **{name: getattr(self.claim, name) for name in said},
            "limits": list(self.claim.limits),
            "unit": self.unit,
            "ours": {} if self.ours is None else self.ours.record,
            **{name: getattr(self, name) for name in ("p", "corrected", "verdict", "why")},
        }


def judge(claims, results):
    """[Judgement] of claims beside definition.Results; ValueError, with the claim's label, for one that is not of these."""
    found = [(claim, *_beside(claim, results)) for claim in claims]
    chances = [p for *_, p in found]
    corrected = holm(chances)
    family = sum(own is not None and own >= LEVEL for own in corrected)
    return [
        Judgement(claim, unit, ours, p, own, *_verdict(claim, ours, own, results.independent, family))
        for (claim, unit, ours, p), own in zip(found, corrected)
    ]


def holm(chances):
    """Holm's corrected p of a family, in its order; None where there was no test.

    >>> holm([0.01, None, 0.04])
    [0.02, None, 0.04]
    """
    order = sorted((p, k) for k, p in enumerate(chances) if p is not None)
    corrected, largest = [None] * len(chances), 0.0
    for place, (p, k) in enumerate(order):
        largest = max(largest, min(1.0, p * (len(order) - place)))
        corrected[k] = largest
    return corrected


def _beside(claim, results):
    """(unit, ours, p) of a claim."""
    key = "quantity"
    try:
        quantity = results[claim.quantity]
        key = "where"
        estimate = quantity.at(**claim.where)
        is_known = estimate is not None and not (estimate.pairs == EXACT and math.isnan(estimate.value))
        ours = quantity.shown(estimate) if is_known else None
        key = "value, low or high"
        return quantity.unit, ours, _chance(claim, ours) if claim.test and ours is not None else None
    except (KeyError, ValueError) as error:
        raise ValueError(f"{claim.label}: {key}: {error.args[0]}") from None


def _agreement(claim):
    """(low, high) of what agrees with a claim: its value or limits, and the margin."""
    low, high = claim.limits
    return low - claim.margin, high + claim.margin


def _chance(claim, ours):
    """p of a number as far beyond agreement as ours, 1 within it; None for a closed form, and without an error."""
    if ours.pairs == EXACT:
        return None
    low, high = _agreement(claim)
    if isinstance(ours, Fraction) and (low > 1 or high < 0):
        raise ValueError(f"{low if low > 1 else high:g} of a fraction: must be 0 to 1")
    p = ours.chance(low, high, claim.runs)
    return None if p is None else min(1.0, claim.looks * p)


def _verdict(claim, ours, corrected, independent, family):
    """(verdict, why); independent: definition.Study's; family: how many tests of the page contradict nothing."""
    if ours is None:
        return UNTESTED, "no runs of ours there"
    if not claim.test:
        return UNTESTED, claim.note or "not declared a test"
    low, high = _agreement(claim)
    if ours.pairs == EXACT:
        return (YES if low <= ours.value <= high else NO), "a closed form, without error"
    if corrected is not None and corrected < LEVEL:
        return NO, f"p = {corrected:.2g} after Holm's correction"
    least, most = _interval(claim, ours)
    if least is None:
        return UNTESTED, f"no error of ours: 1 {independent[:-1]}" if ours.pairs < 2 else "no error of ours"
    within = f"{100 * _confidence(claim):.3g} % interval {range_text(least, most)}, agreement {range_text(low, high)}"
    if low <= least and most <= high:
        return YES, within
    needed = _needed(claim, ours, independent, family) if math.isfinite(most - least) else "bounded on one side at most"
    return UNTESTED, f"{within}; {needed}"


def _interval(claim, ours):
    """Our interval; beside a value, widened by the error of the paper's own runs."""
    if claim.value is None:
        return ours.interval(_confidence(claim))
    value = {"value": claim.value} if isinstance(ours, Fraction) else {}
    return ours.interval(_confidence(claim), claim.runs, **value)


def _confidence(claim):
    return 1 - LEVEL / claim.looks


def _needed(claim, ours, independent, family):
    """How many pairs would decide, with POWER and the scatter there is: reproduce, where ours lies within the margin, or contradict beyond
    it, after Holm's correction over `family` tests, at the next look. More than there are."""
    if isinstance(ours, Fraction):
        return f"{ours.pairs} runs don't decide"
    scatter = ours.error * math.sqrt(ours.pairs)
    low, high = _agreement(claim)
    inside = min(ours.value - low, high - ours.value)
    sides, tests = (2 if inside > 0 or low == high else 1), (1 if inside > 0 else family)
    chances = 1 - LEVEL / (claim.looks + 1) / (sides * tests), POWER
    papers = 0.0 if inside > 0 and claim.value is None else 1 / claim.runs
    inverse = (inside / (norm.ppf(chances).sum() * scatter)) ** 2 - papers  # 1 over the number, were it large
    if inverse <= 0:
        return f"no number of {independent} decides: the paper's {claim.runs} scatter by {number_text(scatter)}"
    needed = max(ours.pairs + 1, math.ceil(1 / inverse))
    while student.ppf(chances, needed - ours.fitted).sum() * scatter * math.sqrt(1 / needed + papers) > abs(inside):
        needed += 1
    return f"some {needed} {independent} would decide"
