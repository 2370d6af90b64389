"""How well a number of runs tells a probability."""

from scipy.stats import binomtest

from ..arguments import COUNT, WHOLE, number, takes, wrong


@takes(
    successes=number(WHOLE),
    trials=number(COUNT),
    confidence=number(("{} between 0 and 1", lambda x: (x > 0) & (x < 1))),
)
def wilson(successes, trials, confidence=0.95):
    """(low, high): Wilson's score interval of the probability of which so many of so many independent trials are a sample (Wilson 1927).

    >>> [round(float(bound), 4) for bound in wilson(5, 10)], wilson(0, 10)[0], wilson(10, 10)[1]
    ([0.2366, 0.7634], 0.0, 1.0)
    """
    if successes > trials:
        raise wrong("successes", successes, f"at most trials, {trials}")
    interval = binomtest(int(successes), int(trials)).proportion_ci(confidence, method="wilson")
    return float(interval.low), float(interval.high)
