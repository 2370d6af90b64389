"""Beyond S17, as lines of tables: runs in space beside those in the plane, and runs with another rule or xi_crit beside S17's main ones. A
group is (heading, [Line], (notes)) of results.Results."""

from ...report.beside_paper import Line
from ...statistics import ratio_and_error, ratio_of_two, student_chance
from .words import name_of, other_fraction, paired_line, probability

FEWEST = 3  # runs with which a ratio says something


def in_space(results):
    """Section 6.2: each point in space beside the same in the plane."""
    lines = []
    for point in results.main(planar=0):
        if not point.neck or point.runs < FEWEST:
            continue
        for plane in results.main(growth_velocity=point.growth_velocity, neck=point.neck, velocity=point.velocity):
            lines += _necks_in_space(point, plane)
            lines.append(_bounces_in_space(point, plane))
        lines += _twisted(results, point)
    notes = (
        "Aggregates in space are not those of the plane, so that errors of both add up; p is Student's with the smaller number of runs. "
        "The ratio of N_cut/N_t has no value where no neck broke in one of them.",
    )
    return "in space beside the plane (section 6.2)", lines, notes


def _necks_in_space(point, plane):
    lines, runs = [], min(point.runs, plane.runs)
    for name, words, said in (
        ("cut_per_grain", "N_cut/N_t", "paper: the same (section 6.2); "),
        ("cut_per_touching", "N_cut over the largest number of contacts between the aggregates", ""),
    ):
        both = point.means[name], plane.means[name]
        pair = ratio_of_two(*both) if all(both) else (None, None)
        if pair[1]:
            note = f"{said}{point.runs} and {plane.runs} seeds"
            quantity = f"{words}, space over plane, {name_of(point)}"
            lines.append(Line(quantity, "", *pair, 1.0 if said else None, None, note, runs - 1))
    return lines


def _bounces_in_space(point, plane):
    chance = other_fraction(point.bouncing, point.runs, plane.bouncing, plane.runs)
    note = (
        f"in space {probability(point.bouncing, point.runs)}, in the plane {probability(plane.bouncing, plane.runs)}; paper: the same "
        f"(section 6.2); Fisher's exact p = {chance:.2g}"
    )
    difference = point.bouncing / point.runs - plane.bouncing / plane.runs
    return Line(f"fraction that bounces, space less plane, {name_of(point)}", "", difference, None, note=note)


def _twisted(results, point):
    """[Line] of the necks broken by twisting, of all of a point in space."""
    runs = results.runs(planar=0, growth_velocity=point.growth_velocity, neck=point.neck, velocity=point.velocity)
    total = int(runs.broken.sum())
    if not total:
        return []
    pair = ratio_and_error(runs.brokenByTwisting, runs.broken)
    return [
        Line(
            f"necks broken by twisting in space, {name_of(point)}",
            "",
            *pair,
            note=f"of {total} necks, {len(runs)} seeds",
        )
    ]


# What is changed: heading, {column: value}, its name, notes.
CHANGES = (
    (
        "springs held at their limits beside springs that are cut (S17 section 3.2, Wada et al. 2007)",
        {"cut": 0},
        "held",
        ("S17's rule is cut. A neck's springs break and know no limit: only contacts without a neck follow the rule.",),
    ),
    (
        "xi_crit = 30 Angstrom beside 2 (Fig. 11, section 5.5)",
        {"criticalRolling": 30e-10},
        "30 Angstrom",
        ("The paper: 'no significant change' in the sticking efficiency of BCCA aggregates (section 5.5).",),
    ),
)


def changes(results):
    """Yields the groups of CHANGES: BCCA runs with another rule or xi_crit beside S17's main ones, pair by pair."""
    for heading, values, name, notes in CHANGES:
        lines = []
        for point in results.main(growth_velocity=0.0, **values):
            where = {"neck": point.neck, "velocity": point.velocity}
            both = ({**where, **values}, where)
            said = f"{name}: {point.means['largest'][0]:.3g}"
            quantity = f"sticking efficiency, {name} less main, {name_of(point)}"
            lines += paired_line(results, "largest", quantity, *both, said)
            lines += _necks_changed(results, *both, f"N_cut/N_t, {name} over main, {name_of(point)}")
        yield heading, lines, notes


def _necks_changed(results, first, second, quantity):
    """[Line] of the ratio of broken necks of the same pairs; [] where none broke."""
    runs = [results.runs(growth_velocity=0.0, **v).set_index("packing_seed").cut_per_grain for v in (first, second)]
    shared = runs[0].index.intersection(runs[1].index)
    if len(shared) < FEWEST or not runs[1][shared].any():
        return []
    ratio, error = ratio_and_error(*(each[shared] for each in runs))
    chance = student_chance((ratio - 1) / error, len(shared) - 1) if error else None
    note = f"seed by seed, {len(shared)} seeds" + (f", p = {chance:.2g} that it is 1" if chance is not None else "")
    return [Line(quantity, "", ratio, error, note=note)]
