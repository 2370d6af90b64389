"""Fragments and their sizes (A22 eqs 28, 32, 33), outcomes, restitution, neighbours: by hand and by brute force."""

import numpy as np
import pytest
from written_runs import RADIUS, chain, losing, record, state_arrays, write_run

from analysis.measures.fragments import *
from analysis.measures.motion import pair_velocities, root_mean_square
from analysis.measures.outcome import classify, collision_outcome
from analysis.report.rows import row
from analysis.runs.folder import open_run


def test_fragments_are_what_paths_of_contacts_reach():
    """The hundredth power of the matrix of contacts says which grains a path joins."""
    for contacts in (0, 20, 60, 200):
        pairs = np.random.default_rng(contacts).integers(0, 100, size=(contacts, 2))
        touching = np.eye(100)
        touching[pairs[:, 0], pairs[:, 1]] = touching[pairs[:, 1], pairs[:, 0]] = 1
        labels = fragment_labels(100, pairs)
        assert np.array_equal(labels[:, None] == labels, np.linalg.matrix_power(touching, 100) > 0)


def test_crumbs_of_a_packing_do_not_count():
    # Aggregate 0: nine grains in a chain and a lone one; aggregate 1: two pieces of five.
    pairs = chain(0, 9) + chain(10, 5) + chain(15, 5)
    counted = belongs_to_an_aggregate(np.repeat([0, 1], 10), pairs, np.r_[np.ones(9), 0.5, np.ones(10)])
    assert np.array_equal(np.flatnonzero(~counted), [9])


def test_equal_aggregates_are_judged_by_the_two_largest_pieces():
    rule = {(1.0, 0.0): "sticking", (0.9, 0.1): "sticking", (0.5, 0.5): "bouncing", (0.55, 0.35): "bouncing"}
    torn = ((0.89, 0.11), (0.65, 0.25), (0.45, 0.44), (0.1, 0.1))
    for fractions, kind in {**rule, **dict.fromkeys(torn, "fragmentation")}.items():
        assert classify(*fractions) == kind, fractions


def _state(velocity, *chains, half=20):
    """A state of two aggregates of half of the grains each; chains: (first grain, number) of what hangs together."""
    position = np.arange(2.0 * half)[:, None] * [1e-7, 0, 0]
    pairs = [pair for one in chains for pair in (chain(*one) if isinstance(one, tuple) else [one])]
    return state_arrays(0.0, position, velocity, np.repeat([0, 1], half), pairs)


MEETING = np.repeat([[1.0, 0, 0], [-1.0, 0, 0]], 20, axis=0)
START, STILL = _state(MEETING, (0, 20), (20, 20)), np.zeros((40, 3))


def _outcome(start, end, met=True):
    both = "velocity", "contact_pairs"
    about = (start[name] for name in ("aggregate", *both))
    return collision_outcome(start["radius"] ** 3, *about, *(end[name] for name in both), met)


@pytest.mark.parametrize(
    "pieces, kind",
    [
        ((40,), "sticking"),
        ((38, 2), "fragmentation"),  # three quarters of the projectile stay
        ((32, 8), "bouncing"),
        ((33, 7), "bouncing"),
        ((30, 2, 8), "fragmentation"),  # erosion
        ((32, 6, 2), "fragmentation"),
    ],
)
def test_unlike_aggregates_are_judged_by_what_the_target_gains(pieces, kind):
    """Of 32 and 8 grains: nine tenths of the mass in one piece are no sign of sticking."""
    velocity = np.where(np.arange(40)[:, None] < pieces[0], [[-0.06, 0, 0]], [[0.24, 0, 0]])
    start, end = _state(MEETING, (0, 32), (32, 8)), _state(velocity, *zip(np.cumsum([0, *pieces]), pieces))
    start["aggregate"] = np.repeat([0, 1], [32, 8])
    start["velocity"] = np.where(start["aggregate"][:, None], [[-0.8, 0, 0]], [[0.2, 0, 0]])
    outcome = _outcome(start, end)
    assert outcome.kind == kind
    expected = {"sticking": 0.0, "bouncing": 0.3}.get(kind)
    assert outcome.restitution is expected or outcome.restitution == pytest.approx(expected, abs=1e-12)


