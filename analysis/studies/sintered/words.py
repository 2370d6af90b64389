"""What the comparison's lines say in words, and how a printed number stands beside ours."""

import numpy as np
from scipy.stats import fisher_exact

from ...report.beside_paper import Line, error_of_theirs, line_of_runs
from ...statistics import mean_and_error, student_chance, wilson
from . import paper


def name_of(point):
    """What a results.Point is of: V_g, beta, V_c."""
    beta = f"beta = {point.neck:g}" if point.neck else "unsintered"
    grown = f"V_g = {point.growth_velocity:g} m/s, " if point.growth_velocity else ""
    return f"{grown}{beta}, {point.velocity:.3g} m/s"


def probability(successes, trials):
    """'3 of 10 (0.11 to 0.60)', with Wilson's interval.

    >>> probability(0, 10)
    '0 of 10 (0.00 to 0.28)'
    """
    low, high = wilson(successes, trials)
    return f"{successes} of {trials} ({low:.2f} to {high:.2f})"


def beside_limits(mean, error, runs, least, most):
    """Whether a mean of `runs` runs is between limits (None: open), and if not how far off, in words. p: Student's, beside the limit
    as it stands, and where the paper's mean has an error as ours.

    >>> beside_limits(0.8, 0.1, 5, 0.9, 1.0)
    "outside it by 1.0 errors (p = 0.37; 0.52 if the paper's 5 runs scatter as ours)"
    >>> beside_limits(0.95, None, 1, 0.9, 1.0), beside_limits(0.8, None, 1, 0.9, 1.0)
    ('within it', 'outside it by 0.1')
    """
    off = max((least - mean) if least is not None else 0.0, (mean - most) if most is not None else 0.0, 0.0)
    if off == 0.0:
        return "within it"
    if not error:
        return f"outside it by {off:.3g}"
    alone = student_chance(off / error, runs - 1)
    both = student_chance(off / np.hypot(error, error_of_theirs(error, runs, paper.RUNS)), runs - 1)
    return f"outside it by {off / error:.1f} errors (p = {alone:.2g}; {both:.2g} if the paper's {paper.RUNS} runs scatter as ours)"


def limits(least, most):
    """'at most 0.5', '0.5 to 1'."""
    return f"at most {most:g}" if least is None else f"{least:g} to {most:g}"


def beside(quantity, unit, pair, theirs, runs, note=""):
    """Line of our (mean, error) of `runs` runs beside the paper's number."""
    return line_of_runs(quantity, unit, pair, runs, theirs, paper.RUNS, note or f"{runs} seeds")


def other_fraction(successes, trials, theirs, of):
    """Chance (Fisher's exact test) that two sets of runs with one and the same probability differ so much.

    >>> round(other_fraction(0, 5, 2, 5), 2)
    0.44
    """
    return float(fisher_exact([[theirs, of - theirs], [successes, trials - successes]])[1])


def fraction_line(what, point, number, theirs, note):
    """Line: of the runs of a point, those that do what is said."""
    return Line(f"fraction that {what}, {name_of(point)}", "", number / point.runs, None, theirs, None, note)


def paired_line(results, column, quantity, first, second, said, unit=""):
    """[Line] of the mean difference of a column between two points of the same seeds; [] without such seeds."""
    values = results.paired(column, first, second)
    if not len(values):
        return []
    mean, error = mean_and_error(values)
    note = f"{said}; seed by seed, {len(values)} seeds"
    if error:
        note += f", p = {student_chance(mean / error, len(values) - 1):.2g} that there is none"
    return [Line(quantity, unit, mean, error, note=note)]


def sticking_line(point):
    """Line of the runs of a point that stick, where all of the paper's do."""
    note = f"paper: all stick; ours {probability(point.sticking, point.runs)}"
    return fraction_line("sticks", point, point.sticking, 1.0, note)


def limits_line(point, said, least, most):
    """Line of the sticking efficiency of a point beside what the paper says in words, read as limits."""
    mean, error = point.means["largest"]
    stands = beside_limits(mean, error, point.runs, least, most)
    note = f"paper: {said}, read as {limits(least, most)}: {stands}; {point.runs} seeds"
    return Line(f"sticking efficiency, {name_of(point)}", "", mean, error, note=note)


def broken_lines(points, quantity):
    """[Line] of the sticking efficiency of those of the points that are faster than paper.BROKEN_ABOVE, beside the paper's."""
    said = f"paper: above {paper.BROKEN_ABOVE:g} m/s approximately {paper.BROKEN_EFFICIENCY:g} (section 5.2)"
    return [
        beside(
            f"{quantity}, {name_of(point)}",
            "",
            point.means["largest"],
            paper.BROKEN_EFFICIENCY,
            point.runs,
            f"{said}; {point.runs} seeds",
        )
        for point in points
        if point.velocity > 1.01 * paper.BROKEN_ABOVE
    ]
