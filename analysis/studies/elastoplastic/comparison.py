"""The comparison with A24: the sections of the report."""

from ...report.beside_paper import section_of_lines
from ...report.section import Column, Section
from ...statistics import RESAMPLES
from ..collision_sections import energy_section, outcome_section, return_section
from .beside_model import model_section
from .energy_by_size import energy_size_section
from .lines import compare
from .zone_sections import zone_sections

LEGEND = (
    f"error: standard error from the scatter of the seeds (bootstrap, {RESAMPLES} resamples of the pairs of "
    "aggregates; a pair is the same at all velocities).",
    "diff: (ours - paper)/error. The paper gives no errors; its points scatter as ours, over ten seeds each.",
    "diff*: in units of both errors, the paper's estimated from our scatter (ten seeds at R = 40, 50, 60, 70, 80; for "
    "the moduli at R = 40, 80 and eight velocities).",
    "p: chance of diff from our scatter alone, Student's t with as many degrees of freedom as the error has.",
    "sigma_plastic and E*: least squares over delta_max and tau_max at all velocities, weight 1/s^2 of a run, s the "
    "standard deviation over the seeds of its point, smoothed over velocity; these weights are our choice.",
    "all three together: least squares over d_max and t_max of all sizes and velocities with delta_offset free.",
)
_POINT = (
    Column("filling", lambda b: f"{b['filling']:g}"),
    Column("R [r]", lambda b: f"{b['radius']:g}"),
    Column("v [m/s]", lambda b: f"{b['velocity']:.4g}"),
)


def sections(results):
    """Sections of results.Results: one for each filling and subject, how collisions end, where the energy goes."""
    for heading, lines in compare(results):
        yield section_of_lines(heading, lines)
    for filling in results.by_filling.values():
        beside = model_section(results, filling)
        if beside:
            yield beside
    yield from zone_sections(results)
    yield Section("how to read the tables", notes=LEGEND)
    yield outcome_section(results.bounces, _POINT)
    returned = return_section(results.bounces, _POINT)
    if returned:
        yield returned
    by_size = energy_size_section(results)
    if by_size:
        yield by_size
    yield energy_section(results.bounces, _POINT)


def remarks(results):
    """Lines that say what could not be fitted, and why, and what was decided."""
    for filling in results.by_filling.values():
        for fit in (filling.size_fit, filling.velocity_fit, filling.joint):
            if fit.reason:
                yield f"not fitted: {fit.reason}"
    late = int(results.table.exceeded.sum())
    if late:
        yield f"in {late} of {len(results.table)} runs d grows beyond its first maximum later; the first is taken"
