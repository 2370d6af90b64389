"""Our numbers beside A22's, as lines of tables, each group with what it can and cannot tell."""

import numpy as np

from ...report.beside_paper import Line
from ...statistics import mean_and_error, pooled_scatter, scatter
from . import paper
from .curves import SAME, difference
from .loss_lines import dissipation, events, fragments, pair_speeds
from .results import by_time, named, picoseconds, threshold_error


def compare(results):
    """Yields (heading, [Line], (notes)) of results.Results."""
    for group in (_aggregates, _sticking, _thresholds, _growth, _largest, _head_on, dissipation, events):
        yield from group(results)
    yield from fragments(results)
    yield from pair_speeds(results)
    yield from _collapse(results)


def _aggregates(results):
    lines = []
    for grains, runs in results.table.groupby("grains"):
        pairs = runs.drop_duplicates("seed")
        own = pairs.characteristic_radius / pairs.grain_radius
        theirs = np.array(paper.CHARACTERISTIC_RADII)
        papers = grains == paper.GRAINS and len(pairs) > 1
        lines.append(
            Line(
                f"characteristic radius, {grains} grains",
                "r",
                *mean_and_error(own),
                theirs.mean() if papers else None,
                scatter(own) if papers else None,
                f"{len(pairs)} pairs of aggregates, filling N (r/r_c)^3 = {grains / own.mean() ** 3:.4f}",
                len(pairs) - 1,
                shared=True,
            )
        )
    yield "the aggregates", lines, ("The mean of a pair's two. The paper's error: the scatter of one of our pairs.",)


def _sticking(results):
    lines = []
    per_time = results.table.drop_duplicates("viscoelasticTime").sort_values("viscoelasticTime")
    known = {round(t, 16): v for t, v in zip(per_time.viscoelasticTime, per_time.sticking_velocity)}
    for time, velocity in known.items():
        lines.append(Line(f"v_stick, T_vis = {picoseconds(time)} ps", "m/s", float(velocity)))
    if {0.0, 6e-12} <= set(known):
        ratio = float(known[6e-12] / known[0.0])
        lines.append(Line("v_stick(6 ps)/v_stick(0)", "", ratio, None, paper.STICKING_RATIO, None, "paper: about 10"))
    notes = ("Integrated (A22 eq 30), so without error; tells nothing of aggregates. The paper prints only the ratio.",)
    yield "two grains head-on", lines, notes


def _thresholds(results):
    lines, middle = [], float(np.mean(paper.V_FRA))
    for growth in results.growth.values():
        covered = f"{len(growth.velocities)} velocities"
        note = f"paper: 50 to 60 m/s at {paper.GRAINS} grains; {covered}, {growth.pairs} pairs{_lost(growth.v_fra_resamples)}"
        if growth.v_fra is None:
            end = "above" if growth.mean[-1] > 0 else "below" if growth.mean[0] <= 0 else "not within"
            note = f"{end} the velocities of the runs; {covered}"
        half = 0.5 * (paper.V_FRA[1] - paper.V_FRA[0])
        lines.append(
            Line(named("v_fra", growth), "m/s", growth.v_fra, growth.v_fra_error, middle, half, note, growth.pairs - 1)
        )
    lines += list(_v_fra_ratios(results))
    notes = (
        "v_fra: where <f_gro> first falls through 0, linear in ln v between velocities a quarter apart; the error is from "
        "resampling pairs of aggregates, joint over B_off, velocities and T_vis.",
        "The paper's half width of 5 m/s is the range that it quotes, not an error. Its points are one pair of aggregates "
        "each, so that its v_fra scatters as one of our seeds does: by the error here times the root of the number of "
        "seeds.",
        "Smaller aggregates than the paper's have fewer contacts for the same B_off: their v_fra tells how it depends on "
        "size, and does not test the paper's number.",
    )
    yield "threshold velocity of fragmentation", lines, notes


def _v_fra_ratios(results):
    """v_fra at the largest T_vis over that at the smallest, with joint errors."""
    for grains in results.sizes:
        known = [growth for growth in results.of_size(grains) if growth.v_fra is not None]
        if len(known) > 1:
            low, high = known[0], known[-1]
            ratio = high.v_fra_resamples / low.v_fra_resamples
            error = threshold_error(ratio) if low.has_errors and high.has_errors else None
            times = f"{picoseconds(high.viscous_time)} ps)/v_fra({picoseconds(low.viscous_time)} ps"
            note = f"v_stick: ratio {high.sticking_velocity / low.sticking_velocity:.3g}"
            yield Line(
                f"v_fra({times}), {grains} grains",
                "",
                high.v_fra / low.v_fra,
                error,
                1.0,
                None,
                f"paper: 1; {note}{_lost(ratio)}",
                high.pairs - 1,
            )


def _lost(resamples):
    """Words on resamples (B,) of a threshold that is not within the velocities."""
    lost = float(np.mean(~np.isfinite(resamples)))
    return f"; not within the velocities in {lost:.0%} of the resamples" if lost > 0.01 else ""


