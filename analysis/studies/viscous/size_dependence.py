"""<f_gro> of larger aggregates, extrapolated from two smaller sizes.

The hypothesis: at one velocity and T_vis <f_gro>(N) = f_inf + c N^-p. What differs between sizes is what leaves near the
surface: p = 1/3 for a layer of a certain number of grains in depth, p = 1/2 as head-on collisions of 500 and 2,000 grains
have it (their lost mass halves). Both are shown, so that runs of larger aggregates can refuse one or both."""

import numpy as np

from ...report.section import Column, Section
from ...statistics import resampling_error
from . import paper
from .curves import of_other_pairs, with_error
from .impact_mean import offsets_text
from .results import make_results, over_offsets, picoseconds, threshold_error
from .threshold import threshold_velocity

EXPONENTS = (1 / 2, 1 / 3)  # p
PREDICTED = (10_000, paper.GRAINS)  # grains: viscous-prediction.table has the first
PREDICTED_FROM = (1, 2)  # seeds of the smaller sizes behind the gallery's predictions.csv
_PAIRS = " and ".join(map(str, PREDICTED_FROM))
NOTES = (
    "Errors are joint over velocities, from resampling pairs of aggregates; the sizes are independent of each other.",
    "diff: measured less extrapolated, in both errors. Rows of one T_vis are the same pairs and not independent.",
)


def extrapolation_weight(small, large, grains, exponent):
    """Weight w of [f(large) - f(small)] in f(grains) = f(large) + w [f(large) - f(small)], if f = f_inf + c N^-exponent.

    >>> round(extrapolation_weight(500, 2000, 10_000, 0.5), 3)
    0.553
    """
    of_small, of_large, of_grains = (n**-exponent for n in (small, large, grains))
    return (of_large - of_grains) / (of_small - of_large)


def extrapolate(small, large, grains, exponent):
    """(velocities (V,) [m/s] that both have, <f_gro> (V,) of aggregates of `grains` grains, resamples (B, V)) from the
    curves.Curve of two sizes at one T_vis."""
    weight = extrapolation_weight(small.grains, large.grains, grains, exponent)
    ours, theirs = _common(small.velocities, large.velocities)
    of_small = of_other_pairs(small.resamples[:, ours])
    mean = (1 + weight) * large.mean[theirs] - weight * small.mean[ours]
    return large.velocities[theirs], mean, (1 + weight) * large.resamples[:, theirs] - weight * of_small


def size_section(results):
    """Section of growth against size, measured where there are runs of the same offsets, and extrapolated from the two smallest
    sizes to the others and PREDICTED; None without two sizes."""
    intro = "From the two smallest sizes by f = f_inf + c N^-p, beside runs where there are any of the same offsets."
    return _section("extrapolated to larger aggregates", _rows(results, PREDICTED), intro)


def predicted_section(results):
    """The same from the pairs PREDICTED_FROM of the two smallest sizes alone, of what has run; None where these are all, or where
    nothing has run."""
    intro = f"The same from the pairs {_PAIRS} of the two smallest sizes, from which predictions.csv was made before any larger ones ran."
    return _section(f"extrapolated from pairs {_PAIRS}", _of_predicted_pairs(results), intro)


def fewer_offsets_sections(results):
    """Sections for each set of fewer offsets that a larger size has: the smaller sizes at these offsets alone, extrapolated, and
    what the larger measured there."""
    for offsets in fewer_offsets(results):
        own = over_offsets(results, offsets)
        sizes = tuple(sorted({key[0] for key, growth in results.growth.items() if growth.offsets == offsets}))
        squares = ", ".join(f"{12 * square:.3g}" for square in offsets)
        intro = f"Over the same {len(offsets)} offsets at all sizes, B_off^2 = ({squares})/12: not A22's eq 29, whose numbers here are of 13."
        heading = f"extrapolated over the {len(offsets)} offsets that larger aggregates have"
        for name, rows in (
            ("", _rows(own, (), sizes, False)),
            (f", from pairs {_PAIRS}", _of_predicted_pairs(own, sizes, False)),
        ):
            section = _section(heading + name, rows, intro)
            if section is not None:
                yield section


def _section(heading, rows, intro):
    rows = tuple(rows)
    return Section(heading, _COLUMNS, rows, intro, NOTES) if rows else None


def fewer_offsets(results):
    """The sets of offsets (B_off^2, rising) that sizes beyond the two smallest have and these have not, fewest first."""
    of_small = {growth.offsets for (grains, _), growth in results.growth.items() if grains in results.sizes[:2]}
    others = {growth.offsets for (grains, _), growth in results.growth.items() if grains in results.sizes[2:]}
    return sorted(others - of_small, key=len)


