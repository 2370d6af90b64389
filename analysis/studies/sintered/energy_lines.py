"""Our numbers beside S17's, as lines of tables: where the energy goes, and which necks break."""

from ...report.beside_paper import Line
from ...runs.format import BROKEN_BONDS
from ...statistics import mean_and_error
from . import paper
from .measure import TIMES
from .words import beside, name_of


def energy(results):
    """(heading, [Line], (notes)) of Fig. 14."""
    lines = []
    for point in results.main(growth_velocity=0.0, neck=0.0, velocity=10.0):
        for name, words, theirs in (
            ("rolling_friction", "rolling friction takes", paper.ROLLING_FRACTION),
            ("stretching", "formation and breaking of contacts take", paper.DISCONNECTION_FRACTION),
        ):
            lines.append(beside(f"{words}, {name_of(point)}", "K(0)", point.means[f"part_{name}"], theirs, point.runs))
            share = point.means["rolling_of_lost" if name == "rolling_friction" else "stretching_of_lost"]
            lines.append(beside("the same, of all that is lost", "", share, theirs, point.runs, words))
    for point in results.main(growth_velocity=0.0, neck=0.2, velocity=10.0):
        said = (
            f"paper: {paper.WEAK_NECK_FRACTION:g} of 'the kinetic energy', how counted isn't said; {point.runs} seeds"
        )
        for name, words in (
            ("part_necks", "breaking of necks takes"),
            ("cut_energy", "N_cut E_sint"),
        ):
            mean, error = point.means[name]
            lines.append(Line(f"{words}, {name_of(point)}", "K(0)", mean, error, note=said))
    lines += _left(results.runs(growth_velocity=0.0, neck=0.5, velocity=10.0))
    notes = (
        "The paper says 'approximately' and prints no errors: diff is in units of ours alone; diff* and p take its five runs to scatter as "
        "ours. Formation of contacts counts as stretching here; the paper names breaking only.",
        "Contacts that form have a negative potential energy, and what they release is dissipated too: all losses exceed K(0), the "
        "elastic part is negative. The paper's parts add up to K(0); it doesn't say how it counts the potential.",
        "A neck that breaks and leaves a contact loses that contact's potential too, which is part of what breaking takes; N_cut E_sint "
        "is what the necks hold. The paper's E_k = m V_c^2/4 a grain (section 5.3) is twice K(0) a grain.",
        "The paper doesn't print the time of Fig. 14: what is left falls as long as a run goes.",
    )
    return "where the energy goes at 10 m/s (Fig. 14)", lines, notes


def _left(runs):
    """[Line] of the energy that runs of beta = 0.5 at 10 m/s have left at several times, beside the paper's number, which has none."""
    lines = []
    for number in TIMES:
        values = runs[f"left_{number}"]
        if len(values) and values.notna().all():
            quantity = f"kinetic and elastic after {number} periods, beta = 0.5, 10 m/s"
            lines.append(beside(quantity, "K(0)", mean_and_error(values), paper.UNDISSIPATED, len(values)))
    return lines


def broken(results):
    """(heading, [Line], (notes)) of the modes by which necks break."""
    lines = []
    for planar in (1, 0):
        runs = results.sintered(planar=planar)
        count = runs[list(BROKEN_BONDS)].sum()
        total = int(count.sum())
        if not total:
            continue
        others = ", ".join(f"{n.removeprefix('brokenBy').lower()} {count[n] / total:.2%}" for n in BROKEN_BONDS)
        where = "in the plane" if planar else "in space"
        note = f"{total} necks of {len(runs)} runs: {others}"
        if planar:
            note += f"; paper: more than {paper.BY_ROLLING:.0%}"
        lines.append(Line(f"necks broken by rolling, {where}", "", count["brokenByRolling"] / total, None, note=note))
    notes = ("All runs together, as the paper has it; by point in the table of broken necks.",)
    return "which mode breaks necks (section 5.3)", lines, notes
