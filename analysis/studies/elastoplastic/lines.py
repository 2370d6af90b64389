"""Our numbers beside A24's, as lines of tables."""

import numpy as np
from scipy.stats import chi2

from ...report.beside_paper import Line
from ...statistics import mean_and_error, pooled_scatter, scatter
from ...theory.aggregates import bulk_modulus, cpe_coordination
from ...theory.andrews import Spheres, restitution, stress_if_rigid
from . import paper
from .results import PAPER_RADII
from .size_fit import errors_of_design
from .velocity_fit import degenerate_curve, fitted_sizes, moduli_errors_of_design, reduced_radius

MEGA = 1e6
# A24's moduli are from these sizes and velocities (Figs. 8, 9), also with ten seeds each.
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
    scatter, _ = pooled_scatter(filling.points.raw_d_scatter[at] / filling.grain_radius, filling.points.number[at])
    line = paper.line(filling.factor)
    if scatter is None or line is None or not _is_papers(filling):
        return {}
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
    lines += _joint_lines(filling)
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


def _joint_lines(filling):
    """(c1, c2) together: the four numbers above are strongly correlated, so that they are one difference, not four."""
    for definition, joint in filling.differences.items():
        if joint is not None:
            name = "c1 and c2 together, chi^2(2)" + (
                "" if definition == next(iter(filling.differences)) else f", d_max {definition}"
            )
            note = (
                f"p = {joint.chance:.2g}; {joint.chance_estimated:.2g} with the scatter estimated from {joint.freedom} degrees of "
                "freedom. Both lines with our pooled scatter, A24's with ten seeds at R = 40, 50, 60, 70, 80"
            )
            yield Line(name, "", joint.chi_square, note=note)


def paper_line_at(filling, radius):
    """(A24's line, the error that it should have) at a radius [grain radii]; Nones without."""
    line = paper.line(filling.factor) if _is_papers(filling) else None
    return (
        (None, None)
        if line is None
        else (line[0] * radius - line[1], _line_error(radius, filling, _paper_errors(filling)))
    )


def _d_max_lines(results, filling):
    unit, points, lines = results.grain_radius, filling.points, []
    at = np.flatnonzero(points.velocity == filling.size_fit.velocity)
    pooled, freedom = pooled_scatter(points.raw_d_scatter[at] / unit, points.number[at])
    for k in at:
        radius = points.radius[k] / unit
        theirs, error = paper_line_at(filling, radius)
        fix = filling.corrections[k]
        name, few = f"d_max, R = {radius:g}", fix.seeds - 1
        lines.append(
            Line(name, "r", fix.mean, fix.error, theirs, error, f"{fix.seeds} seeds; paper's value: its line", few)
        )
        if pooled:
            note = f"scatter of all sizes, {pooled:.2f} r"
            lines.append(
                Line(name + ", pooled error", "r", fix.mean, pooled / np.sqrt(fix.seeds), theirs, error, note, freedom)
            )
        lines.append(Line(name + ", less d(0) + 2 r", "r", fix.shifted, fix.shifted_error, theirs, error, freedom=few))
        own = results.runs(filling.factor, points.radius[k], points.velocity[k]).label_d_max / unit
        lines.append(
            Line(name + ", by each aggregate's own grains", "r", *mean_and_error(own), theirs, error, freedom=few)
        )
    return lines + list(_offset_line(results, filling, at))


def _offset_line(results, filling, at):
    """Whether the chance offsets d(0) + 2 r, which have mean 0, have it here at all sizes (points `at`)."""
    chosen = [results.runs(filling.factor, filling.points.radius[k], filling.points.velocity[k]).offset for k in at]
    number, means = (np.array([f(each) for each in chosen], dtype=float) for f in (len, np.mean))
    pooled, _ = pooled_scatter([scatter(each) for each in chosen], number)
    if pooled:
        square = float(np.sum(number * (means / pooled) ** 2))
        listed = ", ".join(f"{mean / results.grain_radius:+.2f}" for mean in means)
        note = f"means {listed} r; p = {chi2.sf(square, len(at)):.2g} that their mean is 0"
        yield Line(f"chance offsets d(0) + 2 r of all sizes, chi^2({len(at)})", "", square, note=note)