def _of_predicted_pairs(results, sizes=(), head_on=True):
    """Rows from the pairs PREDICTED_FROM of the two smallest sizes alone, of what has run; none where these are all."""
    small, table = results.sizes[:2], results.table
    if set(table.seed[table.grains.isin(small)]) <= set(PREDICTED_FROM):
        return
    kept = table[~table.grains.isin(small) | table.seed.isin(PREDICTED_FROM)]
    own = make_results(kept, distributions=False)
    yield from (row for row in _rows(own, (), sizes, head_on) if row["measured"] is not None)


def _rows(results, beyond, sizes=(), head_on=True):
    """Rows of <f_gro>, v_fra and, if it is asked for, of head-on collisions; to the sizes (those with runs where there are none)
    and those beyond."""
    yield from _of_quantity("<f_gro>", results.growth, beyond, sizes, threshold=True)
    if head_on:
        yield from _of_quantity("f_gro at B_off = 0", results.head_on, beyond, sizes, threshold=False)


def _of_quantity(name, growth, beyond, sizes, threshold):
    """Rows of {(grains, T_vis): Curve}; threshold: v_fra of Growths too."""
    known = sorted({grains for grains, _ in growth})
    if len(known) < 2:
        return
    small, large, *others = known
    for time in sorted({time for _, time in growth}):
        pair = growth.get((small, time)), growth.get((large, time))
        if None in pair or pair[0].offsets != pair[1].offsets:
            continue
        for grains in sorted({*(sizes or others), *beyond}):
            measured = growth.get((grains, time))
            if measured is not None and measured.offsets != pair[0].offsets:
                measured = None
            yield from _at_velocities(name, pair, measured, grains)
            if threshold:
                yield _threshold(pair, measured, grains)


def _at_velocities(name, pair, measured, grains):
    """A row for each velocity."""
    drawn = [extrapolate(*pair, grains, exponent) for exponent in EXPONENTS]
    for k, velocity in enumerate(drawn[0][0]):
        known = all(np.isfinite(growth.error[growth.place(velocity)]) for growth in pair)
        found = [(mean[k], resampling_error(resamples[:, k]) if known else None) for _, mean, resamples in drawn]
        value = None if measured is None else measured.at(velocity)
        yield _record(f"{name} at {velocity:.3g} m/s{offsets_text(pair[0].offsets)}", pair, grains, found, value)


def _threshold(pair, measured, grains):
    """The row of v_fra."""
    found = []
    for exponent in EXPONENTS:
        velocities, mean, resamples = extrapolate(*pair, grains, exponent)
        drawn = threshold_velocity(velocities, resamples)
        error = threshold_error(drawn) if all(growth.has_errors for growth in pair) else None
        found.append((threshold_velocity(velocities, mean), error))
    value = (measured.v_fra, measured.v_fra_error) if measured is not None and measured.v_fra is not None else None
    return _record(f"v_fra [m/s]{offsets_text(pair[0].offsets)}", pair, grains, found, value)


def _record(quantity, pair, grains, extrapolated, measured):
    """One row; extrapolated: [(value, error)] of EXPONENTS, measured: (value, error) or None. Unknown numbers: None."""
    value, error = (None, None) if measured is None else (_finite(measured[0]), _finite(measured[1]))
    record = {"T_vis": pair[0].viscous_time, "grains": grains, "quantity": quantity, "measured": value, "error": error}
    for name, (expected, its_error) in zip(_NAMES, extrapolated):
        expected, its_error = _finite(expected), _finite(its_error)
        both = None if None in (error, its_error) else float(np.hypot(error, its_error))
        known = both and None not in (value, expected)
        record |= {name: expected, f"{name}_error": its_error}
        record[f"{name}_difference"] = (value - expected) / both if known else None
    return record


def _finite(value):
    return float(value) if value is not None and np.isfinite(value) else None


def _common(first, second):
    """Places in two rising arrays of velocities that are in both."""
    keys = [np.round(velocities, 6) for velocities in (first, second)]
    return [np.flatnonzero(np.isin(own, other)) for own, other in (keys, keys[::-1])]


def _with_error(value, error):
    return with_error(value, error, 3 if value is None or abs(value) < 10 else 1)


_NAMES = tuple(f"extrapolated_p1/{round(1 / exponent)}" for exponent in EXPONENTS)


def _columns_of(name):
    head = name.replace("extrapolated_p", "p = ")
    return (
        Column(head, lambda r: _with_error(r[name], r[f"{name}_error"])),
        Column("diff", lambda r: "-" if r[f"{name}_difference"] is None else f"{r[f'{name}_difference']:+.1f}"),
    )


_COLUMNS = (
    Column("T_vis [ps]", lambda r: picoseconds(r["T_vis"])),
    Column("grains", lambda r: f"{r['grains']}"),
    Column("quantity", lambda r: r["quantity"]),
    Column("measured", lambda r: _with_error(r["measured"], r["error"])),
    *(column for name in _NAMES for column in _columns_of(name)),
)
