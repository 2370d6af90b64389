"""Our numbers beside S17's, as lines of tables, each group with what it can and cannot tell: what becomes of the aggregates."""

from scipy.stats import fisher_exact

from ...report.beside_paper import Line
from ...statistics import mean_and_error, student_chance, wilson
from . import paper
from .energy_lines import broken, energy
from .words import beside, beside_limits, limits, name_of, probability

NO_ERRORS = "The paper prints no errors: diff* and p take its mean of five runs to scatter as ours. In diff it is taken as exact."


def compare(results):
    """Yields (heading, [Line], (notes)) of results.Results."""
    for group in (_efficiency, _growth, _gyration, _bounces, _loops, _compacted, energy, broken):
        yield group(results)


def _bcca(results, neck, velocity):
    found = results.main(growth_velocity=0.0, neck=neck, velocity=velocity)
    return found[0] if found else None


def _efficiency(results):
    lines = []
    for neck, velocity, least, most, said in paper.STICKING_EFFICIENCY:
        point = _bcca(results, neck, velocity)
        if point is not None:
            mean, error = point.means["largest"]
            stands = beside_limits(mean, error, point.runs, least, most)
            note = f"paper: {said}, read as {limits(least, most)}: {stands}; {point.runs} seeds"
            lines.append(Line(f"sticking efficiency, {name_of(point)}", "", mean, error, note=note))
    for point in results.main(growth_velocity=0.0, neck=0.7):
        if point.velocity > 1.01 * paper.BROKEN_ABOVE:
            note = f"paper: above 10 m/s approximately {paper.BROKEN_EFFICIENCY:g} (section 5.2); {point.runs} seeds"
            quantity = f"sticking efficiency above 10 m/s, {name_of(point)}"
            lines.append(beside(quantity, "", point.means["largest"], paper.BROKEN_EFFICIENCY, point.runs, note))
    lines += _paired(
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


def _paired(results, column, quantity, first, second, said, unit=""):
    """[Line] of the mean difference of a column between two points of the same seeds; [] without such seeds."""
    values = results.paired(column, first, second)
    if not len(values):
        return []
    mean, error = mean_and_error(values)
    note = f"{said}; seed by seed, {len(values)} seeds"
    if error:
        note += f", p = {student_chance(mean / error, len(values) - 1):.2g} that there is none"
    return [Line(quantity, unit, mean, error, note=note)]


def _growth(results):
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


def _gyration(results):
    lines = []
    for other in (0.0, 0.2):
        name = f"beta = {other:g}" if other else "unsintered"
        for velocity in (paper.SLOW, 15.0, 20.0, 30.0, 50.0):
            said = "paper: above 0" if velocity < 10 else "paper: below 0"
            if velocity < 10 and other:
                said = "paper: says nothing"
            points = ({"neck": neck, "velocity": velocity} for neck in (0.7, other))
            quantity = f"R_g/R of the largest piece, beta = 0.7 less {name}, {velocity:.3g} m/s"
            lines += _paired(results, "gyration_radius", quantity, *points, f"{said} (Fig. 8)")
    notes = (
        "The paper: unsintered aggregates are the smallest below 10 m/s, those of beta = 0.7 above, because of fragmentation "
        "(section 5.1).",
    )
    return "gyration radius of BCCA aggregates (Fig. 8)", lines, notes


def _bounces(results):
    lines = []
    point = _bcca(results, 0.7, 10.0)
    if point is not None:
        bounced, runs = paper.BOUNCES
        low, high = wilson(bounced, runs)
        chance = fisher_exact([[bounced, runs - bounced], [point.bouncing, point.runs - point.bouncing]])[1]
        note = (
            f"ours {probability(point.bouncing, point.runs)}, paper {probability(bounced, runs)}: 2 of 5 alone allows {low:.2f} to "
            f"{high:.2f}; Fisher's exact p = {chance:.2g}"
        )
        lines.append(_fraction("bounces", point, point.bouncing, bounced / runs, note))
    point = _bcca(results, 0.7, paper.SLOW)
    if point is not None:
        note = f"paper: all stick; ours {probability(point.sticking, point.runs)}"
        lines.append(_fraction("sticks", point, point.sticking, 1.0, note))
    notes = (
        "Bouncing is two large pieces, each of one aggregate to nine tenths (measures.outcome): separation at the new contacts, as "
        "in section 5.4. Parts torn off at sintered necks, and merged bodies that break, are fragments.",
    )
    return "bouncing of BCCA aggregates (section 5.1)", lines, notes


def _loops(results):
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


def _compacted(results):
    lines = []
    for growth, least in paper.COMPACTED:
        points = results.main(growth_velocity=growth, velocity=growth)
        for point in points:
            if point.neck:
                bounces = least is not None and point.neck >= least
                expected = "only bouncing" if bounces else ("sticking" if least is None else "bouncing and sticking")
                note = f"paper: {expected}; ours {probability(point.bouncing, point.runs)} bounce"
                theirs = 1.0 if bounces else (0.0 if least is None else None)
                lines.append(_fraction("bounces", point, point.bouncing, theirs, note))
    notes = (
        "Our compacted aggregates are two BCCA clusters of 512 grains that have collided at V_g; the paper doesn't say from what its "
        "own start. Their contacts a grain, on which the outcome depends (section 5.5), are in the table of all points.",
    )
    return "compacted aggregates at V_c = V_g (Fig. 13)", lines, notes


def _fraction(what, point, number, theirs, note):
    """Of the runs of a point, those that do what is said."""
    return Line(f"fraction that {what}, {name_of(point)}", "", number / point.runs, None, theirs, None, note)
