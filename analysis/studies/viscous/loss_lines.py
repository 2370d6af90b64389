"""Lines of tables on what is left and lost: energy channels, events, sizes of fragments, velocities between neighbours."""

import numpy as np

from ...report.beside_paper import Line
from . import paper
from .curves import SAME
from .measure import DISSIPATION
from .results import by_time, named, picoseconds, total_dissipation


def dissipation(results):
    for grains, runs in results.reference.groupby("grains"):
        lines, total = [], total_dissipation(runs)
        parts = {**{name: runs[name] for name in DISSIPATION if not name.endswith("connection")}}
        parts["connection and disconnection"] = runs.connection + runs.disconnection
        for name, part in parts.items():
            for time, mean, error, number in by_time(runs, part / total):
                label = f"{name.removesuffix('Dissipation')}, T_vis = {picoseconds(time)} ps"
                lines.append(Line(label, "of all that is lost", mean, error, note=f"{number} runs"))
        unit = 2 * runs.grains * runs.energy_unit
        for time, mean, error, number in by_time(runs, parts["connection and disconnection"] / unit):
            label = f"E_dis,c/(N_tot F_c delta_c), T_vis = {picoseconds(time)} ps"
            lines.append(Line(label, "", mean, error, note=f'{number} runs; paper: "on the order of 1" around v_fra'))
        notes = (
            "Changes from the start to the end at 50.1 m/s, B_off^2 = 3/12. The paper's finding: rolling is the largest of "
            "the five for every T_vis, connection and disconnection the smallest but for drag without drag; it prints no "
            "numbers. What is lost when contacts break includes the energy of their tangential springs, as in A22.",
        )
        yield f"where the energy goes, {grains} grains", lines, notes


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
                lines.append(Line(name, "", mean, error, note=f"{number} runs; paper: {theirs} around v_fra"))
        if lines:
            notes = (
                "50.1 m/s, B_off^2 = 3/12, all contacts that formed and broke since the start, those between grains of one "
                "aggregate too, and a contact that chatters as often as it does. The paper has orders of magnitude, from Figs 14 and 15.",
            )
            yield f"connections and disconnections, {grains} grains", lines, notes


def fragments(results):
    lines = []
    for growth in results.growth.values():
        for velocity, distribution in growth.distributions.items():
            if min(abs(velocity / v - 1) for v in (paper.VELOCITY, 100.0)) > SAME:
                continue
            law, name = distribution.power_law, named(f"{velocity:.3g} m/s", growth)
            theirs = (paper.EXPONENT, paper.AMPLITUDE) if growth.viscous_time > 0 else (None, None)
            lines.append(
                Line(
                    f"alpha, {name}",
                    "",
                    law.exponent,
                    law.exponent_error,
                    theirs[0],
                    None,
                    "f(N) = c N^-alpha",
                    growth.pairs - 1,
                )
            )
            lines.append(
                Line(f"c, {name}", "", law.amplitude, law.amplitude_error, theirs[1], None, "", growth.pairs - 1)
            )
    if lines:
        notes = (
            "Fitted to <N_cum(<= N)> up to 5 % of all grains, least squares of the logarithms; errors joint from "
            "resampling pairs of aggregates. The paper draws N_cum = N for 6 ps by eye.",
            "Fragments larger than that are too few for a law, and in small aggregates the range is short.",
        )
        yield "size distribution of fragments", lines, notes


def pair_speeds(results):
    lines = []
    for grains, runs in results.reference.groupby("grains"):
        for time, mean, error, number in by_time(runs, runs.pair_speed):
            note = f"{number} runs" + ("; paper: below 1 m/s" if time else "")
            lines.append(
                Line(
                    f"largest rms of v_rel, T_vis = {picoseconds(time)} ps, {grains} grains",
                    "m/s",
                    mean,
                    error,
                    note=note,
                )
            )
    if lines:
        notes = (
            "Pairs nearer than 2.2 r at 50.1 m/s, B_off^2 = 3/12; the largest over the states, so that a peak between two of "
            "them is missed. Small aggregates are over before the paper's 0.3 us.",
        )
        yield "velocities between neighbours", lines, notes
