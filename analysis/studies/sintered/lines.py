"""Our numbers beside S17's, as lines of tables, each group with what it can and cannot tell."""

from ...report.beside_paper import Line
from ...runs.format import BROKEN_BONDS
from ...statistics import mean_and_error, student_chance, wilson
from . import paper


def compare(results):
    """Yields (heading, [Line], (notes)) of results.Results."""
    for group in (_efficiency, _bounces, _compacted, _energy, _broken, _fit):
        yield group(results)


def _bcca(results, neck, velocity):
    found = results.main(growth_velocity=0.0, neck=neck, velocity=velocity)
    return found[0] if found else None


def _name(point):
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


def within(mean, error, least, most):
    """Whether a mean is between limits (None: open), and if not how far off: in words.

    >>> within(0.8, 0.1, 0.9, 1.0), within(0.95, None, 0.9, 1.0)
    ('outside it by 1.0 errors', 'within it')
    """
    off = max((least - mean) if least is not None else 0.0, (mean - most) if most is not None else 0.0, 0.0)
    if off == 0.0:
        return "within it"
    return f"outside it by {off / error:.1f} errors" if error else f"outside it by {off:.3g}"


def _limits(least, most):
    if least is None:
        return f"at most {most:g}"
    return f"{least:g} to {most:g}"


def _efficiency(results):
    lines = []
    for neck, velocity, least, most, said in paper.STICKING_EFFICIENCY:
        point = _bcca(results, neck, velocity)
        if point is not None:
            mean, error = point.means["largest"]
            note = (
                f"paper: {said}, read as {_limits(least, most)}: {within(mean, error, least, most)}; {point.runs} seeds"
            )
            lines.append(Line(f"sticking efficiency, {_name(point)}", "", mean, error, note=note))
    falls = results.paired("largest", {"neck": 0.4, "velocity": 30.0}, {"neck": 0.5, "velocity": 30.0})
    if len(falls):
        mean, error = mean_and_error(falls)
        note = f"paper: decreases (Fig. 11); seed by seed, {len(falls)} seeds"
        if error:
            note += f", p = {student_chance(mean / error, len(falls) - 1):.2g} that there is none"
        lines.append(Line("fall from beta = 0.4 to 0.5 at 30 m/s", "", mean, error, note=note))
    notes = (
        "Limits are read from words (perfect, close to unity, rupture): a mean outside them by less than its error contradicts "
        "nothing.",
    )
    return "sticking efficiency of BCCA aggregates (Figs 8, 11)", lines, notes


def _bounces(results):
    lines = []
    point = _bcca(results, 0.7, 10.0)
    if point is not None:
        bounced, runs = paper.BOUNCES
        low, high = wilson(bounced, runs)
        note = (
            f"ours {probability(point.bouncing, point.runs)}, paper {probability(bounced, runs)}: 2 of 5 alone allows {low:.2f} to "
            f"{high:.2f}"
        )
        lines.append(_fraction("bounces", point, point.bouncing, bounced / runs, note))
    point = _bcca(results, 0.7, paper.SLOW)
    if point is not None:
        note = f"paper: all stick; ours {probability(point.sticking, point.runs)}"
        lines.append(_fraction("sticks", point, point.sticking, 1.0, note))
    return "bouncing of BCCA aggregates (section 5.1)", lines, ()


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


def _energy(results):
    lines = []
    point = _bcca(results, 0.0, 10.0)
    if point is not None:
        for name, words, theirs in (
            ("rolling_friction", "rolling friction takes", paper.ROLLING_FRACTION),
            ("stretching", "formation and breaking of contacts take", paper.DISCONNECTION_FRACTION),
        ):
            lines.append(_part(point, name, words, theirs))
            mean, error = point.means["rolling_of_lost" if name == "rolling_friction" else "stretching_of_lost"]
            lines.append(
                Line("the same, of all that is lost", "", mean, error, theirs, None, words, _freedom(point.runs))
            )
    point = _bcca(results, 0.2, 10.0)
    if point is not None:
        lines.append(_part(point, "necks", "breaking of necks takes", paper.WEAK_NECK_FRACTION))
    point = _bcca(results, 0.5, 10.0)
    if point is not None:
        (kinetic, first), (elastic, second) = point.means["part_kinetic"], point.means["part_elastic"]
        error = _together(first, second)
        lines.append(
            Line(
                f"kinetic and elastic at the end, {_name(point)}", "K(0)", kinetic + elastic, error, paper.UNDISSIPATED
            )
        )
    notes = (
        "The paper says 'approximately' and draws no errors: differences are in units of ours alone. Formation of contacts "
        "counts as stretching here; the paper names breaking only.",
        "Contacts that form have a negative potential energy, and what they release is dissipated too: all losses exceed K(0), the "
        "elastic part is negative. The paper's parts add up to K(0); it doesn't say how it counts the potential.",
    )
    return "where the energy goes at 10 m/s (Fig. 14)", lines, notes


def _part(point, name, words, theirs):
    mean, error = point.means[f"part_{name}"]
    return Line(
        f"{words}, {_name(point)}", "K(0)", mean, error, theirs, None, f"{point.runs} seeds", _freedom(point.runs)
    )


def _fraction(what, point, number, theirs, note):
    """Of the runs of a point, those that do what is said."""
    return Line(f"fraction that {what}, {_name(point)}", "", number / point.runs, None, theirs, None, note)


def _together(first, second):
    """Error of a sum or difference of two independent means; None where either is not known."""
    return None if first is None or second is None else (first**2 + second**2) ** 0.5


def _freedom(runs):
    return runs - 1 if runs > 1 else None


def _broken(results):
    lines = []
    for planar in (1, 0):
        runs = results.sintered(planar=planar)
        broken = runs[list(BROKEN_BONDS)].sum()
        total = int(broken.sum())
        if not total:
            continue
        others = ", ".join(f"{n.removeprefix('brokenBy').lower()} {broken[n] / total:.1%}" for n in BROKEN_BONDS)
        where = "in the plane" if planar else "in space"
        note = f"{total} necks of {len(runs)} runs: {others}"
        if planar:
            note += f"; paper: more than {paper.BY_ROLLING:.0%}"
        lines.append(Line(f"necks broken by rolling, {where}", "", broken["brokenByRolling"] / total, None, note=note))
    notes = ("All runs together, as the paper has it; by point in the table of broken necks.",)
    return "which mode breaks necks (section 5.3)", lines, notes


def _fit(results):
    lines = []
    for (planar, drag), fit in results.fits.items():
        if fit is None:
            continue
        where = ("in the plane" if planar else "in space") + (f", T_vis = {drag * 1e12:.3g} ps" if drag else "")
        known = planar and not drag
        note = f"{fit.runs} runs, {fit.points} points"
        amplitude, exponent = paper.FIT if known else (None, None)
        lines.append(Line(f"amplitude, {where}", "", fit.amplitude, fit.amplitude_error, amplitude, None, note))
        lines.append(Line(f"exponent, {where}", "", fit.exponent, fit.exponent_error, exponent, None, note))
    notes = (
        "Least squares of the logarithms of the points' means, without BCCA aggregates of beta = 0.2, as in the paper; errors "
        "from resampling seeds, the same in all points. Amplitude and exponent are correlated.",
        "Runs in which no neck broke have no logarithm and are left out; where they are many, the fit is too high at that end.",
    )
    return "broken necks, N_cut/N_t = amplitude (E_k/E_sint)^exponent (Fig. 15)", lines, notes
