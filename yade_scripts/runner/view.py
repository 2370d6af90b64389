"""What a study looks like as text."""

from analysis.printable import printable
from analysis.report.status import counts, duration_text
from analysis.report.status import line as run_line
from analysis.runs.status import FAILED, RUNNING, WAITING
from yade_scripts.runner.cost import makespan

SHOWN = 15  # lines of a live table


def headline(name, states, cost, rows, at_once):
    """One line: how many rows are done, running, waiting, failed, and the time left."""
    return f"{printable(name)}: {counts(states)}{_left(total_left(states, cost, rows, at_once))}"


def total_left(states, cost, rows, at_once):
    """Seconds until every row is done or has failed, or None when no cost is known."""
    left = {
        kind: [(seconds_left(state, cost, row), row.threads) for state, row in zip(states, rows) if state.kind == kind]
        for kind in (RUNNING, WAITING)
    }
    if any(time is None for time, _ in left[RUNNING] + left[WAITING]):
        return None
    start = cost.piece.start if cost.piece and left[WAITING] and not left[RUNNING] else 0.0
    return start + makespan(left[RUNNING], left[WAITING], at_once)


def seconds_left(state, cost, row):
    """Of one row: by the estimate, and more and more by its own pace as it runs."""
    if state.kind not in (RUNNING, WAITING):
        return 0.0
    estimate = cost.seconds(row)
    if estimate is None:
        return state.left
    by_estimate = estimate * (1 - state.progress)
    if state.kind == WAITING:
        return by_estimate
    if state.left is None:
        return max(0.0, by_estimate - (state.seconds or 0.0))
    return state.progress * state.left + (1 - state.progress) * by_estimate


def line(row, state, cost):
    """One row of the table."""
    return run_line(row.name, state, seconds_left(state, cost, row))


def full_table(name, rows, states, cost, at_once):
    """Every row, and the headline below."""
    return "\n".join(
        [line(row, state, cost) for row, state in zip(rows, states)] + [headline(name, states, cost, rows, at_once)]
    )


def live_table(name, rows, states, cost, at_once):
    """What runs, what failed, and what comes next, in no more than SHOWN lines, below the headline."""
    order = (RUNNING, FAILED, WAITING)
    chosen = sorted(
        (pair for pair in zip(rows, states) if pair[1].kind in order), key=lambda pair: order.index(pair[1].kind)
    )
    more = [f"  and {len(chosen) - SHOWN} more: --status shows all"] if len(chosen) > SHOWN else []
    return "\n".join(
        [headline(name, states, cost, rows, at_once)] + [line(row, state, cost) for row, state in chosen[:SHOWN]] + more
    )


def _left(seconds):
    return "" if seconds is None else f"; {duration_text(seconds)} left"
