"""<f_gro> of larger aggregates, extrapolated from two smaller sizes.

The hypothesis: at one velocity and T_vis <f_gro>(N) = f_inf + c N^-p. What differs between sizes is what leaves near the
surface: p = 1/3 for a layer of a certain number of grains in depth, p = 1/2 as head-on collisions of 500 and 2,000 grains
have it (their lost mass halves). Both are shown, so that runs of larger aggregates can refuse one or both."""

import numpy as np

from ...report.section import Column, Section
from ...statistics import resampling_error
from . import paper
from .results import picoseconds
from .threshold import threshold_velocity

EXPONENTS = (1 / 2, 1 / 3)  # p


def extrapolation_weight(small, large, grains, exponent):
    """Weight w of [f(large) - f(small)] in f(grains) = f(large) + w [f(large) - f(small)], if f = f_inf + c N^-exponent.

    >>> round(extrapolation_weight(500, 2000, 10_000, 0.5), 3)
    0.553
    """
    of_small, of_large, of_grains = (n**-exponent for n in (small, large, grains))
    return (of_large - of_grains) / (of_small - of_large)


def extrapolate(small, large, grains, exponent):
    """(velocities (V,) [m/s] that both have, <f_gro> (V,) of aggregates of `grains` grains, resamples (B, V)) from the
    results.Growth of two sizes at one T_vis."""
    weight = extrapolation_weight(small.grains, large.grains, grains, exponent)
    ours, theirs = _common(small.velocities, large.velocities)
    # The two sizes are independent pairs of aggregates, though their resamples came from the same random numbers.
    of_small = np.roll(small.resamples[:, ours], 1, axis=0)
    mean = (1 + weight) * large.mean[theirs] - weight * small.mean[ours]
    return large.velocities[theirs], mean, (1 + weight) * large.resamples[:, theirs] - weight * of_small


def size_section(results):
    """Section of <f_gro> and v_fra against size, measured where there are runs, and extrapolated from the two smallest
    sizes to the others and to the paper's; None without two sizes."""
    if len(results.sizes) < 2:
        return None
    small, large, *others = results.sizes
    records = []
    for time in sorted({growth.viscous_time for growth in results.growth.values()}):
        if (small, time) in results.growth and (large, time) in results.growth:
            pair = results.growth[small, time], results.growth[large, time]
            for grains in (*others, *({paper.GRAINS} - set(others))):
                records += _records(pair, results.growth.get((grains, time)), grains)
    intro = f"From {small} and {large} grains by <f_gro> = f_inf + c N^-p, beside runs where there are any."
    notes = (
        "Errors are joint over velocities, from resampling pairs of aggregates; the sizes are independent of each other.",
        "diff: measured less extrapolated, in both errors. Rows of one T_vis are the same pairs and not independent.",
    )
    return Section("extrapolated to larger aggregates", _COLUMNS, tuple(records), intro, notes)


def _records(pair, measured, grains):
    """Rows of one size and T_vis: <f_gro> at every velocity, then v_fra."""
    drawn = [extrapolate(*pair, grains, exponent) for exponent in EXPONENTS]
    velocities = drawn[0][0]
    error_of = resampling_error if all(growth.has_errors for growth in pair) else _unknown
    base = {"T_vis": pair[0].viscous_time, "grains": grains}
    for k, velocity in enumerate(velocities):
        found = [(mean[k], error_of(resamples[:, k])) for _, mean, resamples in drawn]
        own = None if measured is None else np.flatnonzero(np.abs(measured.velocities / velocity - 1) < 1e-6)
        known = own is not None and len(own)
        value = (measured.mean[own[0]], measured.error[own[0]]) if known else None
        yield {**base, **_record(f"<f_gro> at {velocity:.3g} m/s", found, value)}
    found = [
        (threshold_velocity(velocities, mean), error_of(threshold_velocity(velocities, resamples)))
        for _, mean, resamples in drawn
    ]
    value = (measured.v_fra, measured.v_fra_error) if measured is not None and measured.v_fra is not None else None
    yield {**base, **_record("v_fra [m/s]", found, value)}


def _record(quantity, extrapolated, measured):
    """One row; extrapolated: [(value, error)] of EXPONENTS, measured: (value, error) or None. Unknown numbers: None."""
    value, error = (None, None) if measured is None else (_finite(measured[0]), _finite(measured[1]))
    record = {"quantity": quantity, "measured": value, "error": error}
    for name, (expected, its_error) in zip(_NAMES, extrapolated):
        expected, its_error = _finite(expected), _finite(its_error)
        both = None if None in (error, its_error) else float(np.hypot(error, its_error))
        known = both and None not in (value, expected)
        record |= {name: expected, f"{name}_error": its_error}
        record[f"{name}_difference"] = (value - expected) / both if known else None
    return record


def _unknown(_):
    return None


def _finite(value):
    return float(value) if value is not None and np.isfinite(value) else None


def _common(first, second):
    """Places in two rising arrays of velocities that are in both."""
    keys = [np.round(velocities, 6) for velocities in (first, second)]
    return [np.flatnonzero(np.isin(own, other)) for own, other in (keys, keys[::-1])]


def _with_error(value, error):
    if value is None:
        return "-"
    digits = 3 if abs(value) < 10 else 1
    return f"{value:.{digits}f}" + (f" +- {error:.{digits}f}" if error is not None else "")


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
