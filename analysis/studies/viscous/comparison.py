"""The comparison with A22: the sections of the report."""

import numpy as np

from ...report.beside_paper import section_of_lines
from ...report.section import Section
from ...statistics import RESAMPLES
from .lines import compare
from .results import picoseconds
from .size_dependence import size_section
from .small_fragments import drag_section, small_section

LEGEND = (
    f"error: standard error from the scatter of the seeds (bootstrap of pairs of aggregates, {RESAMPLES} resamples, joint "
    "where numbers come from the same pairs; otherwise of the mean); -: one seed only.",
    "An error from n seeds is itself uncertain by the fraction [2 (n - 1)]^(-1/2): 0.7 of it for two, 0.4 for four.",
    "diff: (ours - paper)/error. diff*: in units of both errors, where the paper's could be told. p: the chance of such a "
    "difference by Student's t, with one degree of freedom less than pairs of aggregates.",
    "The paper has one run of each parameter set and states no errors: its numbers scatter as one seed of ours.",
)


def sections(results):
    """Sections of results.Results: one for each subject, with an honest read as notes."""
    for heading, lines, notes in compare(results):
        yield section_of_lines(heading, lines, notes)
    for make in (drag_section, small_section, size_section):
        if (section := make(results)) is not None:
            yield section
    yield Section("how to read the tables", notes=LEGEND)


def remarks(results):
    """Lines that say what could not be told, and why."""
    table = results.table
    if not results.growth:
        yield "no means over B_off: no size, T_vis and velocity has runs from B_off = 0 to 1"
    apart = int((~table.met).sum())
    if apart:
        yield f"in {apart} of {len(table)} runs the aggregates passed each other without touching: f_gro = 0"
    for growth in results.growth.values():
        if not growth.has_errors:
            yield f"no errors at {growth.grains} grains, {picoseconds(growth.viscous_time)} ps: one seed at every B_off"
    if not np.isfinite(table.formed.astype(float)).any():
        yield "no numbers of connections and disconnections: the runs have not recorded them"
