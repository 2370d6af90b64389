"""Our numbers beside S17's, as lines of tables: compacted aggregates in the plane. A group is (heading, [Line], (notes)) of
results.Results."""

from ...report.beside_paper import Line
from ...statistics import ratio_of_two, student_chance
from . import paper
from .words import beside, broken_lines, fraction_line, limits_line, name_of, probability, sticking_line


def contacts(results):
    """Fig. 6."""
    lines = []
    growths = sorted({point.growth_velocity for point in results.main()})
    for growth in growths if any(growths) else ():
        most = max(
            results.main(growth_velocity=growth), key=lambda point: point.runs
        )  # those of one V_g share aggregates
        name = f"V_g = {growth:g} m/s" if growth else "BCCA"
        note = f"paper: {paper.CONTACTS_SAID}; {most.runs} seeds"
        lines.append(Line(f"contacts a grain, {name}", "", *most.means["contacts"], note=note))
    notes = (
        "Our compacted aggregates are two BCCA clusters of 512 grains that have collided at V_g; the paper doesn't say from what its "
        "own start.",
    )
    return "contacts of compacted aggregates (Fig. 6)", lines, notes


def at_growth_velocity(results):
    """Figs 9 and 13."""
    lines = []
    for point in results.main(
        growth_velocity=paper.UNSINTERED_COMPACTED, velocity=paper.UNSINTERED_COMPACTED, neck=0.0
    ):
        lines.append(sticking_line(point))
    for growth, least in paper.COMPACTED:
        for point in results.main(growth_velocity=growth, velocity=growth):
            if point.neck:
                bounces = least is not None and point.neck >= least
                expected = "only bouncing" if bounces else ("sticking" if least is None else "bouncing and sticking")
                theirs = 1.0 if bounces else (0.0 if least is None else None)
                lines.append(_bounces(point, expected, theirs))
    notes = ("The outcome depends on the contacts a grain (section 5.5), which are given above.",)
    return "compacted aggregates at V_c = V_g (Figs 9, 13)", lines, notes


def at_any_velocity(results):
    """Fig. 10."""
    lines = [sticking_line(point) for point in _points(results, paper.COMPACTED_STICKING)]
    lines += [_bounces(point, "bouncing", 1.0) for point in _points(results, paper.COMPACTED_BOUNCING)]
    lines += broken_lines(results.main(growth_velocity=1.0, neck=0.7), "sticking efficiency")
    said = "fragmentation above 30 m/s (section 5.2)"
    lines += [limits_line(point, said, 0.0, 0.5) for point in _points(results, paper.COMPACTED_BROKEN)]
    notes = (
        "The paper's five runs of a compacted aggregate are five orientations of one; ours are of so many aggregates, so that they "
        "scatter more if aggregates do.",
    )
    return "compacted aggregates at other velocities (Fig. 10)", lines, notes


def beside_bcca(results):
    """Fig. 15: broken necks and fragments of compacted aggregates beside those of BCCA ones at the same beta and velocity."""
    lines = []
    for point in results.main(neck=0.7):
        found = results.main(growth_velocity=0.0, neck=0.7, velocity=point.velocity)
        if not point.growth_velocity or not found:
            continue
        bcca = found[0]
        runs = min(point.runs, bcca.runs)
        pair = ratio_of_two(point.means["cut_per_grain"], bcca.means["cut_per_grain"])
        if pair[1]:
            note = f"paper: the same at one E_k/E_sint; {point.runs} and {bcca.runs} seeds"
            lines.append(beside(f"N_cut/N_t over BCCA's, {name_of(point)}", "", pair, 1.0, runs, note))
        lines += _fragments(point, bcca, runs)
    notes = (
        "'Data for all types of aggregates showed the same dependence' and 'more compacted aggregates produced fewer fragments' (section "
        "5.3). diff* and p take the paper's ratio to scatter as ours.",
    )
    return "compacted aggregates beside BCCA ones (Fig. 15)", lines, notes


def _fragments(point, bcca, runs):
    """[Line] of the mass in fragments less that of BCCA aggregates, where one of them has any."""
    (mean, error), (theirs, their_error) = point.means["fragments"], bcca.means["fragments"]
    if max(mean, theirs) == 0.0 or not error or not their_error:
        return []
    said = "fewer" if point.growth_velocity in paper.FEWER_FRAGMENTS else "almost as many"
    both = (error**2 + their_error**2) ** 0.5
    chance = student_chance((mean - theirs) / both, runs - 1)
    note = f"paper: {said} (section 5.3); p = {chance:.2g} that there is no difference"
    return [Line(f"mass in fragments less BCCA's, {name_of(point)}", "", mean - theirs, both, note=note)]


def _points(results, chosen):
    """[Point] of beta = 0.7 in the plane at each (V_g, V_c)."""
    return [
        point
        for growth, velocity in chosen
        for point in results.main(growth_velocity=growth, velocity=velocity, neck=0.7)
    ]


def _bounces(point, expected, theirs):
    note = f"paper: {expected}; ours {probability(point.bouncing, point.runs)} bounce, {point.sticking} stick"
    return fraction_line("bounces", point, point.bouncing, theirs, note)