def _line_error(radius, filling, expected):
    """Error of the paper's line at one radius, from the design of PAPER_RADII."""
    if not expected:
        return None
    radii = np.array(PAPER_RADII, dtype=float)
    scatter = expected["c1"] * np.sqrt(paper.SEEDS * np.sum((radii - radii.mean()) ** 2))
    return np.hypot(scatter / np.sqrt(paper.SEEDS * radii.size), expected["c1"] * (radius - radii.mean()))


def _moduli_lines(results, filling):
    theirs = (paper.YIELD_STRESS.get(filling.factor), paper.YOUNG.get(filling.factor))
    expected = _paper_moduli_errors(results, filling)
    lines = []
    for name, fit in filling.velocity_fits.items():
        if fit.reason:
            continue
        note = (
            f"{fit.runs} runs, R = {_list(fit.radii)}; delta_offset = {fit.offset / results.grain_radius:.3f} r "
            f"({fit.offset_source}); chi^2 = {fit.chi_square:.1f}, pairs that obey the model give {fit.expected:.1f} "
            f"(p = {fit.chance:.2g})"
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
    lines += _joint_moduli_lines(filling, theirs)
    fit = filling.velocity_fit
    lines += _curve_lines(results, filling)
    radius = reduced_radius(max(fit.radii) * results.grain_radius, fit.offset)
    spheres = Spheres(radius, filling.factor * results.grain_density, *fit.values)
    lines.append(
        Line(
            f"restitution of Andrews's model at {paper.VELOCITY:.4g} m/s",
            "",
            float(restitution(paper.VELOCITY, spheres)),
            note="with sigma and E* of the first two lines; 0 for E* = inf, so that it is known no better than E*",
        )
    )
    return lines


def _joint_moduli_lines(filling, theirs):
    """sigma, E* and delta_offset fitted together. The three hang together along a curve, and E* may have no upper bound, so
    that errors stand in the notes: no difference in units of them means anything."""
    fit = filling.joint
    if fit.reason:
        return
    note = (
        f"{fit.runs} runs of {fit.pairs} pairs, R = {_list(fit.radii)}, {fit.velocities} velocities; chi^2 = "
        f"{fit.chi_square:.1f}, pairs that obey the model give {fit.expected:.1f} (p = {fit.chance:.2g})"
    )
    if fit.paper_excess is not None:
        note += f"; A24's three values are worse by {fit.paper_excess:.1f} ({_chance(fit.paper_chance, fit)}, A24's errors not counted)"
    for i, (quantity, unit, scale) in enumerate(
        (("sigma_plastic", "MPa", MEGA), ("E*", "MPa", MEGA), ("delta_offset", "r", 1.0))
    ):
        low, high = (end / scale for end in fit.limits[i])
        limits = "" if fit.errors[i] is None else f"+- {fit.errors[i] / scale:.2g}; "
        limits += f"95 %: {low:.3g} to {high:.3g}" if np.isfinite(high) else f"95 %: {low:.3g} or more, no upper bound"
        if i < 2 and fit.unbounded[i]:
            limits += f" (none in {fit.unbounded[i]:.1%} of the resamples)"
        if i == 1 and fit.young_excess is not None:
            limits += (
                f"; with A24's E* alone chi^2 is larger by {fit.young_excess:.1f} ({_chance(fit.young_chance, fit)})"
            )
        value = (theirs[0], theirs[1], paper.OFFSET.get(filling.factor))[i]
        yield Line(
            f"{quantity}, all three together",
            unit,
            fit.values[i] / scale,
            None,
            None if value is None else value / scale,
            note="; ".join(filter(None, (limits, note if i == 0 else ""))),
        )


def _chance(value, fit):
    """A chance that was counted among resamples, which know none below one of them."""
    least = 1.0 / len(fit.resamples)
    return f"p = {value:.2g}" if value >= least else f"p < {least:.2g}"


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
        "least sigma_plastic (rigid plastic, eq 31; restates c1)",
        "sigma_plastic from which nothing yields (restates c1)",
        "E* if nothing yields (eq 30; restates c1)",
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
            note=f"the paper's {paper.BULK_MODULUS / MEGA:g} is rounded: no difference" if here else "",
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
