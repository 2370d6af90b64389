"""A displacement whose spring is cut at its limit (S17 section 3.2): the kernel's closed form against small steps."""

import numpy as np
import pytest


def followed(before, trial, limit, steps=400_000):
    """The same by small steps of the way, each spring cut in the step after which it is beyond the limit."""
    way = (np.asarray(trial) - before) / steps
    x, mean, left = np.array(before, dtype=float), np.zeros(3), steps
    while left:
        ahead = x + np.arange(1, left + 1)[:, None] * way
        beyond = (ahead**2).sum(axis=1) > limit**2
        taken = np.argmax(beyond) + 1 if beyond.any() else left
        mean += (ahead[:taken] - way / 2).sum(axis=0) / steps
        x, left = np.zeros(3) if beyond.any() else ahead[-1], left - taken
    return x, mean


@pytest.mark.parametrize(
    "before,trial,limit",
    [
        ((0.9, 0.2, 0), (1.1, 0.3, 0), 1.0),  # cut once
        ((0.5, -0.7, 0.1), (-0.2, 1.0, 0.4), 1.0),  # by way of small displacements
        ((0.3, 0.1, 0), (4.0, 0.9, -0.3), 1.0),  # cut several times
        ((0, 0, 0), (2.5, 0, 0), 1.0),  # a contact that has just formed
        ((1.0, 0, 0), (1.05, 0.02, 0), 1.0),  # at its limit before, as the rule `held` leaves it
    ],
)
def test_displacement_and_mean_of_springs_that_are_cut(kernel, before, trial, limit):
    now, mean = kernel.cut_passage(before, trial, limit)
    now_followed, mean_followed = followed(before, trial, limit)
    assert now == pytest.approx(now_followed, abs=1e-4) and mean == pytest.approx(mean_followed, abs=1e-4)


def test_what_the_springs_take_of_an_even_motion_is_k_limit_squared_over_two_a_cut(kernel):
    """Work of the mean force over the way, less what is stored more: exact, for any way."""
    random = np.random.default_rng(3)
    for _ in range(200):
        before = random.normal(size=3)
        before *= random.uniform(0, 1) / np.linalg.norm(before)
        trial = before + random.uniform(0.1, 5) * random.normal(size=3)
        if trial @ trial <= 1:
            continue
        now, mean = kernel.cut_passage(before, trial, 1.0)
        taken = 2 * (mean @ (trial - before)) - (now @ now - before @ before)
        assert now @ now <= 1 + 1e-12
        assert taken == pytest.approx(round(taken), abs=1e-10) and taken > 0.5
