"""Lines of tables on what is lost: energy channels, events, velocities between neighbours."""

import numpy as np

from ...report.beside_paper import Line
from ...statistics import mean_and_error
from . import paper
from .beside_one_pair import beside_one_pair
from .impact_mean import at_impacts
from .measure import DISSIPATION, FAST
from .results import at_velocities, by_time, pairs_text, picoseconds, total_dissipation


def five_ways(runs):
    """{way: energy (runs,) [J]} lost in A22's five ways by a table of runs."""
    parts = {name.removesuffix("Dissipation"): runs[name] for name in DISSIPATION if not name.endswith("connection")}
    return {**parts, "connection and disconnection": runs.connection + runs.disconnection}


def dissipation(results):
    for grains, runs in results.reference.groupby("grains"):
        lines, total, parts = [], total_dissipation(runs), five_ways(runs)
        for name, part in parts.items():
            for time, mean, error, number in by_time(runs, part / total):
                label = f"{name}, T_vis = {picoseconds(time)} ps"
                lines.append(Line(label, "of all that is lost", mean, error, note=f"{pairs_text(number)}"))
        unit = 2 * runs.grains * runs.energy_unit
        for time, mean, error, number in by_time(runs, parts["connection and disconnection"] / unit):
            label = f"E_dis,c/(N_tot F_c delta_c), T_vis = {picoseconds(time)} ps"
            lines.append(
                Line(label, "", mean, error, note=f'{pairs_text(number)}; paper: "on the order of 1" around v_fra')
            )
        for name in ("sliding", "twisting"):
            lines += list(_with_over_without(runs, name, parts[name]))
        notes = (
            "Changes from the start to the end at 50.1 m/s, B_off^2 = 3/12. The paper's finding: rolling is the largest of "
            "the five for every T_vis, connection and disconnection the smallest but for drag without drag; it prints no "
            "numbers. What is lost when contacts break includes the energy of their tangential springs, as in A22.",
            'With drag over without: mean over pairs of each pair\'s ratio. The paper: sliding falls with T_vis, twisting "hardly depends" '
            "on it.",
        )
        yield f"where the energy goes, {grains} grains", lines, notes


def _with_over_without(runs, name, values):
    """Line of what one way loses with the most drag over that with the least, of the pairs that have both."""
    of_pairs = runs.assign(value=values).groupby(["viscoelasticTime", "seed"]).value.mean().unstack("seed")
    low, high = of_pairs.index[0], of_pairs.index[-1]
    ratios = (of_pairs.loc[high] / of_pairs.loc[low]).dropna()
    if low != high and len(ratios):
        theirs, note = (1.0, "paper: hardly depends on T_vis") if name == "twisting" else (None, "paper: falls")
        label = f"{name}, {picoseconds(high)} ps over {picoseconds(low)} ps"
        yield beside_one_pair(
            label, "", *mean_and_error(ratios), len(ratios), theirs, f"{pairs_text(len(ratios))}; {note}"
        )


def channels_by_offset(results):
    """What each of the five ways takes at every B_off, at 50.1 m/s, with the least and the most drag, of the main size."""
    table, grains = results.table, results.main_size
    runs = table[(table.grains == grains) & [at_velocities(v, (paper.VELOCITY,)) for v in table.velocity]]
    times = sorted(set(runs.viscoelasticTime))
    for time in dict.fromkeys((times[0], times[-1])) if times else ():
        own = runs[runs.viscoelasticTime == time]
        parts = five_ways(own)
        points = {name: at_impacts(own, part / own.kinetic_at_start) for name, part in parts.items()}
        lines = []
        for k, (square, *_) in enumerate(points["rolling"]):
            means = {name: mean_and_error(found[k][1]) for name, found in points.items()}
            largest = sorted(means, key=lambda name: -means[name][0])[:2]
            for name in largest:
                lines.append(Line(f"{name}, B_off^2 = {12 * square:.3g}/12", "of K(0)", *means[name]))
        notes = ("The two ways that take most, at 50.1 m/s. Both are of the same pairs.",)
        yield f"channels against B_off, {grains} grains, T_vis = {picoseconds(time)} ps", lines, notes


def events(results):
    for grains, runs in results.reference.groupby("grains"):
        runs = runs[np.isfinite(runs.formed.astype(float))]
        lines = []
        formed, broken = (runs[name].astype(float) / (2 * runs.grains) for name in ("formed", "broken"))
        for quantity, values, theirs in (
            ("N_con", formed, "about 1"),
            ("N_cut", broken, "less than 1"),
            ("(N_con + N_cut)", formed + broken, "about 1"),
        ):
            for time, mean, error, number in by_time(runs, values):
                name = f"{quantity}/N_tot, T_vis = {picoseconds(time)} ps"
                lines.append(Line(name, "", mean, error, note=f"{pairs_text(number)}; paper: {theirs} around v_fra"))
        if lines:
            notes = (
                "50.1 m/s, B_off^2 = 3/12, all contacts that formed and broke since the start, those between grains of one "
                "aggregate too, and a contact that chatters as often as it does. The paper has orders of magnitude, from Figs 14 and 15.",
            )
            yield f"connections and disconnections, {grains} grains", lines, notes


def pair_speeds(results):
    lines = []
    for grains, runs in results.reference.groupby("grains"):
        for time, mean, error, number in by_time(runs, runs.pair_speed):
            note = f"{pairs_text(number)}" + ("; paper: below 1 m/s" if time else "")
            name = f"largest rms of v_rel, T_vis = {picoseconds(time)} ps, {grains} grains"
            lines.append(Line(name, "m/s", mean, error, note=note))
        for time, mean, error, number in by_time(runs, runs.fast_pairs):
            name = f"largest N_pair(|v_rel| > {FAST:g} m/s)/N_tot, T_vis = {picoseconds(time)} ps, {grains} grains"
            note = f"{pairs_text(number)}; paper: below {paper.FAST_PAIRS:g} at 0.32 and 0.63 us"
            lines.append(Line(name, "", mean, error, note=note))
    if lines:
        notes = (
            "Pairs nearer than 2.2 r at 50.1 m/s, B_off^2 = 3/12; the largest over the states, 0.317 us apart: lower bounds, since a peak "
            "between two of them is missed. Small aggregates are over before the paper's 0.3 us.",
        )
        yield "velocities between neighbours", lines, notes
