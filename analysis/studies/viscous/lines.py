"""Our numbers beside A22's, as lines of tables, each group with what it can and cannot tell."""

import numpy as np

from ...report.beside_paper import Line
from ...statistics import mean_and_error, pooled_scatter, scatter
from . import paper
from .fragment_lines import fragments, full_size
from .growth_lines import head_on, mean_growth, thresholds
from .loss_lines import channels_by_offset, dissipation, events, pair_speeds
from .results import by_time, named, pairs_text, picoseconds


def compare(results):
    """Yields (heading, [Line], (notes)) of results.Results."""
    growth = (_aggregates, _sticking, thresholds, mean_growth, _largest, head_on)
    for group in (*growth, dissipation, channels_by_offset, events, fragments, full_size, pair_speeds, _collapse):
        yield from group(results)


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
        note = "" if np.isfinite(velocity) else "two grains always stick"
        lines.append(Line(f"v_stick, T_vis = {picoseconds(time)} ps", "m/s", float(velocity), note=note))
    if {0.0, 6e-12} <= set(known):
        ratio = float(known[6e-12] / known[0.0])
        lines.append(Line("v_stick(6 ps)/v_stick(0)", "", ratio, None, paper.STICKING_RATIO, None, "paper: about 10"))
    notes = ("Integrated (A22 eq 30), so without error; tells nothing of aggregates. The paper prints only the ratio.",)
    yield "two grains head-on", lines, notes


def _largest(results):
    runs = results.reference
    runs = runs[runs.grains == paper.GRAINS]
    if not len(runs):
        return
    points = by_time(runs, runs.largest)
    own = [_pairs(runs, time).largest for time, *_ in points]
    spread, freedom = pooled_scatter([scatter(values) for values in own], [number for *_, number in points])
    lines = [
        Line(
            f"N_lar, T_vis = {picoseconds(time)} ps",
            "",
            mean,
            spread / number**0.5 if spread else None,
            paper.LARGEST.get(time),
            spread,
            f"{pairs_text(number)}",
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


def _pairs(runs, time):
    """Means of each pair of aggregates of a table of runs at one T_vis [s], by seed."""
    return runs[(runs.viscoelasticTime - time).abs() < 1e-16].groupby("seed").mean(numeric_only=True)


def _largest_difference(runs, low, high):
    """N_lar at one T_vis less that at another, of the same pairs."""
    at = [_pairs(runs, time).largest for time in (low, high)]
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
        f"{pairs_text(len(differences))}",
        len(differences) - 1,
        shared=True,
    )


def _collapse(results):
    lines = []
    for grains in results.sizes:
        for growth in results.of_size(grains):
            if growth.v_fra is None:
                continue
            name, scale = named("v_fra/v_stick", growth), growth.sticking_velocity
            if np.isfinite(scale):
                error = None if growth.v_fra_error is None else growth.v_fra_error / scale
                lines.append(Line(name, "", growth.v_fra / scale, error))
            else:
                lines.append(Line(name, "", None, note="two grains always stick: there is no v_stick"))
    if lines:
        notes = (
            "If single contacts decided, as a theory of two grains has it, <f_gro> would be one curve of v/v_stick(T_vis) "
            "and these ratios equal at all T_vis. What drag changes is in the next tables.",
        )
        yield "does f_gro collapse with v/v_stick?", lines, notes
