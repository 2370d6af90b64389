"""Whether the energy that is dissipated and stored until t_max depends on size (A24 section 5.3 leaves it open)."""

import numpy as np
from scipy.stats import linregress

from ...report.section import Column, Section
from ...runs.format import CHANNELS, LOST_CHANNELS
from ...statistics import mean_and_error
from ..collision_points import at_maximum

_KINDS = {
    "dissipated": LOST_CHANNELS,
    "stored": tuple(c for c in CHANNELS if c != "kinetic" and c not in LOST_CHANNELS),
}
_COLUMNS = (
    Column("filling", lambda b: f"{b['filling']:g}"),
    Column("until t_max", lambda b: b["kind"]),
    Column("pairs", lambda b: str(b["pairs"])),
    Column("of K(0) by size", lambda b: ", ".join(_per_cent(*value) for value in b["by_size"].values())),
    Column("largest less smallest size", lambda b: _per_cent(*b["change"])),
    Column("p", lambda b: f"{b['chance']:.2g}"),
)
FEWEST = 4  # pairs, for a straight line with an error


def energy_size_section(results):
    """Section of results.Results: at the velocity of the size fit; None without two sizes."""
    rows = tuple(_rows(results))
    if not rows:
        return None
    sizes = ", ".join(f"{radius:g}" for radius in sorted({radius for row in rows for radius in row["by_size"]}))
    return Section(
        "whether the energy until t_max depends on size",
        _COLUMNS,
        rows,
        intro=f"At the velocity of the size fit, R = {sizes} r: mean with standard error of the pairs of a size; change of a "
        "straight line over the pairs from the smallest to the largest size, p by Student's t that there is none.",
    )


def _rows(results):
    for factor, filling in results.by_filling.items():
        runs = results.runs(factor, velocity=filling.size_fit.velocity)
        radius = (runs.radius / runs.grain_radius).round(3)
        if radius.nunique() < 2 or len(runs) < FEWEST:
            continue
        for kind, channels in _KINDS.items():
            share = runs[[at_maximum(c) for c in channels]].sum(axis=1)
            fit, reach = linregress(radius, share), float(np.ptp(radius))
            yield {
                "filling": factor,
                "kind": kind,
                "pairs": len(runs),
                "by_size": {float(r): mean_and_error(share[radius == r]) for r in sorted(radius.unique())},
                "change": (float(fit.slope) * reach, float(fit.stderr) * reach),
                "chance": float(fit.pvalue),
            }


def _per_cent(mean, error):
    return f"{100 * mean:.1f}" + (f" +- {100 * error:.1f} %" if error else " %")
