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
from ..grains import OF_GRAINS, grains_text
from .measure import COLUMNS, measure

KINDS = {0: "CPE", 1: "compressed"}
# What the runs of a comparison have in common.
SCENES = ("nominal", "velocity", "step", "material", *OF_GRAINS)
_OF_SCENE = (
    Column("grains", grains_text),
    Column("filling", lambda r: f"{r['nominal']:g}"),
    Column("v [m/s]", lambda r: f"{r['velocity']:.4g}"),
    Column("step [t0]", lambda r: f"{r['step']:.3g}"),
)


@dataclass(frozen=True)
class Comparison:
    """One quantity of one scene (dict, the names of SCENES): cpe and compressed (mean, standard error, pairs), and the chance
    p of such a difference of the means by Welch's t; None where one of them has no scatter."""

    scene: dict
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
        ("compression from the first touch", "r", runs.compression / runs.grainRadius),
        ("d at the first touch", "r", runs.d_touch / runs.grainRadius),
        ("d_max", "r", runs.d_max / runs.grainRadius),
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
    scenes = [table[name].map("{:.9g}".format) if name != "material" else table[name] for name in SCENES]
    for _, runs in table.groupby(scenes):
        scene = {name: runs[name].iloc[0] for name in SCENES}
        kinds = {kind: own for kind, own in runs.groupby("compressed")}
        for kind, own in kinds.items():
            points.append(collision_point({"kind": KINDS[kind], **scene}, own))
        if len(kinds) < 2:
            continue
        for (name, unit, cpe), (*_, cut) in zip(quantities(kinds[0]), quantities(kinds[1])):
            both = [np.asarray(values, dtype=float) for values in (cpe, cut)]
            scattered = all(scatter(values) > 0 for values in both)
            p = float(ttest_ind(*both, equal_var=False).pvalue) if scattered else None
            means = [(*mean_and_error(values), len(values)) for values in both]
            comparisons.append(Comparison(scene, name, unit, *means, p))
    return Results(table, comparisons, points)


def sections(found):
    """Sections of the comparison, then what collisions of each kind do."""
    if found.comparisons:
        rows = tuple({**each.scene, **vars(each), "ratio": each.ratio} for each in found.comparisons)
        notes = (
            "Errors: standard errors over the pairs; p: Welch's t. Rows of one filling and velocity are the same runs.",
            "Both kinds have the same radius and, within 1 %, the same filling factor; contacts differ. d = 2 R less the "
            "distance of the halves, from the centres of mass, as in A24: at the first touch it is below 0 by about as much as "
            "it grows afterwards, so that a ratio of d_max is one of differences from a zero that no aggregate meets at. "
            "Compressions are compared from the first touch on.",
        )
        yield Section("CPE and compressed aggregates", _COLUMNS, rows, notes=notes)
    parameters = (
        Column("aggregates", lambda b: b["kind"]),
        *_OF_SCENE,
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
    *_OF_SCENE,
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
        values=dict(HEAD_ON_ICE),
        numbers=("velocity",),
        measured=("compressed", "nominal", "radius", "pair", "step", *OF_GRAINS),
    ),
    columns=COLUMNS,
    measure=measure,
    results=results,
    sections=sections,
)