def _growth(results):
    """<f_gro> at the two velocities around v_fra, positive at 50 m/s and negative at 63 m/s in the paper."""
    lines = []
    for growth in results.growth.values():
        for velocity in (paper.VELOCITY, 10**1.8):
            found = growth.at(velocity)
            if found is not None:
                sign = "paper: > 0 below 50 m/s" if velocity < 60 else "paper: < 0 above 60 m/s"
                name = named(f"<f_gro> at {velocity:.3g} m/s", growth)
                lines.append(Line(name, "", *found, note=sign))
    lines += list(_growth_differences(results))
    if lines:
        notes = (
            "Mean over B_off by A22 eq 29, trapezoidal rule in B_off^2. The paper draws it and prints signs only.",
        )
        yield "growth efficiency", lines, notes


def _growth_differences(results):
    """<f_gro> with the most drag less that with the least, at 50 m/s, with joint errors: the same pairs of aggregates."""
    for grains in results.sizes:
        low, high = results.of_size(grains)[0], results.of_size(grains)[-1]
        if low is high:
            continue
        found = difference(high, low, paper.VELOCITY)
        if found is not None:
            name = f"{picoseconds(high.viscous_time)} ps less {picoseconds(low.viscous_time)} ps, {grains} grains"
            yield Line(
                f"<f_gro> at 50.1 m/s, {name}", "", *found, 0.0, None, "paper: hardly any difference", high.pairs - 1
            )


def _largest(results):
    runs = results.reference
    runs = runs[runs.grains == paper.GRAINS]
    if not len(runs):
        return
    points = by_time(runs, runs.largest)
    own = [runs.largest[(runs.viscoelasticTime - time).abs() < 1e-16] for time, *_ in points]
    spread, freedom = pooled_scatter([scatter(values) for values in own], [number for *_, number in points])
    lines = [
        Line(
            f"N_lar, T_vis = {picoseconds(time)} ps",
            "",
            mean,
            spread / number**0.5 if spread else None,
            paper.LARGEST.get(time),
            spread,
            f"{number} pairs",
            freedom,
            shared=True,
        )
        for time, mean, _, number in points
    ]
    lines += list(_largest_difference(runs, points[0][0], points[-1][0]))
    notes = (
        "50.1 m/s, B_off^2 = 3/12, the paper's own size. Its four numbers are of one pair of aggregates, which is taken to "
        "scatter as one of ours: p is by Student's t, for both. The scatter of a run is pooled over T_vis.",
        "The difference has each pair with and without drag, so that what differs from pair to pair drops out.",
    )
    yield "largest fragment at full size", lines, notes


def _largest_difference(runs, low, high):
    """N_lar at one T_vis less that at another, of the same pairs."""
    at = [runs[(runs.viscoelasticTime - time).abs() < 1e-16].set_index("seed").largest for time in (low, high)]
    differences = (at[1] - at[0]).dropna()
    if low == high or not len(differences):
        return
    known = {low, high} <= set(paper.LARGEST)
    several = len(differences) > 1
    yield Line(
        f"N_lar, {picoseconds(high)} ps less {picoseconds(low)} ps",
        "",
        *mean_and_error(differences),
        paper.LARGEST[high] - paper.LARGEST[low] if known else None,
        scatter(differences) if several else None,
        f"{len(differences)} pairs",
        len(differences) - 1,
        shared=True,
    )


def _head_on(results):
    lines = []
    low, high = paper.HEAD_ON
    table = results.table
    runs = table[(table.impact == 0) & (table.velocity > low * (1 - SAME)) & (table.velocity < high * (1 + SAME))]
    for grains, own in runs.groupby("grains"):
        of_pairs = own.groupby([own.viscoelasticTime.round(16), "seed"]).growth.mean().reset_index()
        for time, mean, error, number in by_time(of_pairs, of_pairs.growth):
            name = f"f_gro, B_off = 0, 20 to 100 m/s, T_vis = {picoseconds(time)} ps, {grains} grains"
            lines.append(
                Line(name, "", mean, error, 1.0, None, f"{number} pairs; paper: about 1 below 100 m/s", number - 1)
            )
    if lines:
        notes = (
            "Mean over the velocities, then over the pairs of aggregates: a pair at several velocities counts once.",
        )
        yield "head-on collisions", lines, notes


def _collapse(results):
    lines = []
    for grains in results.sizes:
        for growth in results.of_size(grains):
            if growth.v_fra is not None and np.isfinite(growth.sticking_velocity):
                ratio = growth.v_fra / growth.sticking_velocity
                error = None if growth.v_fra_error is None else growth.v_fra_error / growth.sticking_velocity
                lines.append(Line(named("v_fra/v_stick", growth), "", ratio, error))
    if lines:
        notes = (
            "If single contacts decided, as a theory of two grains has it, <f_gro> would be one curve of v/v_stick(T_vis) "
            "and these ratios equal at all T_vis. What drag changes is in the next tables.",
        )
        yield "does f_gro collapse with v/v_stick?", lines, notes
