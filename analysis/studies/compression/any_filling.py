"""Beyond K13: strength and coordination at any filling, structure, and the tension of stretched cells."""

import numpy as np

from ...report.beside_paper import section_of_lines
from ...report.section import Column, Section
from ...statistics import student_chance
from ...theory.aggregates import bcca_coordination
from ...theory.compression import DENSEST, compressive_strength, compressive_strength_dense, tensile_strength
from . import paper
from .curve import FILLINGS
from .measure import STRUCTURE_SCALE
from .scene import KEYS
from .shown import PARAMETERS, chance_text, label, line_of_seeds, material_text, mean_with_error, scientific, with_error

# Columns that say the same in every row of K13's grains and damping.
_OF_FIDUCIAL = ("material", "k_n", "xi_crit [Å]")


def beyond_sections(results):
    """Sections of K13's grains at any filling, of the fractal structure and of tension."""
    yield strength_section(results.of_k13s_grains)
    yield from _structure(results)
    yield from _tensile(results)


def strength_section(groups):
    """Pressure and coordination number beside the formulae, at each filling of each group, by the clusters that reach it."""
    records = [record for group in groups for record in _records(group)]
    fiducial = all(paper.has_fiducial_grains(group.parameters) for group in groups)
    columns = (
        *(column for column in PARAMETERS if not (fiducial and column.head in _OF_FIDUCIAL)),
        Column("filling", lambda r: f"{r['filling']:.3g}"),
        Column("runs", lambda r: f"{r['runs']}"),
        Column("P [Pa]", lambda r: scientific(*r["pressure"])),
        Column("over K13 eq 25", lambda r: with_error(*r["over_K13"])),
        Column(f"over T23 (phi_max = {DENSEST:g})", lambda r: with_error(*r["over_T23"])),
        Column("p", lambda r: chance_text(r["chance"])),
        Column("Z", lambda r: with_error(*r["coordination"])),
        Column("less A24 eq 45", lambda r: with_error(*r["less_A24"])),
        Column("p", lambda r: chance_text(r["coordination_chance"])),
    )
    notes = (
        ("Of ice with K13's grains and damping. " if fiducial else "")
        + "Means over the clusters that reach a filling factor, with standard errors; p: "
        "chance of a mean as far from the formula, by Student's t. Rows of one N are the same clusters.",
        "From where boundaries are slower than sound (K13 eqs 26, 27) and the cells of all clusters are spanned, as the fits; "
        "below, clusters are isolated or pressed by the boundaries' motion.",
        "A24's eq 44 is T23's formula with E_roll/r0^3 = 0.47 MPa, ice's, and T23's exponent and phi_max.",
        "What this can't tell: the formulae are for quasistatic compression; a single C_v shows it only where another one "
        "gives the same.",
    )
    return Section("strength at any filling", columns, tuple(records), notes=notes)


def _records(group):
    for k, filling in enumerate(map(float, FILLINGS)):
        there = np.isfinite(group.pressure[:, k])
        pressure, contacts = group.pressure[there, k], group.coordination[there, k]
        if not there.any() or not pressure.mean() > 0 or filling < group.fit.between[0] * (1 - 1e-9):
            continue
        over_t23 = mean_with_error(pressure / float(compressive_strength_dense(filling, group.scale)))
        away = mean_with_error(contacts - float(bcca_coordination(filling)))
        yield {
            **group.parameters,
            "filling": filling,
            "runs": int(there.sum()),
            "pressure": mean_with_error(pressure),
            "over_K13": mean_with_error(pressure / float(compressive_strength(filling, group.scale))),
            "over_T23": over_t23,
            "chance": _chance(over_t23[0] - 1.0, over_t23[1], len(pressure)),
            "coordination": mean_with_error(contacts),
            "less_A24": away,
            "coordination_chance": _chance(*away, len(contacts)),
        }


def _chance(difference, error, seeds):
    return student_chance(difference / error, seeds - 1) if error else None


def _structure(results):
    for group in results.shown:
        lines = [
            line_of_seeds(f"D at a filling of {filling:g}", "", values, _inside(filling), f"{len(values)} runs")
            for filling, values in group.dimensions().items()
        ]
        notes = (
            "Slope of N(< r) between 3 and 10 grain radii. K13's 2 holds inside the clusters, up to r0/phi, which is 10 grain "
            "radii at a filling of 0.1: there the slope is on its way to 3. K13 draws N(< r) beside lines of 2 and 3, and gives "
            "no slopes.",
        )
        if lines:
            yield section_of_lines(f"fractal structure: {label(group)}", lines, notes)


def _inside(filling):
    """K13's dimension where the scales it is taken at lie well inside the clusters (r < r0/phi); None elsewhere."""
    return paper.DIMENSION if 2.0 * STRUCTURE_SCALE[1] * filling < 1.0 else None


def _tensile(results):
    lines = []
    for key, runs in results.stretched.groupby([*KEYS, "finalFilling", "stretched_axes"], sort=True):
        found = dict(zip(KEYS, key))
        axes = key[-1]
        start = float(runs.largest_filling.mean())
        known = axes == 1
        theirs = float(tensile_strength(start, found["surfaceEnergy"], found["grainRadius"])) if known else None
        note = (
            f"{material_text(found)}, N = {found['grains']}, C_v = {found['strainRate']:g}, k_n = {found['linearDamping']:g}, "
            f"xi_crit = {found['criticalRolling'] * 1e10:.3g} Å, step {found['stepFraction']:g} t0, {len(runs)} runs, along "
            f"{_axes(axes)}; largest at {runs.tensile_filling.mean() / start:.2f} of the filling before"
        )
        quantity = f"tensile strength from a filling of {start:.3g}"
        lines.append(line_of_seeds(quantity, "Pa", runs.tensile_strength, theirs, note))
    if lines:
        notes = (
            "Tension: minus the boundaries' work over the change of volume, averaged over 1000 t0. Paper: T19, 0.6 MPa "
            "phi^1.8 for ice, along one axis, as Pamdeas, a program for dust in discs, quotes it (T19's own text was not at "
            "hand); its largest tension is at about half of the filling.",
        )
        yield section_of_lines("tensile strength", lines, notes)


def _axes(number_of_them):
    return "one axis" if number_of_them == 1 else f"{number_of_them} axes"
