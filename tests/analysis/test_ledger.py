"""The ledger's sum, closure and fractions."""

import numpy as np
import pytest

from analysis.runs.format import CHANNELS
from analysis.runs.ledger import closure, closure_history, fractions, fractions_at, total_energy


def _history(**changed):
    history = {name: np.zeros(4) for name in CHANNELS}
    history["kinetic"] = np.array([2.0, 1.0, 0.5, 0.0])
    history["normal"] = np.array([-10.0, -10.0, -11.0, -12.0])
    history["connection"] = np.array([0.0, 1.0, 2.5, 4.0])
    return {**history, **changed}


def test_sum_and_closure_which_is_undefined_without_kinetic_energy_at_the_start():
    assert list(total_energy(_history())) == [-8.0] * 4
    assert closure(_history()) == 0.0
    leaky = _history(drag=np.array([0.0, 0.2, -0.3, 0.1]))
    assert closure_history(leaky) == pytest.approx([0.0, 0.1, -0.15, 0.05])
    assert closure(leaky) == pytest.approx(0.15)
    at_rest = _history(kinetic=np.zeros(4))
    assert closure(at_rest) is None and fractions(at_rest) is None


def test_every_channel_counts():
    for channel in CHANNELS:
        history = _history()
        history[channel] = history[channel] + np.array([0.0, 0.0, 0.0, 0.5])
        assert closure(history) == pytest.approx(0.25), channel


def test_fractions_add_up_to_one():
    parts = fractions(_history())
    assert sum(parts.values()) == pytest.approx(np.ones(4))
    assert parts["normal"] == pytest.approx([0.0, 0.0, -0.5, -1.0]) and parts["kinetic"][0] == 1.0
    between = fractions_at(_history(time=np.arange(4.0)), 2.5)
    assert between["normal"] == pytest.approx(-0.75) and sum(between.values()) == pytest.approx(1.0)
