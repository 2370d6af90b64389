"""The comparison with K13: the sections of the report, with what each can't tell."""

import numpy as np

from ...report.beside_paper import Line, number, section_of_lines
from ...report.section import Column, Section
from ...statistics import mean_and_error
from ...theory.aggregates import bcca_coordination
from ...theory.compression import DENSEST, compressive_strength_dense, tensile_strength
from . import paper
from .curve import FILLINGS
from .measure import ENERGY_FILLINGS, LOST_CHANNELS
from .paired import changes

FIT_NOTES = (
    "P0 and n: least squares of the logarithm of the mean over the seeds, from where boundaries are slower than sound "
    "(K13 eqs 26, 27) and the filling is above a free cluster's (eq 24), up to 0.1. Errors: jackknife over the seeds, so "
    "that they hold whatever the bins have in common; of one seed there are none.",
    "P0 is the line continued to a filling of 1, a decade beyond the data: with n it is correlated as told. P0 with n = 3 "
    "is free of that, and is the number to compare.",
    "What this can't tell: whether n is 3 below the fitted range, which takes larger clusters and slower boundaries; and "
    "K13's own errors, which it doesn't give.",
)
LEAST_FRACTION = 5e-4  # of all dissipation: less than the tables show tells no largest channel
CHANNEL_NOTES = (
    "Fractions of all that was dissipated until then, boundaries' work that is still stored or moving left out.",
    "What this can't tell: which contacts pay. Dissipation of the first approach, when free clusters are pressed "
    "together, is in the sum.",
)

# Of a family of runs, in every table.
PARAMETERS = (
    Column("material", lambda r: r["material"]),
    Column("N", lambda r: f"{r['grains']}"),
    Column("C_v", lambda r: f"{r['strainRate']:g}"),
    Column("k_n", lambda r: f"{r['linearDamping']:g}"),
    Column("xi_crit [Å]", lambda r: f"{r['criticalRolling'] * 1e10:.3g}"),
)


def sections(results):
    """Sections of results.Results."""
    for group in results.groups:
        if group.fit.reason is None and (group is results.main or group.seeds > 1):
            yield section_of_lines(f"compressive strength: {label(group)}", _fit_lines(group), ())
    yield _dependence(results)
    yield from _changes(results)
    yield from _silicate(results)
    yield _channels(results)
    yield _beyond(results.main)
    yield from _structure(results)
    yield from _tensile(results)


def remarks(results):
    """Lines that say what could not be fitted, and why."""
    for group in results.groups:
        if group.fit.reason:
            yield f"not fitted: {label(group)}: {group.fit.reason}"
    worst = float(results.table.closure.max())
    yield f"the energy ledger closes to {worst:.1g} of the work of the boundaries or better in all {len(results.table)} runs"


def label(group):
    """A group's parameters in a line."""
    p = group.parameters
    return (
        f"{p['material']}, N = {p['grains']}, C_v = {p['strainRate']:g}, k_n = {p['linearDamping']:g}, "
        f"xi_crit = {p['criticalRolling'] * 1e10:.3g} Å, step {p['stepFraction']:g} t0"
    )


def _fit_lines(group):
    fit = group.fit
    of_log, of_exponent = fit.errors
    note = f"{fit.runs} runs, {fit.bins} bins of the filling, {fit.between[0]:.2g} to {fit.between[1]:.2g}"
    together = "" if fit.correlation is None else f"; correlation with n {fit.correlation:+.3f}"
    freedom = fit.runs - 1 or None
    yield Line("n", "", fit.exponent, of_exponent, paper.EXPONENT, note=note, freedom=freedom)
    yield Line(
        "P0",
        "Pa",
        fit.scale,
        None if of_log is None else fit.scale * of_log,
        group.scale,
        note="paper: E_roll/r0^3" + together,
        freedom=freedom,
    )
    error = None if fit.at_three_error is None else fit.at_three * fit.at_three_error
    yield Line("P0 with n = 3", "Pa", fit.at_three, error, group.scale, note="paper: E_roll/r0^3", freedom=freedom)


