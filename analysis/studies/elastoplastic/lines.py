"""Our numbers beside A24's, as lines of tables."""

import numpy as np

from ...report.beside_paper import Line
from ...statistics import mean_and_error
from ...theory.aggregates import bulk_modulus, cpe_coordination
from ...theory.andrews import Spheres, restitution, stress_if_rigid
from . import paper
from .size_fit import errors_of_design
from .velocity_fit import degenerate_curve, fitted_sizes, moduli_errors_of_design, reduced_radius

MEGA = 1e6
# A24 gives neither errors nor the list of its sizes; with ten seeds at each of these its fit has about the errors
# that our scatter would give such a set.
PAPER_RADII = (40, 50, 60, 70, 80)
# Its moduli are from these sizes and velocities (Figs. 8, 9), also with ten seeds each.
PAPER_MODULI_RADII, PAPER_VELOCITIES = (40, 80), tuple(10.0 ** (0.1 * i) for i in range(8))


def compare(results):
    """List of (heading, [Line]) of results.Results: a section for each filling and subject."""
    found = []
    for factor, filling in results.by_filling.items():
        title = f"filling {factor:g}"
        velocity = filling.size_fit.velocity
        if filling.size_fit.reason is None:
            found.append((f"{title}: size dependence at {velocity:.4g} m/s", _size_lines(filling)))
        found.append((f"{title}: d_max at {velocity:.4g} m/s", _d_max_lines(results, filling)))
        if filling.velocity_fit.reason is None:
            found.append((f"{title}: yield stress and reduced Young's modulus", _moduli_lines(results, filling)))
        found.append((f"{title}: elastic constants and coordination", _constant_lines(results, filling)))
    return found


def _is_papers(filling):
    """Whether the line was fitted at A24's velocity."""
    return abs(filling.size_fit.velocity / paper.VELOCITY - 1.0) < 1e-3


def _paper_errors(filling):
    """{name: error} that the paper's line should have, from our scatter of d_max at that velocity; {}
    without."""
    at = filling.points.velocity == filling.size_fit.velocity
    own, number = filling.points.raw_d_scatter[at], filling.points.number[at]
    known = np.isfinite(own)
    line = paper.line(filling.factor)
    if not known.any() or line is None or not _is_papers(filling):
        return {}
    freedom = number[known] - 1
    scatter = np.sqrt(np.average(own[known] ** 2, weights=freedom)) / filling.grain_radius
    return errors_of_design(scatter, PAPER_RADII, paper.SEEDS, *line)


def _size_lines(filling):
    fit, lines = filling.size_fit, []
    expected = _paper_errors(filling)
    c1, c2 = (paper.line(filling.factor) or (None, None)) if _is_papers(filling) else (None, None)
    printed = {
        "c1": c1,
        "c2": c2,
        "offset": paper.OFFSET.get(filling.factor) if c1 else None,
        "ratio": paper.RATIO.get(filling.factor) if c1 else None,
    }
    names = {"c1": ("c1", ""), "c2": ("c2", ""), "offset": ("delta_offset", "r"), "ratio": ("delta_max/R*", "")}
    back = "paper's value from its eqs 20, 21 with eqs 18, 19 backwards"
    for name, (quantity, unit) in names.items():
        note = back if printed[name] is not None and filling.factor != 0.4 and name in ("c1", "c2") else ""
        if name == "c1":
            note = f"{fit.runs} runs, R = {_list(fit.radii)}" + ("; " + note if note else "")
        lines.append(Line(quantity, unit, fit.values[name], fit.errors[name], printed[name], expected.get(name), note))
    for definition, other in list(filling.size_fits.items())[1:]:
        for name in ("offset", "ratio"):
            lines.append(
                Line(
                    f"{names[name][0]}, d_max {definition}",
                    names[name][1],
                    other.values[name],
                    other.errors[name],
                    printed[name],
                    expected.get(name),
                )
            )
    return lines


def _d_max_lines(results, filling):
    unit, points, lines = results.grain_radius, filling.points, []
    line = paper.line(filling.factor) if _is_papers(filling) else None
    expected = _paper_errors(filling)
    for k in np.flatnonzero(points.velocity == filling.size_fit.velocity):
        radius = points.radius[k] / unit
        theirs = line[0] * radius - line[1] if line else None
        error = _line_error(radius, filling, expected)
        fix = filling.corrections[k]
        name = f"d_max, R = {radius:g}"
        lines.append(Line(name, "r", fix.mean, fix.error, theirs, error, f"{fix.seeds} seeds; paper's value: its line"))
        if fix.corrected is not None:
            by = "of these seeds" if fix.own_slope else "of all points of this filling"
            note = (
                f"slope on the offset {fix.slope:.2f} +- {fix.slope_error:.2f} ({by}), mean offset "
                f"{fix.mean_offset:+.3f} r"
            )
            lines.append(
                Line(name + ", read off at d(0) = -2 r", "r", fix.corrected, fix.corrected_error, theirs, error, note)
            )
        lines.append(Line(name + ", less d(0) + 2 r", "r", fix.shifted, fix.shifted_error, theirs, error))
        own = results.runs(filling.factor, points.radius[k], points.velocity[k]).label_d_max / unit
        lines.append(Line(name + ", by each aggregate's own grains", "r", *mean_and_error(own), theirs, error))
    return lines


def _line_error(radius, filling, expected):
    """Error of the paper's line at one radius, from the design of PAPER_RADII."""
    if not expected:
        return None
    radii = np.array(PAPER_RADII, dtype=float)
    scatter = expected["c1"] * np.sqrt(paper.SEEDS * np.sum((radii - radii.mean()) ** 2))
    return float(np.hypot(scatter / np.sqrt(paper.SEEDS * radii.size), expected["c1"] * (radius - radii.mean())))


