"""Small fragments: how much of what drag changes is their mass, and how that goes with the size of the aggregates.

The hypothesis, from one pair each of 500 and 2,000 grains: at 79 m/s and more drag changes <f_gro> by keeping
small fragments from being thrown off, each of two like remnants losing half of them, and by nothing else; so that
<f_gro> and half of their mass, `remnants`, is the same at all T_vis."""

import numpy as np

from ...report.section import Column, Section
from ...statistics import resampling_error
from .curves import difference, of_other_pairs, with_error
from .impact_mean import offsets_text
from .results import MERGED, SMALL, over_offsets, picoseconds


def _size(row):
    """Cell: grains, and offsets that are not the paper's."""
    return f"{row['grains']}{offsets_text(row['offsets'])}"


def drag_section(results):
    """Section: <f_gro> with the most drag less without, the part of it that small fragments are, and the rest; None where no
    size has two T_vis."""
    rows = []
    for grains in results.sizes:
        times = [growth.viscous_time for growth in results.of_size(grains)]
        low, high = (grains, times[0]), (grains, times[-1])
        for velocity in results.growth[high].velocities if low != high else ():
            growth, small, remnants, merging = (
                difference(curves[high], curves[low], velocity)
                for curves in (results.growth, results.small, results.remnants, results.merging)
            )
            if growth is not None:
                row = {
                    "grains": grains,
                    "offsets": results.growth[high].offsets,
                    "velocity": float(velocity),
                    "growth": growth,
                }
                row |= {"remnants": remnants, "merging": merging}
                half = -0.5 * small[0], None if small[1] is None else 0.5 * small[1]
                rows.append({**row, "small": half, "T_vis": times[-1], "less": times[0]})
    if not rows:
        return None
    columns = (
        Column("grains", _size),
        Column("v [m/s]", lambda r: f"{r['velocity']:.3g}"),
        Column("T_vis [ps]", lambda r: f"{picoseconds(r['T_vis'])} less {picoseconds(r['less'])}"),
        Column("<f_gro>", lambda r: with_error(*r["growth"])),
        Column("half the small fragments", lambda r: with_error(*r["small"])),
        Column("the rest", lambda r: with_error(*r["remnants"])),
        Column("merging", lambda r: with_error(*r["merging"]), long="cross-section of merging [pi b_max^2]"),
    )
    intro = (
        f"Difference of means over B_off. Small: fragments of {SMALL} grains or fewer, their mass over that of an aggregate. Each "
        f"of two like remnants loses half of them, a merged one all. Merging: f_gro above {MERGED:g}."
    )
    notes = (
        "Errors are joint, from resampling pairs of aggregates; rows of one size are the same pairs. Merging goes in steps of the "
        "offsets (1/12 where they are 13): an error of 0 says that the pairs agree to one.",
    )
    return Section("what drag changes", columns, tuple(rows), intro, notes)


def small_section(results):
    """Section: mass in small fragments at every size, and its exponent from each size to the next; None without two sizes."""
    rows = []
    for time in sorted({time for _, time in results.small}):
        curves = [results.small[key] for key in sorted(results.small) if key[1] == time]
        for velocity in curves[0].velocities if len(curves) > 1 else ():
            before = None
            for curve in curves:
                if curve.place(velocity) is not None:
                    row = {"T_vis": time, "velocity": float(velocity), "grains": curve.grains, "offsets": curve.offsets}
                    exponent = None if before is None else _exponent(*_alike(results, before, curve), velocity)
                    rows.append({**row, "small": curve.at(velocity), "exponent": exponent})
                    before = curve
    if not rows:
        return None
    columns = (
        Column("T_vis [ps]", lambda r: picoseconds(r["T_vis"])),
        Column("v [m/s]", lambda r: f"{r['velocity']:.3g}"),
        Column("grains", _size),
        Column("small fragments", lambda r: with_error(*r["small"], 4)),
        Column("p", lambda r: "-" if r["exponent"] is None else with_error(*r["exponent"], 2)),
    )
    intro = f"Mean over B_off of the mass in fragments of {SMALL} grains or fewer, over that of an aggregate, ~ N^-p from the size above; p is of the same offsets at both sizes."
    return Section("small fragments against size", columns, tuple(rows), intro)


def _alike(results, small, large):
    """Two Curves of small fragments at one T_vis over the offsets that both have; Nones where these don't go from 0 to 1."""
    if small.offsets == large.offsets:
        return small, large
    fewer = over_offsets(results, sorted({*small.offsets} & {*large.offsets})).small
    found = [fewer.get((curve.grains, curve.viscous_time)) for curve in (small, large)]
    return found if None not in found and found[0].offsets == found[1].offsets else (None, None)


def _exponent(small, large, velocity):
    """(p, error; None: not known) from the Curve of one size to that of a larger one; None where one of them is None."""
    if small is None:
        return None
    places = small.place(velocity), large.place(velocity)
    if None in places:
        return None
    means = small.mean[places[0]], large.mean[places[1]]
    if min(means) <= 0:
        return None
    scale = np.log(large.grains / small.grains)
    drawn = of_other_pairs(small.resamples[:, places[0]]), large.resamples[:, places[1]]
    known = np.isfinite(small.error[places[0]]) and np.isfinite(large.error[places[1]])
    with np.errstate(invalid="ignore", divide="ignore"):
        error = resampling_error(np.log(drawn[0] / drawn[1]) / scale) if known else None
    return float(np.log(means[0] / means[1]) / scale), error
