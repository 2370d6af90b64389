"""The comparison with A22: the sections of the report."""

import numpy as np

from ...report.beside_paper import section_of_lines
from ...report.section import Section
from ...statistics import RESAMPLES
from .lines import compare
from .offset_shift import offset_shift_sections
from .results import picoseconds, rows_of
from .size_dependence import fewer_offsets_sections, predicted_section, size_section
from .small_fragments import drag_section, small_section

LEGEND = (
    f"error: standard error from the scatter of the seeds (bootstrap of pairs of aggregates, {RESAMPLES} resamples, joint "
    "where numbers come from the same pairs; otherwise of the mean); -: one seed only.",
    "An error from n seeds is itself uncertain by the fraction [2 (n - 1)]^(-1/2): 0.7 of it for two, 0.4 for four.",
    "diff: (ours - paper)/error. diff*: in units of both errors, where the paper's could be told. p: the chance of such a "
    "difference* (of diff where there is no diff*) by Student's t, with one degree of freedom less than pairs of aggregates.",
    "The paper has one run of each parameter set and states no errors: its numbers are taken to scatter as one seed of ours, by our "
    "error times the root of the number of pairs.",
    "Means over B_off count the pairs of aggregates that have all of its offsets.",
)


def sections(results):
    """Sections of results.Results: one for each subject, with an honest read as notes."""
    for heading, lines, notes in compare(results):
        yield section_of_lines(heading, lines, notes)
    for make in (drag_section, small_section, size_section, predicted_section):
        if (section := make(results)) is not None:
            yield section
    yield from fewer_offsets_sections(results)
    yield from offset_shift_sections(results)
    yield Section("how to read the tables", notes=LEGEND)


def remarks(results):
    """Lines that say what could not be told, and why."""
    table = results.table
    if not results.growth:
        yield "no means over B_off: no size, T_vis and velocity has runs from B_off = 0 to 1"
    apart = int((~table.met).sum())
    if apart:
        yield f"in {apart} of {len(table)} runs the aggregates passed each other without touching: f_gro = 0"
    for key, growth in results.growth.items():
        scene = f"{growth.grains} grains, {picoseconds(growth.viscous_time)} ps"
        alone = growth.velocities[np.isnan(growth.error)]
        if len(alone):
            yield f"no errors at {scene}, {_listed(alone)} m/s: one seed at every B_off"
        counted, there = int(growth.numbers.sum()) * len(growth.offsets), len(rows_of(table, key))
        if counted < there:
            offsets = f"{len(growth.offsets)} offsets"
            yield f"{scene}: {there - counted} of {there} runs are of pairs without all {offsets}, or of others, and are in no mean over B_off"
    closed = ", ".join(
        f"{worst:.2g} at {grains} grains" for grains, worst in table.groupby("grains").closure.max().items()
    )
    yield f"the energy ledger of every run closes, of K(0), to {closed} or better"
    if not np.isfinite(table.formed.astype(float)).any():
        yield "no numbers of connections and disconnections: the runs have not recorded them"


def _listed(velocities):
    return ", ".join(f"{velocity:.3g}" for velocity in velocities)
