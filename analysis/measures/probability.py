"""How well a number of runs tells a probability."""

from scipy.stats import binomtest


def wilson(successes, trials, confidence=0.95):
    """(low, high): Wilson's score interval of the probability of which so many of so many independent trials are a sample (Wilson 1927).

    >>> [round(float(bound), 4) for bound in wilson(5, 10)], wilson(0, 10)[0], wilson(10, 10)[1]
    ([0.2366, 0.7634], 0.0, 1.0)
    """
    interval = binomtest(successes, trials).proportion_ci(confidence, method="wilson")
    return float(interval.low), float(interval.high)
