"""Our numbers beside S17's, as lines of tables, each group with what it can and cannot tell: what becomes of BCCA aggregates. A group is
(heading, [Line], (notes)) of results.Results."""

from ...report.beside_paper import Line
from ...statistics import wilson
from . import paper
from .words import (
    beside,
    broken_lines,
    fraction_line,
    limits_line,
    name_of,
    other_fraction,
    paired_line,
    probability,
    sticking_line,
)

NO_ERRORS = "The paper prints no errors: diff* and p take its mean of five runs to scatter as ours. In diff it is taken as exact."


def _bcca(results, neck, velocity):
    found = results.main(growth_velocity=0.0, neck=neck, velocity=velocity)
    return found[0] if found else None


def efficiency(results):
    lines = []
    for neck, velocity, least, most, said in paper.STICKING_EFFICIENCY:
        point = _bcca(results, neck, velocity)
        if point is not None:
            lines.append(limits_line(point, said, least, most))
    lines += broken_lines(results.main(growth_velocity=0.0, neck=0.7), "sticking efficiency above 10 m/s")
    lines += paired_line(
        results,
        "largest",
        "fall from beta = 0.4 to 0.5 at 30 m/s",
        *({"neck": neck, "velocity": 30.0} for neck in (0.4, 0.5)),
        "paper: decreases (Fig. 11)",
    )
    notes = (
        "Limits are read from words (perfect, close to unity, rupture): a mean outside them by less than its error contradicts "
        "nothing. p beside a limit takes the limit as exact, though the paper's mean of five runs scatters too.",
        NO_ERRORS,
    )
    return "sticking efficiency of BCCA aggregates (Figs 8, 10, 11)", lines, notes


def growth(results):
    lines = []
    for (planar, neck), found in results.critical.items():
        if found is None:
            continue
        theirs = paper.CRITICAL_VELOCITIES.get(neck) if planar else None
        reached = found.velocity <= found.highest
        low, high = (f"{v:.3g}" if v <= found.highest else f"above {found.highest:g}" for v in (found.low, found.high))
        where = ("unsintered" if not neck else f"beta = {neck:g}") + (", in the plane" if planar else ", in space")
        note = f"95 %: {low} to {high} m/s; {found.seeds} seeds" + (
            "" if reached else f"; not reached at {found.highest:g}"
        )
        lines.append(
            Line(
                f"mean largest piece is half, {where}",
                "m/s",
                found.velocity if reached else None,
                None,
                theirs,
                note=note,
            )
        )
    notes = (
        "The paper's critical velocities for growth, 50 and 20 m/s (abstract), are read alike, as the velocity at which the mean "
        "sticking efficiency falls below one half; ours is even between the two velocities about it, and nothing is known above the "
        "fastest.",
    )
    return "critical velocity for growth of BCCA aggregates (abstract)", lines, notes


def gyration(results):
    lines = []
    for other in (0.0, 0.2):
        name = f"beta = {other:g}" if other else "unsintered"
        for velocity in (paper.SLOW, 15.0, 20.0, 30.0, 50.0):
            said = "paper: above 0" if velocity < 10 else "paper: below 0"
            if velocity < 10 and other:
                said = "paper: says nothing"
            points = ({"neck": neck, "velocity": velocity} for neck in (0.7, other))
            quantity = f"R_g/R of the largest piece, beta = 0.7 less {name}, {velocity:.3g} m/s"
            lines += paired_line(results, "gyration_radius", quantity, *points, f"{said} (Fig. 8)")
    notes = (
        "The paper: unsintered aggregates are the smallest below 10 m/s, those of beta = 0.7 above, because of fragmentation "
        "(section 5.1).",
    )
    return "gyration radius of BCCA aggregates (Fig. 8)", lines, notes


def bounces(results):
    lines = []
    point = _bcca(results, 0.7, 10.0)
    if point is not None:
        bounced, runs = paper.BOUNCES
        low, high = wilson(bounced, runs)
        chance = other_fraction(point.bouncing, point.runs, bounced, runs)
        note = (
            f"ours {probability(point.bouncing, point.runs)}, paper {probability(bounced, runs)}: 2 of 5 alone allows {low:.2f} to "
            f"{high:.2f}; Fisher's exact p = {chance:.2g}"
        )
        lines.append(fraction_line("bounces", point, point.bouncing, bounced / runs, note))
    point = _bcca(results, 0.7, paper.SLOW)
    if point is not None:
        lines.append(sticking_line(point))
    notes = (
        "Bouncing is two large pieces, each of one aggregate to nine tenths (measures.outcome): separation at the new contacts, as "
        "in section 5.4. Parts torn off at sintered necks, and merged bodies that break, are fragments.",
    )
    return "bouncing of BCCA aggregates (section 5.1)", lines, notes


def loops(results):
    lines = []
    point = _bcca(results, 0.7, 10.0)
    if point is not None and point.means["loops_at_start"] is not None:
        mean, error = point.means["loops_at_start"]
        note = "both aggregates together; paper: no loops in a BCCA aggregate (section 5.4)"
        lines.append(Line("independent loops at the start", "", mean, error, note=note))
        for name, words in (("loop_size", "all loops"), ("new_loop_size", "without those of the start")):
            if point.means[name] is not None:
                quantity = f"grains in loops over loops at the end, {words}, {name_of(point)}"
                lines.append(beside(quantity, "", point.means[name], paper.LOOP_SIZE, point.runs))
    notes = (
        "The paper counts 44 grains in a loop on average and takes half of them, N = 22, for eq. 18; how it finds loops, and when, isn't "
        "said. Ours: grains on a closed way of contacts, over independent loops (contacts less grains plus pieces). "
        "Our packings have loops at the start, since grains that end up between 2 R - delta_0 and 2 R apart count as touching.",
    )
    return "loops of grains (section 5.4)", lines, notes
