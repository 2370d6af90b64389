"""The comparison with S17: the sections of the report."""

from ...report.beside_paper import section_of_lines
from ...report.section import Section
from . import beyond_lines, compacted_lines, energy_lines, lines
from .results import LAW, of_law
from .tables import bouncing_section, energy_section, fits_section, necks_section, points_section

# The groups of lines beside the paper: f(results) -> (heading, [Line], (notes)).
GROUPS = (
    *(lines.efficiency, lines.growth, lines.gyration, lines.bounces, lines.loops),
    *(
        compacted_lines.contacts,
        compacted_lines.at_growth_velocity,
        compacted_lines.at_any_velocity,
        compacted_lines.beside_bcca,
    ),
    *(energy_lines.energy, energy_lines.broken),
    beyond_lines.in_space,
)
# Those that are repeated with springs that are held at their limits.
HELD = (lines.efficiency, lines.growth, lines.gyration, lines.bounces, energy_lines.energy)
LEGEND = (
    "error: standard error of the mean over seeds, each another pair of aggregates; -: one seed only. Error bars of figures are these too.",
    "The paper has five runs a point, draws their standard deviations (2.2 times a standard error) and prints few numbers: where it prints "
    "a statement, the note says whether our mean is within it.",
    "In brackets after a probability: Wilson's 95 % interval.",
)


def sections(results):
    """Sections of results.Results: one for each subject, with an honest read as notes, then every point."""
    held = of_law(results, cut=0)
    groups = [*(group(results) for group in GROUPS), *beyond_lines.changes(results)]
    groups += [(f"springs held: {heading}", *rest) for heading, *rest in (group(held) for group in HELD)]
    for heading, found, notes in groups:
        if found:
            yield section_of_lines(heading, found, notes)
    for make in (fits_section, points_section, necks_section, energy_section, bouncing_section):
        section = make(results)
        if section is not None:
            yield section
    yield Section("how to read the tables", notes=LEGEND)


def remarks(results):
    """Lines that say what could not be told, and why."""
    table = results.table
    if results.other_sizes:
        yield f"{results.other_sizes} runs of BCCA aggregates of another number of grains are in no point and no fit"
    open_ended = int((~table.ended_by).sum())
    if open_ended:
        yield f"{open_ended} of {len(table)} runs went on to their duration: pieces may still have met or parted later"
    held = int((table.cut == 0).sum())
    if held:
        yield f"{held} runs hold springs at their limits (limit = held), which is not S17's rule: points of their own"
    softer = int((table.sliding_factor != LAW["sliding_factor"]).sum())
    if softer:
        yield f"{softer} runs have another sliding spring than S17's eqs 11 and 12 as printed: points of their own"
    for (planar, drag), laws in results.fits.items():
        if not laws and not drag:
            where = "in the plane" if planar else "in space"
            yield f"no fit of broken necks {where}: fewer than two energies with broken necks"
