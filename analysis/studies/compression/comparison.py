"""The comparison with K13: the sections of the report, with what each can't tell."""

from ...report.beside_paper import Line, section_of_lines
from ...report.section import Column, Section
from . import paper
from .any_filling import beyond_sections
from .channel_sections import channel_sections
from .paired import changes
from .shown import PARAMETERS, LogarithmicLine, chance_text, label, line_of_seeds, with_error

FIT_NOTES = (
    "P: the work of the grains on the boundaries over the change of volume, which is the virial (K13 eq 21) averaged over every "
    "step.",
    "P0 and n: least squares of the logarithm of the mean over the clusters, up to a filling of 0.1, from where boundaries are "
    "slower than sound (K13 eqs 26, 27), the filling is above a free cluster's (eq 24), and in every cluster contacts connect "
    "the cell with its images along all three axes (from the states): before that a cell bears no load along some axis. "
    "Errors: jackknife over the clusters, so that they hold whatever the bins have in common; of one cluster there are none.",
    "P0 is the line continued to a filling of 1, a decade beyond the data: with n it is correlated as told. P0 with n = 3 "
    "is free of that, and is the number to compare. Its error is of the logarithm, and so is p.",
    "What this can't tell: whether n is 3 below the fitted range, which takes larger clusters and slower boundaries; and "
    "K13's own errors, which it doesn't give.",
)


def sections(results):
    """Sections of results.Results."""
    for group in results.groups:
        if group.fit.reason is None and (group.seeds > 1 or any(group is own for own in results.shown)):
            yield section_of_lines(f"compressive strength: {label(group)}", _fit_lines(group), ())
    yield _dependence(results)
    yield from _changes(results)
    yield from _silicate(results)
    yield from channel_sections(results)
    yield from beyond_sections(results)


def remarks(results):
    """Lines that say what could not be fitted, and why."""
    for group in results.groups:
        if group.fit.reason:
            yield f"not fitted: {label(group)}: {group.fit.reason}"
    worst = float(results.table.closure.max())
    yield f"the energy ledger closes to {worst:.2g} of the work of the boundaries or better in all {len(results.table)} runs"


def _fit_lines(group):
    fit = group.fit
    of_log, of_exponent = fit.errors
    note = f"{fit.runs} runs, {fit.bins} bins of the filling, {fit.between[0]:.2g} to {fit.between[1]:.2g}"
    together = "" if fit.correlation is None else f"; correlation with n {fit.correlation:+.3f}"
    freedom = fit.runs - 1 or None
    yield Line("n", "", fit.exponent, of_exponent, paper.EXPONENT, note=note, freedom=freedom)
    scales = (
        ("P0", fit.scale, of_log, "paper: E_roll/r0^3" + together),
        ("P0 with n = 3", fit.at_three, fit.at_three_error, "paper: E_roll/r0^3"),
    )
    for name, scale, error, note in scales:
        of_scale = None if error is None else scale * error
        yield LogarithmicLine(name, "Pa", scale, of_scale, group.scale, note=note, freedom=freedom)


def _dependence(results):
    records = [
        {
            **group.parameters,
            "runs": group.seeds,
            "from": group.fit.between[0],
            "exponent": group.fit.exponent,
            "exponent_error": group.fit.errors[1],
            "ratio": _over(group.fit.at_three, group.scale),
            "ratio_error": _over(group.fit.at_three, group.scale, group.fit.at_three_error),
        }
        for group in results.groups
    ]
    columns = (
        *PARAMETERS,
        Column("runs", lambda r: f"{r['runs']}"),
        Column("from filling", lambda r: f"{r['from']:.2g}"),
        Column("n", lambda r: with_error(r["exponent"], r["exponent_error"])),
        Column("P0 (n = 3) r0^3/E_roll", lambda r: with_error(r["ratio"], r["ratio_error"])),
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
        record = {**new, "parameter": parameter}
        record.update({"from": unit * old[change.name], "to": unit * new[change.name], "seeds": change.seeds})
        records.append({**record, "ratio": change.ratio, "error": change.error, "chance": change.chance})
    columns = (
        *PARAMETERS[:2],
        Column("changed", lambda r: f"{r['parameter']}: {r['from']:g} to {r['to']:g}"),
        Column("seeds", lambda r: f"{r['seeds']}"),
        Column("P r0^3/E_roll changes by", lambda r: with_error(r["ratio"], r["error"] and r["ratio"] * r["error"])),
        Column("p", lambda r: chance_text(r["chance"])),
    )
    intro = (
        "Factor, mean over the fillings that are fitted in both sets (up to 0.1), by pairs of runs that start from one cluster. "
        "K13: 1 for C_v and k_n, and for xi_crit up to 8 Å; not quite at 16 and not at 32 Å."
    )
    notes = ("p: chance of a factor as far from 1, by Student's t. Rows share the runs they are compared with.",)
    yield Section("one parameter changed, the same clusters", columns, tuple(records), intro, notes)


def _silicate(results):
    """K13 section 3.7; other grains than K13's have no numbers of a paper beside them."""
    lines = []
    for group in results.of("silicate"):
        found = group.table.filling_at_300.dropna()
        if not len(found):
            continue
        known = paper.has_k13s_grains(group.parameters)
        for source, theirs in (paper.SILICATE_FILLINGS if known else {"no paper": None}).items():
            lines.append(line_of_seeds(f"filling at 300 Pa, {source}", "", found, theirs, label(group)))
    if lines:
        notes = (
            "Grains of 0.6 um; Seizinger et al. press BPCA aggregates between walls, Guettler et al. fit experiments with a "
            "mixture of grains: their numbers as K13 gives them.",
            "What this can't tell: whether the surface energy of 0.02 J/m^2 is that of the experiments' silica.",
        )
        yield section_of_lines("silicate at 300 Pa", lines, notes)


def _over(value, scale, relative=1.0):
    return None if value is None or relative is None else value / scale * relative
