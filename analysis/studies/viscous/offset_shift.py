"""By how much means over fewer offsets than the paper's differ from those over all, by the sizes that have both."""

import numpy as np

from ...report.section import Column, Section
from ...statistics import resampling_error
from .curves import with_error
from .results import over_offsets, picoseconds, threshold_error
from .size_dependence import EXPONENTS, PREDICTED_FROM, extrapolate, fewer_offsets
from .threshold import threshold_velocity


def offset_shift_sections(results):
    """A Section for each set of fewer offsets that a larger size has: means over these less means over all, of the same pairs,
    at every size that has all, and of what is extrapolated from the pairs PREDICTED_FROM."""
    for offsets in fewer_offsets(results):
        fewer = over_offsets(results, offsets)
        own = {key: growth for key, growth in results.growth.items() if set(offsets) < set(growth.offsets)}
        rows = [row for key, growth in own.items() for row in _shifts(growth, fewer.growth[key])]
        sizes = sorted(
            {grains for key, growth in results.growth.items() if growth.offsets == offsets for grains in key[:1]}
        )
        rows += [row for grains in sizes for row in _of_prediction(results, offsets, grains)]
        intro = "Fewer less all: both of the same runs, the joint error of the pairs of aggregates."
        yield Section(f"what {len(offsets)} offsets in place of all change", _COLUMNS, tuple(rows), intro)


def _shifts(every, fewer):
    """Rows of a Growth over all offsets and one over fewer of them, of the same pairs."""
    for velocity in every.velocities:
        i, j = every.place(velocity), fewer.place(velocity)
        if j is not None and every.numbers[i] == fewer.numbers[j]:
            drawn = fewer.resamples[:, j] - every.resamples[:, i] if every.numbers[i] > 1 else None
            error = None if drawn is None else resampling_error(drawn)
            values = every.mean[i], fewer.mean[j]
            yield _row(every, fewer, f"<f_gro> at {velocity:.3g} m/s", int(every.numbers[i]), *values, error)
    if every.pairs == fewer.pairs and every.v_fra is not None:
        error = threshold_error(fewer.v_fra_resamples - every.v_fra_resamples) if every.has_errors else None
        yield _row(every, fewer, "v_fra [m/s]", every.pairs, every.v_fra, fewer.v_fra, error)


def _of_prediction(results, offsets, grains):
    """Rows of what the pairs PREDICTED_FROM of the two smallest sizes give for larger aggregates, p = 1/2."""
    all_offsets = results.growth[results.sizes[0], min(time for _, time in results.growth)].offsets
    every, fewer = (over_offsets(results, own, PREDICTED_FROM).growth for own in (all_offsets, offsets))
    small, large = results.sizes[:2]
    for time in sorted(time for size, time in results.growth if size == grains):
        pairs = [(own.get((small, time)), own.get((large, time))) for own in (every, fewer)]
        if any(None in pair for pair in pairs):
            continue
        found = [extrapolate(*pair, grains, EXPONENTS[0]) for pair in pairs]
        known = all(curve.has_errors for pair in pairs for curve in pair)
        like = pairs[0][0], pairs[1][0]
        for k, velocity in enumerate(found[0][0]):
            error = resampling_error(found[1][2][:, k] - found[0][2][:, k]) if known else None
            name = f"<f_gro> at {velocity:.3g} m/s, predicted"
            yield {**_row(*like, name, like[0].pairs, found[0][1][k], found[1][1][k], error), "grains": grains}
        values = [threshold_velocity(velocities, mean) for velocities, mean, _ in found]
        drawn = [threshold_velocity(velocities, resamples) for velocities, _, resamples in found]
        error = threshold_error(drawn[1] - drawn[0]) if known else None
        yield {**_row(*like, "v_fra [m/s], predicted", like[0].pairs, *values, error), "grains": grains}


def _row(every, fewer, quantity, pairs, of_all, of_fewer, error):
    """One row; of_all, of_fewer: values (None or NaN: none)."""
    of_all, of_fewer = (float(v) if v is not None and np.isfinite(v) else None for v in (of_all, of_fewer))
    shift = None if None in (of_all, of_fewer) else of_fewer - of_all
    row = {"T_vis": every.viscous_time, "grains": every.grains, "quantity": quantity, "pairs": pairs, "all": of_all}
    row |= {"number": len(every.offsets), "fewer": of_fewer, "fewer_number": len(fewer.offsets)}
    return {**row, "shift": shift, "error": None if shift is None else error}


def _digits(row):
    return 1 if "v_fra" in row["quantity"] else 3


_COLUMNS = (
    Column("T_vis [ps]", lambda r: picoseconds(r["T_vis"])),
    Column("grains", lambda r: f"{r['grains']}"),
    Column("quantity", lambda r: r["quantity"]),
    Column("pairs", lambda r: f"{r['pairs']}"),
    Column("all", lambda r: with_error(r["all"], None, _digits(r)) + f" ({r['number']})", long="all offsets (number)"),
    Column(
        "fewer", lambda r: with_error(r["fewer"], None, _digits(r)) + f" ({r['fewer_number']})", long="fewer (number)"
    ),
    Column("fewer less all", lambda r: with_error(r["shift"], r["error"], _digits(r))),
)
