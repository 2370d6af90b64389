"""CPE aggregates beside spheres cut out of compressed cells, at the same filling, size and velocity."""

from dataclasses import dataclass

import numpy as np
from scipy.stats import ttest_ind

from ...report.section import Column, Section
from ...runs.collect import Scene
from ...runs.format import LOST_CHANNELS
from ...statistics import mean_and_error, scatter
from ..collision_points import HEAD_ON_ICE, at_maximum, collision_point
from ..collision_sections import energy_section, outcome_section, return_section
from ..definition import Study
from .measure import COLUMNS, measure

KINDS = {0: "CPE", 1: "compressed"}


@dataclass(frozen=True)
class Comparison:
    """One quantity at one filling and velocity [m/s]: cpe and compressed (mean, standard error, pairs), and the chance p of
    such a difference of the means by Welch's t; None where one of them has no scatter."""

    nominal: float
    velocity: float
    quantity: str
    unit: str
    cpe: tuple
    compressed: tuple
    p: float | None

    @property
    def ratio(self):
        """(compressed over CPE, its standard error); (value, None) where an error is missing."""
        (a, ea, _), (b, eb, _) = self.cpe, self.compressed
        value = b / a if a else float("nan")
        known = a and None not in (ea, eb) and b
        return value, abs(value) * float(np.hypot(ea / a, eb / b)) if known else None


@dataclass(frozen=True)
class Results:
    """table (a row a run), comparisons ([Comparison] where both kinds have run), points ([CollisionPoint] of each kind)."""

    table: object
    comparisons: list
    points: list


def quantities(runs):
    """[(name, unit, values (n,))] of a table of runs, that are compared; lengths in grain radii, times in ns."""
    lost = {name: 100 * runs[at_maximum(name)] for name in LOST_CHANNELS}
    return [
        ("contacts of a grain", "", runs.coordination),
        ("filling", "", runs.filling),
        ("d_max", "r", runs.d_max / runs.grain_radius),
        ("t_max after the touch", "ns", 1e9 * runs.t_max),
        ("largest return speed", "of v", runs.return_speed.fillna(0.0) / runs.velocity),
        ("sliding until t_max", "% of K(0)", lost["slidingDissipation"]),
        ("rolling until t_max", "% of K(0)", lost["rollingDissipation"]),
        ("twisting until t_max", "% of K(0)", lost["twistingDissipation"]),
        ("all that is lost until t_max", "% of K(0)", sum(lost.values())),
    ]


def results(table):
    """Results of a table of runs (measure.COLUMNS)."""
    comparisons, points = [], []
    for (nominal, velocity), runs in table.groupby([table.nominal.round(6), table.velocity.round(6)]):
        kinds = {kind: own for kind, own in runs.groupby("compressed")}
        for kind, own in kinds.items():
            points.append(collision_point({"kind": KINDS[kind], "nominal": nominal, "velocity": velocity}, own))
        if len(kinds) < 2:
            continue
        for (name, unit, cpe), (*_, cut) in zip(quantities(kinds[0]), quantities(kinds[1])):
            both = [np.asarray(values, dtype=float) for values in (cpe, cut)]
            scattered = all(scatter(values) > 0 for values in both)
            p = float(ttest_ind(*both, equal_var=False).pvalue) if scattered else None
            means = [(*mean_and_error(values), len(values)) for values in both]
            comparisons.append(Comparison(float(nominal), float(velocity), name, unit, *means, p))
    return Results(table, comparisons, points)


def sections(found):
    """Sections of the comparison, then what collisions of each kind do."""
    if found.comparisons:
        rows = tuple({**vars(each), "ratio": each.ratio} for each in found.comparisons)
        notes = (
            "Errors: standard errors over the pairs; p: Welch's t. Rows of one filling and velocity are the same runs.",
            "Both kinds have the same radius and, within 1 %, the same filling factor; contacts differ. d is from the "
            "centres of mass, as in A24.",
        )
        yield Section("CPE and compressed aggregates", _COLUMNS, rows, notes=notes)
    parameters = (
        Column("aggregates", lambda b: b["kind"]),
        Column("filling", lambda b: f"{b['nominal']:g}"),
        Column("v [m/s]", lambda b: f"{b['velocity']:.4g}"),
    )
    for make in (outcome_section, return_section, energy_section):
        section = make(found.points, parameters)
        if section is not None:
            yield section


def _mean(values):
    mean, error, number = values
    return f"{mean:.4g}" + (f" +- {error:.2g}" if error else "") + f" ({number})"


def _ratio(values):
    value, error = values
    return f"{value:.3g}" + (f" +- {error:.1g}" if error else "")


_COLUMNS = (
    Column("filling", lambda r: f"{r['nominal']:g}"),
    Column("v [m/s]", lambda r: f"{r['velocity']:.4g}"),
    Column("quantity", lambda r: r["quantity"] + (f" [{r['unit']}]" if r["unit"] else "")),
    Column("CPE (pairs)", lambda r: _mean(r["cpe"])),
    Column("compressed (pairs)", lambda r: _mean(r["compressed"])),
    Column("ratio", lambda r: _ratio(r["ratio"])),
    Column("p", lambda r: "-" if r["p"] is None else f"{r['p']:.2g}"),
)

STUDY = Study(
    question="Were close-packed and extracted (CPE) aggregates a fair stand-in for compressed ones in Arakawa et al. (2024)? The same "
    "collision with CPE aggregates and with spheres cut out of compressed cells, which is how Oshiro et al. (2025) make theirs.",
    title="Collisions of CPE and of compressed aggregates",
    scene=Scene(
        name="A24's scene, or one of compressed aggregates",
        values=HEAD_ON_ICE,
        numbers=("velocity",),
        measured=("compressed", "nominal", "radius", "pair"),
    ),
    columns=COLUMNS,
    measure=measure,
    results=results,
    sections=sections,
)