@pytest.mark.parametrize("pieces, largest, growth", [((40,), 40, 1.0), ((12, 28), 12, 2 / 30), ((9, 31), 9, -8 / 30)])
def test_growth_is_by_mass_and_the_heavier_aggregate_is_the_target(tmp_path, pieces, largest, growth):
    """Ten grains of twice the radius, 80 of 110 masses, and thirty single ones."""
    start, end = (_state(STILL, *zip(np.cumsum([0, *own]), own)) for own in ((10, 30), pieces))
    for state in (start, end):
        state.update(aggregate=np.repeat([0, 1], [10, 30]), radius=RADIUS * np.repeat([2.0, 1.0], [10, 30]))
    history = losing(np.array([0.0, 1e-9]), touching=1)
    found = row(open_run(write_run(tmp_path / "run", record(RADIUS), history, [start, {**end, "time": 1e-9}])))
    assert (found["largest_fragment"], found["growth_efficiency"]) == (largest, pytest.approx(growth, abs=1e-12))
    assert found["largest_coordination"] == 2.0 * (largest - 1) / largest


@pytest.mark.parametrize("moved", [0, 2, -2])
def test_bouncing_with_known_restitution_whichever_fragment_is_heavier(moved):
    cut = 20 + moved
    velocity = np.where(np.arange(40)[:, None] < cut, [[-0.3, 0.1, 0]], [[0.3, 0.1, 0]])
    outcome = _outcome(START, _state(velocity, (0, cut), (cut, 40 - cut)))
    assert outcome.kind == "bouncing" and outcome.restitution == pytest.approx(0.3)
    assert outcome.largest_fragment == max(cut, 40 - cut) and outcome.fragments == 2
    assert outcome.growth_efficiency == pytest.approx((max(cut, 40 - cut) - 20) / 20)


def test_pieces_that_passed_or_never_met_have_no_restitution_and_grains_that_were_alone_do_not_count():
    outcome = _outcome(START, _state(0.5 * MEETING, (0, 20), (20, 20)))
    assert outcome.kind == "bouncing" and outcome.restitution is None
    # Grains 16 to 19, a fifth of aggregate 0, lie about singly from the start: they count for nothing.
    outcome = _outcome(_state(MEETING, (0, 16), (20, 20)), _state(STILL, (0, 16), (20, 20), [15, 20]))
    assert outcome.kind == "sticking" and outcome.mass_fractions[0] == 1.0
    outcome = _outcome(START, START, met=False)
    assert (outcome.kind, outcome.restitution, outcome.mass_fractions) == ("never met", None, (0.5, 0.5))


def test_two_large_pieces_that_are_not_the_two_aggregates_are_fragments():
    """A part torn off aggregate 0; a merged body that broke in two. Two pieces with all of the mass and more than a
    quarter each, flying apart: no bounce, no restitution."""
    for pieces in ((range(0, 17), range(17, 40)), (range(0, 40, 2), range(1, 40, 2))):
        pairs = [[i, j] for piece in pieces for i, j in zip(piece, piece[1:])]
        velocity = np.where(np.isin(np.arange(40), pieces[0])[:, None], [[-0.3, 0, 0]], [[0.3, 0, 0]])
        outcome = _outcome(START, _state(velocity, *pairs))
        assert sum(outcome.mass_fractions) == 1.0 and min(outcome.mass_fractions) > 0.25
        assert outcome.kind == "fragmentation" and outcome.restitution is None


def test_cumulative_distributions_of_hand_made_fragments():
    """A22 eqs 31 to 33, summed term by term."""
    sizes = np.random.default_rng(1).integers(1, 40, 25)
    pairs = [pair for start, number in zip(np.cumsum([0, *sizes]), sizes) for pair in chain(start, number)]
    found = fragment_sizes(fragment_labels(sizes.sum(), pairs))
    assert sorted(found) == sorted(sizes)
    n = np.bincount(sizes, minlength=200)
    for N in (1, 1.5, 2, 7, 12.99, 39, 100):
        down = int(np.floor(N))
        assert cumulative_grains(found, [N])[0] == sum(n[k] * k for k in range(1, down + 1))
        expected = sum(n[k] * k ** (2 / 3) for k in range(1, down + 1))
        assert cumulative_cross_section(found, [N])[0] == pytest.approx(expected, rel=1e-12)


def test_velocities_of_neighbours_by_all_pairs():
    random = np.random.default_rng(1)
    position, velocity = random.uniform(0, 6, (80, 3)), random.normal(size=(80, 3))
    first, second = np.tril_indices(80, -1)
    apart, faster = position[first] - position[second], velocity[first] - velocity[second]
    distance = np.linalg.norm(apart, axis=1)
    expected = -((faster * apart).sum(axis=1) / distance)[distance < 1.1]
    assert len(expected) > 40
    assert np.sort(pair_velocities(position, velocity, 1.1)) == pytest.approx(np.sort(expected))
    assert np.isnan(root_mean_square([])) and root_mean_square([3.0, -4.0]) == pytest.approx(12.5**0.5)