def _dependence(results):
    records = [
        {
            **group.parameters,
            "runs": group.seeds,
            "exponent": group.fit.exponent,
            "exponent_error": group.fit.errors[1],
            "ratio": _over(group.fit.at_three, group.scale),
            "ratio_error": _over(group.fit.at_three, group.scale, group.fit.at_three_error),
        }
        for group in results.groups
    ]
    columns = (
        *PARAMETERS,
        Column("step [t0]", lambda r: f"{r['stepFraction']:g}"),
        Column("runs", lambda r: f"{r['runs']}"),
        Column("n", lambda r: _with_error(r["exponent"], r["exponent_error"])),
        Column("P0 (n = 3) r0^3/E_roll", lambda r: _with_error(r["ratio"], r["ratio_error"])),
    )
    return Section("dependence on the parameters", columns, tuple(records), notes=FIT_NOTES)


def _changes(results):
    found = changes(results)
    if not found:
        return
    shown = {
        "strainRate": ("C_v", 1),
        "linearDamping": ("k_n", 1),
        "criticalRolling": ("xi_crit [Å]", 1e10),
        "stepFraction": ("step [t0]", 1),
    }
    records = []
    for change in found:
        parameter, unit = shown[change.name]
        old, new = change.base.parameters, change.group.parameters
        record = {"material": new["material"], "grains": new["grains"], "parameter": parameter}
        record.update({"from": unit * old[change.name], "to": unit * new[change.name], "seeds": change.seeds})
        records.append({**record, "ratio": change.ratio, "error": change.error, "chance": change.chance})
    columns = (
        *PARAMETERS[:2],
        Column("changed", lambda r: f"{r['parameter']}: {r['from']:g} to {r['to']:g}"),
        Column("seeds", lambda r: f"{r['seeds']}"),
        Column("P r0^3/E_roll changes by", lambda r: _with_error(r["ratio"], r["error"] and r["ratio"] * r["error"])),
        Column("p", lambda r: "-" if r["chance"] is None else f"{r['chance']:.2g}"),
    )
    intro = (
        "Factor, mean over the fillings at which both are static (K13 eqs 26, 27) up to 0.1, by pairs of runs that start from "
        "one cluster. K13: 1 for C_v and k_n, and for xi_crit up to 8 Å; not quite at 16 and not at 32 Å."
    )
    notes = ("p: chance of a factor as far from 1, by Student's t. Rows share the runs they are compared with.",)
    yield Section("one parameter changed, the same clusters", columns, tuple(records), intro, notes)


def _silicate(results):
    """K13 section 3.7."""
    groups = [group for group in results.of("silicate") if np.isfinite(group.table.filling_at_300).any()]
    if not groups:
        return
    lines = []
    for group in groups:
        found = group.table.filling_at_300.dropna()
        for source, theirs in paper.SILICATE_FILLINGS.items():
            lines.append(_of_seeds(f"filling at 300 Pa, {source}", "", found, theirs, label(group)))
    notes = (
        "Grains of 0.6 um; Seizinger et al. press BPCA aggregates between walls, Guettler et al. fit experiments with a "
        "mixture of grains: their numbers as K13 gives them.",
        "What this can't tell: whether the surface energy of 0.02 J/m^2 is that of the experiments' silica.",
    )
    yield section_of_lines("silicate at 300 Pa", lines, notes)


def _channels(results):
    records = []
    for group in results.groups:
        for filling in ENERGY_FILLINGS:
            lost = {channel: group.energy(channel, filling) for channel in LOST_CHANNELS}
            total = sum(lost.values())
            if not np.isfinite(total) or total <= 0:
                continue
            fractions = {channel: value / total for channel, value in lost.items()}
            modes = {name: fractions[f"{name}Dissipation"] for name in ("rolling", "twisting", "sliding")}
            largest = max(modes, key=modes.get)
            largest = largest if modes[largest] >= LEAST_FRACTION else None
            records.append({**group.parameters, "filling": filling, **fractions, "largest": largest})
    columns = (
        *PARAMETERS,
        Column("filling", lambda r: f"{r['filling']:g}"),
        Column("rolling", lambda r: f"{r['rollingDissipation']:.3f}"),
        Column("twisting", lambda r: f"{r['twistingDissipation']:.3f}"),
        Column("sliding", lambda r: f"{r['slidingDissipation']:.3f}"),
        Column("damping", lambda r: f"{r['drag']:.3f}"),
        Column("connection + disconnection", lambda r: f"{r['connection'] + r['disconnection']:.3f}"),
        Column("largest of the three", lambda r: r["largest"] or "-"),
    )
    intro = (
        "K13 sections 3.4, 3.5: rolling is the largest where xi_crit is 8 Å or less, and twisting sets in above a filling of "
        "0.1; at 16 Å they are comparable, at 32 Å twisting is the largest."
    )
    return Section("where the energy goes", columns, tuple(records), intro, CHANNEL_NOTES)


