"""Lines of tables on the sizes of fragments."""

import numpy as np

from ...measures.fragments import cumulative_grains, cumulative_number
from ...report.beside_paper import Line
from . import paper
from .beside_one_pair import beside_one_pair
from .impact_mean import Draws, of_papers_offsets
from .measure import sizes_from_text
from .results import at_velocities, named, pairs_text
from .size_distribution import LARGEST_FITTED, SHORTEST, fitted_curves, power_law_with_errors, whole_numbers

SHOWN = (paper.VELOCITY, 100.0)  # m/s: A22 Figs 6 to 8
DECADES = (1, 10, 100, 1000, 10_000)  # grains


def fragments(results):
    lines = []
    for key, growth in results.growth.items():
        for velocity, found in results.distributions[key].items():
            if at_velocities(velocity, SHOWN):
                lines += _of_distribution(named(f"{velocity:.3g} m/s", growth), growth, velocity, found)
    if lines:
        notes = (
            f"f(N) = c N^-alpha fitted to <N_cum(<= N)>, least squares of the logarithms; small: N up to {LARGEST_FITTED:.0%} of all grains; "
            f"large: from {paper.LARGE} grains to an aggregate's, where that is a factor of {SHORTEST:g} or more. Errors joint from resampling "
            "pairs of aggregates.",
            f"The paper has alpha = 1 for all N with 6 ps and velocities around its v_fra of 50 to 60 m/s (section 4), and for N >> {paper.LARGE} "
            "with any drag (section 3.4), both by eye and for 100,000 grains; elsewhere it gives no number.",
            "Large: with 4,000 grains N is nowhere much larger than 100 and much smaller than an aggregate: a short range.",
            f"S: cross-section of all fragments; large ones: beyond {LARGEST_FITTED:.0%} of all grains. The paper: the largest fragments have most "
            "of it, but not at 100 m/s without drag.",
        )
        yield "size distribution of fragments", lines, notes


def _of_distribution(name, growth, velocity, found):
    """Lines of one SizeDistribution."""
    drag = growth.viscous_time > 0
    fitted = abs(growth.viscous_time - paper.FITTED_TIME) < 1e-16 and at_velocities(velocity, (paper.VELOCITY,))
    for label, law, theirs in (
        ("small", found.power_law, paper.EXPONENT if fitted else None),
        ("large", found.large_law, paper.EXPONENT if drag else None),
    ):
        theirs = of_papers_offsets(growth.offsets, theirs)
        if law.exponent is not None:
            yield beside_one_pair(
                f"alpha, {label}, {name}",
                "",
                law.exponent,
                law.exponent_error,
                found.pairs,
                theirs,
                f"c = {law.amplitude:.3g}",
            )
    share, error = found.large_share
    yield Line(f"large fragments' part of S, {name}", "", share, error, freedom=found.pairs - 1)


def full_size(results):
    """N_cum and Z_cum of the paper's size at 50.1 m/s, B_off^2 = 3/12, with the drag for which it has f(N) = 1/N."""
    runs = results.reference
    runs = runs[(runs.grains == paper.GRAINS) & ((runs.viscoelasticTime - paper.FITTED_TIME).abs() < 1e-16)]
    runs = runs.drop_duplicates("seed")
    if not len(runs):
        return
    total, pairs = 2 * paper.GRAINS, len(runs)
    draws, sizes = Draws(runs.seed), [sizes_from_text(text) for text in runs.fragments]
    lines = [_exponent(sizes, total, draws, runs.seed)]
    expected = fitted_curves(DECADES, total)
    for label, measure, theirs in (
        ("N_cum(<= {})", cumulative_grains, expected[1]),
        ("Z_cum(>= {})", cumulative_number, expected[0]),
    ):
        samples = np.array([measure(own, DECADES) for own in sizes], dtype=float)
        errors = draws.deviations(samples, runs.seed).std(axis=0, ddof=1) if pairs > 1 else [None] * len(DECADES)
        for number, mean, error, value in zip(DECADES, samples.mean(axis=0), errors, theirs):
            lines.append(Line(label.format(number), "", float(mean), error and float(error), float(value)))
    notes = (
        f"One offset of the 13, {pairs_text(pairs)}; the paper's eqs 35 and 37 are for the mean over B_off, so that there is no p: this shows "
        "whether the law can be right, not that it is.",
    )
    yield f"fragments at full size, 50.1 m/s, B_off^2 = 3/12, {paper.FITTED_TIME * 1e12:g} ps", lines, notes


def _exponent(sizes, total, draws, seeds):
    """Line of alpha fitted to the mean of N_cum over pairs, from 10 grains to a tenth of all."""
    numbers = whole_numbers(total)
    numbers = numbers[(numbers >= 10) & (numbers <= total // 10)]
    samples = np.array([cumulative_grains(own, numbers) for own in sizes], dtype=float)
    mean = samples.mean(axis=0)
    law = power_law_with_errors(numbers, mean, mean + draws.deviations(samples, seeds) if len(sizes) > 1 else None)
    note = (
        f"N = 10 to {total // 10}, {pairs_text(len(sizes))}; c = {law.amplitude:.3g}"
        if law.exponent
        else "nothing to fit"
    )
    return Line("alpha", "", law.exponent, law.exponent_error, paper.EXPONENT, note=note)