def _moduli_lines(results, filling):
    theirs = (paper.YIELD_STRESS.get(filling.factor), paper.YOUNG.get(filling.factor))
    expected = _paper_moduli_errors(results, filling)
    lines = []
    for name, fit in filling.velocity_fits.items():
        if fit.reason:
            continue
        note = (
            f"{fit.runs} runs, R = {_list(fit.radii)}; delta_offset = {fit.offset / results.grain_radius:.3f} r "
            f"({fit.offset_source}); chi^2 = {fit.chi_square:.1f} at {fit.freedom} degrees of freedom"
        )
        if fit.correlation is not None:
            note += f"; correlation of the two {fit.correlation:.2f}"
        for i, quantity in enumerate(("sigma_plastic", "E*")):
            notes = (note if i == 0 and not name else "", _unbounded(fit, i))
            lines.append(
                Line(
                    quantity + (f", {name}" if name else ""),
                    "MPa",
                    fit.values[i] / MEGA,
                    _scaled(fit.errors[i]),
                    _scaled(theirs[i]),
                    _scaled(expected[i]),
                    "; ".join(filter(None, notes)),
                )
            )
    fit = filling.velocity_fit
    lines += _curve_lines(results, filling)
    radius = reduced_radius(max(fit.radii) * results.grain_radius, fit.offset)
    spheres = Spheres(radius, filling.factor * results.grain_density, *fit.values)
    lines.append(
        Line(
            f"restitution of Andrews's model at {paper.VELOCITY:.4g} m/s",
            "",
            float(restitution(paper.VELOCITY, spheres)),
            note="measured: the table of outcomes",
        )
    )
    return lines


def _paper_moduli_errors(results, filling):
    """Errors [Pa] that the paper's moduli should have, from our scatter against velocity, which is taken to be the
    same at all sizes; Nones where the paper has no moduli."""
    if filling.factor not in paper.YOUNG:
        return None, None
    points = filling.points.chosen(fitted_sizes(filling.points))
    radius, velocity = (a.ravel() for a in np.meshgrid(PAPER_MODULI_RADII, PAPER_VELOCITIES))
    errors = [
        np.exp(np.polyval(np.polyfit(np.log(points.velocity), np.log(scatter), 1), np.log(velocity)))
        / np.sqrt(paper.SEEDS)
        for scatter in (points.d_scatter, points.t_scatter)
    ]
    half = reduced_radius(radius, paper.OFFSET[filling.factor]) * results.grain_radius
    moduli = paper.YIELD_STRESS[filling.factor], paper.YOUNG[filling.factor]
    return tuple(moduli_errors_of_design(moduli, velocity, half, filling.factor * results.grain_density, *errors))


def _unbounded(fit, i):
    fraction = float(np.mean(~np.isfinite(fit.resamples[:, i])))
    if not fraction > 0.01:
        return ""
    least = np.quantile(fit.resamples[:, i], 0.05, method="nearest") / MEGA
    return f"{('nothing yields', 'nothing is elastic')[i]} in {fraction:.0%} of the resamples: " + (
        "a long upper tail"
        if fit.errors[i] is not None
        else f"no upper bound, {least:.3g} MPa or more at 95 %"
        if np.isfinite(least)
        else "no bound"
    )


def _curve_lines(results, filling):
    """Ends of the curve of Fig. 10."""
    if filling.size_fit.ratio is None:
        return []
    velocity, density = filling.size_fit.velocity, filling.factor * results.grain_density

    def ends(ratio):
        sigma, _, elastic_from, young = degenerate_curve(ratio, velocity, density, 2)
        return np.array([stress_if_rigid(ratio, velocity, density), elastic_from, young]) / MEGA

    theirs = (paper.LEAST_YIELD_STRESS, paper.ELASTIC_FROM, paper.YOUNG_IF_ELASTIC)
    known = filling.factor == 0.4 and _is_papers(filling)
    names = (
        "least sigma_plastic (rigid plastic, eq 31)",
        "sigma_plastic from which nothing yields",
        "E* if nothing yields (eq 30)",
    )
    ours = ends(filling.size_fit.ratio)
    slope = (ends(filling.size_fit.ratio * 1.001) - ours) / (0.001 * filling.size_fit.ratio)
    error = filling.size_fit.errors["ratio"]
    return [
        Line(
            name,
            "MPa",
            float(ours[i]),
            None if error is None else float(abs(slope[i]) * error),
            theirs[i] / MEGA if known else None,
        )
        for i, name in enumerate(names)
    ]


def _constant_lines(results, filling):
    r, overlap, force = results.grain_radius, results.overlap, results.pull_off_force
    here = filling.factor == 0.4
    z, z_error = filling.coordination
    measured = bulk_modulus(filling.factor, z, r, overlap, force)
    lines = [
        Line(
            "K_agg (eq 41)",
            "MPa",
            filling.bulk_modulus / MEGA,
            None,
            paper.BULK_MODULUS / MEGA if here else None,
            note="closed form, no error",
        ),
        Line(
            "K_agg with the measured Z",
            "MPa",
            measured / MEGA,
            None if z_error is None else measured * z_error / z / MEGA,
            paper.BULK_MODULUS / MEGA if here else None,
        ),
    ]
    if filling.poisson[0] is not None:
        lines.append(Line("nu_agg (eq 42)", "", *filling.poisson, paper.POISSON_RATIO if here else None))
    lines.append(
        Line(
            "coordination number inside",
            "",
            z,
            z_error,
            float(cpe_coordination(filling.factor, r, overlap)),
            note="paper's value: eq 39",
        )
    )
    return lines


def _scaled(value):
    return None if value is None else value / MEGA


def _list(radii):
    return ", ".join(f"{radius:g}" for radius in radii)