def _beyond(group):
    """Strength and coordination of the main group against the formulae for any filling."""
    records = []
    for k in np.flatnonzero(group.covered):
        mean, error = mean_and_error(group.pressure[:, k])
        contacts, contacts_error = mean_and_error(group.coordination[:, k])
        filling = float(FILLINGS[k])
        records.append(
            {
                "filling": filling,
                "pressure": mean,
                "pressure_error": error,
                "K13": group.scale * filling**3,
                "T23": float(compressive_strength_dense(filling, group.scale)),
                "coordination": contacts,
                "coordination_error": contacts_error,
                "A24": float(bcca_coordination(filling)),
            }
        )
    columns = (
        Column("filling", lambda r: f"{r['filling']:.3g}"),
        Column("P [Pa]", lambda r: _scientific(r["pressure"], r["pressure_error"])),
        Column("over K13 eq 25", lambda r: f"{r['pressure'] / r['K13']:.3g}"),
        Column(f"over T23 (phi_max = {DENSEST:g})", lambda r: f"{r['pressure'] / r['T23']:.3g}"),
        Column("Z", lambda r: _with_error(r["coordination"], r["coordination_error"])),
        Column("Z of A24 eq 45", lambda r: f"{r['A24']:.3f}"),
    )
    notes = (
        "A24's eq 44 is T23's formula with E_roll/r0^3 = 0.47 MPa, ice's.",
        "What this can't tell: the formulae are for quasistatic compression; a single C_v shows it only where another one "
        "gives the same.",
    )
    return Section(f"strength at any filling: {label(group)}", columns, tuple(records), notes=notes)


def _structure(results):
    group = results.main
    lines = [
        _of_seeds(f"D at a filling of {filling:g}", "", values, paper.DIMENSION)
        for filling, values in group.dimensions().items()
    ]
    if lines:
        notes = (
            "Slope of N(< r) between 3 and 10 grain radii. K13's 2 holds inside the clusters: up to r0/phi, which is 10 "
            "grain radii at a filling of 0.1, so that the last line goes to 3.",
        )
        yield section_of_lines(f"fractal structure: {label(group)}", lines, notes)


def _tensile(results):
    lines = []
    columns = ["material", "grains", "strainRate", "finalFilling", "stretched_axes", "surface_energy", "grainRadius"]
    for key, runs in results.stretched.groupby(columns, sort=True):
        material, grains, rate, _, axes, surface, radius = key
        start = float(runs.largest_filling.mean())
        theirs = float(tensile_strength(start, surface, radius)) if axes == 1 else None
        place = f"{runs.tensile_filling.mean() / start:.2f} of the filling before"
        note = f"{material}, N = {grains}, C_v = {rate:g}, {len(runs)} runs, along {_axes(axes)}; largest at {place}"
        lines.append(
            _of_seeds(f"tensile strength from a filling of {start:.3g}", "Pa", runs.tensile_strength, theirs, note)
        )
    if lines:
        notes = (
            "Tension: minus the boundaries' work over the change of volume, averaged over 1000 t0. Paper: T19, 0.6 MPa "
            "phi^1.8 for ice, along one axis, as Pamdeas, a program for dust in discs, quotes it (T19's own text was not at "
            "hand); its largest tension is at about half of the filling.",
        )
        yield section_of_lines("tensile strength", lines, notes)


def _of_seeds(quantity, unit, values, theirs, note=""):
    """Line of the mean of values, one a seed."""
    return Line(quantity, unit, *mean_and_error(values), theirs, note=note, freedom=len(values) - 1 or None)


def _axes(number_of_them):
    return "one axis" if number_of_them == 1 else f"{number_of_them} axes"


def _over(value, scale, relative=1.0):
    return None if value is None or relative is None else value / scale * relative


def _with_error(value, error):
    return number(value, error) + (f" ± {error:.2g}" if error else "")


def _scientific(value, error):
    return f"{value:.3g}" + (f" ± {error:.2g}" if error else "")
