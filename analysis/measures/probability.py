"""How well a number of runs tells a probability."""

from scipy.stats import binomtest

from ..arguments import COUNT, WHOLE, number, takes, wrong


@takes(
    successes=number(WHOLE),
    trials=number(COUNT),
    confidence=number(("{} between 0 and 1", lambda x: (x > 0) & (x < 1))),
)
def exact_interval(successes, trials, confidence=0.95):
    """(low, high): the exact interval of the probability of which so many of so many independent trials are a sample (Clopper & Pearson 1934).

    >>> [round(bound, 4) for bound in exact_interval(5, 10)], exact_interval(0, 10)[0], exact_interval(10, 10)[1]
    ([0.1871, 0.8129], 0.0, 1.0)
    """
    if successes > trials:
        raise wrong("successes", successes, f"at most trials, {trials}")
    interval = binomtest(int(successes), int(trials)).proportion_ci(confidence, method="exact")
    return float(interval.low), float(interval.high)
