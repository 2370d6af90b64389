"""Lines of tables on growth efficiency: thresholds, means over B_off, head-on collisions."""

import numpy as np

from . import paper
from .beside_one_pair import beside_one_pair, beside_range
from .curves import difference
from .grid import SAME, time_of_grid
from .impact_mean import of_papers_offsets, offsets_text
from .results import by_time, named, pairs_text, picoseconds, threshold_error
from .whole_pairs import whole_pairs


def thresholds(results):
    lines, (low, high) = [], paper.V_FRA
    for growth in results.growth.values():
        covered = f"{len(growth.velocities)} velocities"
        note = f"paper: {low:g} to {high:g} m/s at {paper.GRAINS} grains; {covered}, {pairs_text(growth.pairs)}{_lost(growth.v_fra_resamples)}"
        if growth.v_fra is None:
            end = "above" if growth.mean[-1] > 0 else "below" if growth.mean[0] <= 0 else "not within"
            note = f"{end} the velocities of the runs; {covered}"
        found = (named("v_fra", growth), "m/s", growth.v_fra, growth.v_fra_error, growth.pairs)
        lines.append(_beside_offsets(growth, found, low, high, note))
    lines += list(_v_fra_ratios(results))
    notes = (
        "v_fra: where <f_gro> first falls through 0, linear in ln v between velocities a quarter apart; the error is from "
        "resampling pairs of aggregates, joint over B_off, velocities and T_vis.",
        f"The paper gives a range: within it there is no difference, beyond it p is against the nearer end, {low:g} or {high:g} m/s.",
        "Smaller aggregates than the paper's have fewer contacts for the same B_off: their v_fra tells how it depends on "
        "size, and does not test the paper's number.",
        "A v_fra of other offsets than the paper's 13 says how many, and is another number, beside none of the paper's: with fewer the "
        "head-on peak weighs more.",
    )
    yield "threshold velocity of fragmentation", lines, notes


def _beside_offsets(growth, found, low, high, note):
    """beside_range of what was found of a Growth, or beside nothing where its offsets are not the paper's."""
    if of_papers_offsets(growth.offsets, high) is None:
        return beside_one_pair(*found, None, note)
    return beside_range(*found, low, high, note)


def _v_fra_ratios(results):
    """v_fra at the largest T_vis over that at the smallest, with joint errors."""
    for grains in results.sizes:
        known = [growth for growth in results.of_size(grains) if growth.v_fra is not None]
        if len(known) > 1 and known[0].offsets == known[-1].offsets:
            low, high = known[0], known[-1]
            ratio = high.v_fra_resamples / low.v_fra_resamples
            error = threshold_error(ratio) if low.has_errors and high.has_errors else None
            times = f"{picoseconds(high.viscous_time)} ps)/v_fra({picoseconds(low.viscous_time)} ps"
            name = f"v_fra({times}), {grains} grains{offsets_text(high.offsets)}"
            note = f"paper: 1; {_sticking_ratio(low, high)}{_lost(ratio)}"
            pairs = min(low.pairs, high.pairs)
            yield beside_one_pair(
                name, "", high.v_fra / low.v_fra, error, pairs, of_papers_offsets(high.offsets, 1.0), note
            )


def _sticking_ratio(low, high):
    """Words on how v_stick changes from one Growth's T_vis to another's."""
    if not np.isfinite(high.sticking_velocity):
        return f"two grains always stick at {picoseconds(high.viscous_time)} ps"
    return f"v_stick: ratio {high.sticking_velocity / low.sticking_velocity:.3g}"


def _lost(resamples):
    """Words on resamples (B,) of a threshold that is not within the velocities."""
    lost = float(np.mean(~np.isfinite(resamples)))
    return f"; not within the velocities in {lost:.0%} of the resamples" if lost > 0.01 else ""


def mean_growth(results):
    """<f_gro> at the two velocities around v_fra, positive at 50 m/s and negative at 63 m/s in the paper."""
    lines = []
    # The paper: > 0 below 50 m/s, < 0 above 60 m/s, for all T_vis. 50.1 m/s is between them, so that no sign is tested there.
    signs = ((paper.VELOCITY, -np.inf, "paper: > 0 below 50 m/s"), (10**1.8, 0.0, "paper: < 0 above 60 m/s"))
    for growth in results.growth.values():
        for velocity, most, said in signs:
            k = growth.place(velocity)
            if k is not None:
                name, pairs = named(f"<f_gro> at {velocity:.3g} m/s", growth), int(growth.numbers[k])
                found = (name, "", *growth.at(velocity), pairs)
                if np.isfinite(most):
                    lines.append(_beside_offsets(growth, found, -np.inf, most, said))
                else:
                    lines.append(beside_one_pair(*found, None, said))
    lines += list(_growth_differences(results))
    if lines:
        notes = (
            "Mean over B_off by A22 eq 29, trapezoidal rule in B_off^2. The paper draws it and prints signs only: p is of a wrong sign.",
        )
        yield "growth efficiency", lines, notes


def _growth_differences(results):
    """<f_gro> with the most drag less that with the least, at 50 m/s, with joint errors: the same pairs of aggregates."""
    for grains in results.sizes:
        low, high = results.of_size(grains)[0], results.of_size(grains)[-1]
        found = difference(high, low, paper.VELOCITY) if low is not high else None
        if found is not None:
            times = f"{picoseconds(high.viscous_time)} ps less {picoseconds(low.viscous_time)} ps"
            name = f"<f_gro> at 50.1 m/s, {times}, {grains} grains{offsets_text(high.offsets)}"
            pairs = min(int(own.numbers[own.place(paper.VELOCITY)]) for own in (low, high))
            yield beside_one_pair(
                name, "", *found, pairs, of_papers_offsets(high.offsets, 0.0), "paper: hardly any difference"
            )


def head_on(results):
    lines = []
    low, high = paper.HEAD_ON
    table = results.table
    runs = table[(table.impact == 0) & table.velocity.between(low * (1 - SAME), high * (1 + SAME))]
    for (grains, _), own in runs.groupby(["grains", runs.viscoelasticTime.map(time_of_grid)]):
        own, velocities = whole_pairs(own, own.velocity.round(6), own.seed)
        ((time, mean, error, pairs),) = by_time(own, own.growth)
        span = f"{velocities[0]:.3g}" + (f" to {velocities[-1]:.3g}" if len(velocities) > 1 else "")
        name = f"f_gro, B_off = 0, {span} m/s, T_vis = {picoseconds(time)} ps, {grains} grains"
        note = f"{pairs_text(pairs)}, {len(velocities)} velocities; paper: about 1 from 20 to 100 m/s"
        lines.append(beside_one_pair(name, "", mean, error, pairs, 1.0, note))
    if lines:
        notes = (
            "Mean over the velocities, then over the pairs of aggregates that have all of them: a pair at several velocities counts "
            "once. The velocities differ from size to size, so that rows of two sizes are no comparison of them.",
        )
        yield "head-on collisions", lines, notes
