"""The outcomes on a grid, made from the model, and their fast look-up."""

from dataclasses import replace
from functools import lru_cache
from pathlib import Path

import numpy as np
import pandas
from scipy.spatial import cKDTree

from ..arguments import FLAG, NAMES, NOT_NEGATIVE, PATH, WrongArgument, number, numbers, one_of, shown, takes
from ..theory import GRAIN_RADIUS, ICE, MATERIALS
from ..theory.pair_constants import GRAIN_RADII
from .columns import breaking_velocity
from .neighbours import MARGIN, NEAR, ONE_CONTACT, Neighbours
from .outcome_table import INSIDE, Axis, OutcomeTable, read_outcomes
from .rules import KEPT, KINDS, OF_KIND, change, largest_after
from .variables import CLOSE_PACKED, GROWN, LEFT, STRUCTURES

FOLDER = Path(__file__).resolve().parents[1] / "gallery" / "atlas"
RUNS_FILE = FOLDER / "runs.csv"
SIZES, RATIOS = np.geomspace(64, 4096, 7), np.geomspace(1 / 64, 1.0, 4)  # of the runs
FILLINGS = {GROWN: (0.002, 0.02, 0.1, 0.2, 0.3, 0.4, 0.48), CLOSE_PACKED: (0.25, 0.3, 0.4, 0.5, 0.56)}
VELOCITY = Axis("velocity", "log10", np.append(np.geomspace(1e-6, 0.08, 11)[:-1], np.geomspace(0.08, 26.0, 20)))
# Beyond the runs only what is slow is known: the nodes there are few.
BEYOND_SIZES = np.array([1, 8, *SIZES, *(8.0 ** np.arange(5, 9))])
BEYOND_RATIOS = np.append(64.0 ** np.arange(-4, -1), RATIOS)
SMALLEST, LARGEST = GRAIN_RADII
RADIUS = f"{{}} of {SMALLEST:g} to {LARGEST:g} [m]", lambda x: (x >= SMALLEST) & (x <= LARGEST)
GRAINS = numbers(right=("{} >= 1", lambda x: (x >= 1) & (x < np.inf)))
PROBABILITIES, ERRORS = (tuple(f"{what}_{kind}" for kind in KINDS) for what in ("p", "error"))
MOSTLY = 0.5  # inside: below it the errors of the nearest data say nothing
TOUCHING = "p_touching"
INTERVALS = "largest_low", "largest_high", "filling_after_low", "filling_after_high"
GAINING = "largest", "largest_low", "largest_high"
COLUMNS = (*PROBABILITIES, *ERRORS, TOUCHING, *LEFT, *OF_KIND, "inside", "runs")
ABOUT = """Outcomes of collisions of two dust aggregates: the collision atlas.
Made by the contact-law suite, version {version}, from {runs} runs; licence: GPL-2.0-or-later. To cite: CITATION.cff of the repository.
Of {structure}.
Axes: velocity over v_break = (E_break/m0)^(1/2) of the grains (ice of 0.1 um: {ice:.4g} m/s), number of grains of the larger aggregate,
mass of the smaller over the larger, filling factor (of a sphere of radius (5/3)^(1/2) R_g; mean by mass of both){axis}.
Columns: p_...: probabilities of the outcomes, sum 1 (rules: analysis/atlas/rules.py), of collisions in which the aggregates touch,
{impact} and averaged over orientations; error_...: their 90 % half widths,
by the decided runs, and by what undecided ones may become; p_touching: of pairs with b < 1, those that touch; largest, second: mass of the
two largest pieces over the total; fragment_index: n of dN/dm ~ m^-n of all pieces but the largest; filling_after: of the largest piece;
where that is the outcome, gain_mass_transfer, loss_erosion: mass that the larger aggregate gains, loses (half its own at most) over the smaller one's,
largest_fragmentation: the largest piece over the larger aggregate{intervals}; inside: 1 within the convex hull of the runs
in ln velocity, ln grains, ln mass_ratio and filling, or {margin:g} of their scatter beyond at most; 0 farther beyond, where values are those of the
nearest node within; runs: number of runs within {near:g} of the scatter{near_impact}. Between nodes: multilinear in the scaled coordinates (pieces better as
second (1 + mass_ratio)/mass_ratio and c = largest (1 + mass_ratio) - 1, where that is above 0 c/mass_ratio); the last axis is the fastest.
Slow collisions: all {sure} fitted runs with a kinetic energy below {energy:.3g} E_break stuck; anything else has a chance of {most:.2g} there at most (95 %).
Slower ones than any run are inside where they would be with that energy; below {contact:.2g} E_break, what making and breaking one contact
dissipates, all runs stuck, and sticking is taken to hold at any size within the axes (error 0; filling_after is then a guess where runs is 0).
Not in it: spins before the collision, sintering, drag, charges, grains of unlike size."""

OF_STRUCTURE = {
    GROWN: "aggregates that grew grain by grain or cluster by cluster, and compressed ones; close-packed ones have a table of their own",
    CLOSE_PACKED: "close-packed aggregates (CPE: a dense packing with grains taken out), which bounce several times as often as compressed ones of\ntheir filling",
}
AVERAGED = dict(
    axis="",
    impact="averaged over impact parameters up to the sum of the radii (5/3)^(1/2) R_g, uniform in b^2,",
    intervals="",
    near_impact=",\nat any impact parameter",
)
OF_IMPACT = dict(
    axis=", square of the impact parameter\nb in units of the sum of these radii",
    impact="at that impact parameter",
    intervals="; _low, _high: ends of the intervals that hold 90 % of such collisions,\nfor the largest piece of those that leave more than one",
    near_impact=", of b^2 too",
)


def outcomes_file(structure, of_impact):
    """Path of the atlas's table of outcomes of variables.STRUCTURES, averaged over impact parameters or at each one."""
    own = "" if structure == GROWN else f"-{structure}"
    return FOLDER / f"outcomes{own}{'-impact' if of_impact else ''}.txt"


def outcome_axes(structure, of_impact):
    """[Axis] of that table; of one impact parameter: sizes and mass ratios of the runs alone."""
    sizes, ratios = (SIZES, RATIOS) if of_impact else (BEYOND_SIZES, BEYOND_RATIOS)
    axes = VELOCITY, Axis("grains", "log10", sizes), Axis("mass_ratio", "log10", ratios)
    axes += (Axis("filling", "linear", np.array(FILLINGS[structure])),)
    return (*axes, Axis("impact_square", "linear", np.linspace(0.0, 1.0, 5))) if of_impact else axes


def outcome_grid(model, structure, version, upto=1.0):
    """OutcomeTable of a model.Model of variables.STRUCTURES, averaged over impact parameters uniform in b^2 up to `upto`; None: for each one, with
    INTERVALS."""
    averaged = upto is not None
    axes, columns = outcome_axes(structure, not averaged), COLUMNS if averaged else (*COLUMNS, *INTERVALS)
    points, near = _nodes(axes), Neighbours(model.runs)
    inside = near.beyond(points) <= MARGIN
    if not inside.any():
        raise ValueError(f"{len(model.runs)} runs: no node of the grid is within them; must be more")
    own = points[inside]
    chances, widths = model.probabilities(own, upto)
    found = model.remains.means(own, chances, upto)
    found[[*PROBABILITIES, *ERRORS]] = np.hstack([chances, widths])
    found[TOUCHING] = model.touching(own, upto)
    if not averaged:
        found = found.join(model.remains.intervals(own)[list(INTERVALS)])
    values = np.empty((len(points), len(columns)))
    values[inside] = found.reindex(columns=columns)
    values[~inside] = values[inside][_nearest(axes, points[~inside], own)]
    # An eroded aggregate loses less than runs of a smaller mass ratio, which count here too, lose over their projectile's mass.
    loss = columns.index("loss_erosion")
    values[:, loss] = np.minimum(values[:, loss], (1 - KEPT) / points.mass_ratio)
    values[:, columns.index("inside")], values[:, columns.index("runs")] = inside, near.within(points, averaged)
    about = ABOUT.format(
        version=version,
        runs=len(model.runs),
        structure=OF_STRUCTURE[structure],
        ice=breaking_velocity(ICE, GRAIN_RADIUS["ice"]),
        margin=MARGIN,
        near=NEAR,
        sure=model.slow.number,
        energy=model.slow.energy,
        most=model.slow.most,
        contact=ONE_CONTACT,
        **(AVERAGED if averaged else OF_IMPACT),
    )
    return OutcomeTable(axes, columns, values.reshape(*(len(a.nodes) for a in axes), -1), tuple(about.splitlines()))


def _nodes(axes):
    """DataFrame of variables() of all nodes, the last axis fastest."""
    mesh = np.meshgrid(*(axis.nodes for axis in axes), indexing="ij")
    return pandas.DataFrame({"impact_square": 0.5} | {a.name: values.ravel() for a, values in zip(axes, mesh)})


def _nearest(axes, points, others):
    """Row (n,) of the nearest of others, in steps of the grid."""
    place = lambda own: np.column_stack([axis.position(own[axis.name]) for axis in axes])
    return cKDTree(place(others)).query(place(points))[1]


@lru_cache
def _table(file, maxwell):
    """An OutcomeTable with pieces in the smaller aggregate's mass, GAINING by rules.change(): sticking gives 1 and bouncing 0 at every mass ratio, and
    nothing loses more than there is."""
    table = read_outcomes(file)
    table = table.maxwell() if maxwell else table
    mesh = np.meshgrid(*(axis.nodes for axis in table.axes), indexing="ij", sparse=True)
    ratio = {axis.name: nodes for axis, nodes in zip(table.axes, mesh)}.get("mass_ratio")
    if ratio is None:  # which lookup() says
        return table
    values = table.values.copy()
    for k, name in enumerate(table.columns):
        if name in GAINING:
            values[..., k] = change({"mass_ratio": ratio, "largest": values[..., k]})
        elif name == "second":
            values[..., k] *= (1 + ratio) / ratio
    return replace(table, values=values)


@takes(
    velocity=numbers(right=NOT_NEGATIVE),
    projectile=GRAINS,
    target=GRAINS,
    material=one_of(*MATERIALS),
    filling=numbers(right=("{} > 0 and at most 1", lambda x: (x > 0) & (x <= 1))),
    grain_radius=number(RADIUS),
    maxwell=FLAG,
    impact=numbers(right=("{} from 0 to 1", lambda x: (x >= 0) & (x <= 1))),
    columns=NAMES,
    file=PATH,
    structure=one_of(*STRUCTURES),
)
def outcome(
    velocity,
    projectile,
    target,
    filling,
    material="ice",
    grain_radius=None,
    maxwell=False,
    impact=None,
    columns=None,
    file=None,
    structure=None,
):
    """{column: array} of what becomes of collisions of two aggregates, from the atlas's tables, analysis/gallery/atlas/outcomes.txt (with an impact
    parameter outcomes-impact.txt), or another file; its head says what the columns are.

    velocity [m/s] (maxwell: root mean square of a Maxwell distribution of speeds), projectile and target: numbers of grains, filling: volume
    filling factor, impact: parameter over the sum of the radii (5/3)^(1/2) R_g (None: averaged, uniform in its square); arrays that broadcast.
    material: ice or silicate, grain_radius [m] (None: 1e-7 of ice, 6e-7 of silicate, as collide() has it): v_break follows from these, and is
    all that they change; the runs' grains had 1e-7, and rolling and sliding, which go otherwise with the radius, are not scaled. columns: only these.
    structure: grown (as None; by hits of grains and clusters, and compressed) or close-packed, of which the tables are.
    Ends of intervals (`largest_low`, ...) are of the runs that leave more than one piece: `largest`, of all, may be outside. `inside` is 1 within
    the data, less where the answer is an extrapolation: at 0 it is that of the nearest data. Below MOSTLY, 1/2, errors
    and the ends of intervals are NaN. ValueError for what cannot be, one line."""
    given = {"velocity": velocity, "projectile": projectile, "target": target, "filling": filling}
    given |= {} if impact is None else {"impact": impact}
    try:
        np.broadcast(*given.values())
    except ValueError:
        shapes = ", ".join(str(np.shape(each)) for each in given.values())
        raise WrongArgument(f"{', '.join(given)}: have shapes {shapes}; must broadcast") from None
    projectile, target = np.broadcast_arrays(np.asarray(projectile, dtype=float), np.asarray(target, dtype=float))
    large, small = np.maximum(projectile, target), np.minimum(projectile, target)
    radius = GRAIN_RADIUS[material] if grain_radius is None else grain_radius
    speed = np.asarray(velocity, dtype=float) / breaking_velocity(MATERIALS[material], radius)
    square = {} if impact is None else {"impact_square": np.square(impact, dtype=float)}
    if file and structure:
        raise WrongArgument(
            f"file = {shown(file)}: must be left out with a structure, which says which of the atlas's files"
        )
    table = _table(file or outcomes_file(structure or GROWN, impact is not None), maxwell)
    ratio, asked = small / large, columns
    if columns is not None and "second" in columns:
        asked = (*columns, "largest")  # which bounds it
    found = table.lookup(asked, velocity=speed, grains=large, mass_ratio=ratio, filling=filling, **square)
    for name in set(GAINING) & set(found):
        found[name] = np.asarray(largest_after(found[name], ratio))
    if "second" in found:
        most = np.minimum(found["largest"], 1 - found["largest"])
        found["second"] = np.asarray(np.minimum(found["second"] * ratio / (1 + ratio), most))
    for name in {*ERRORS, *INTERVALS} & set(found):
        found[name][found[INSIDE] < MOSTLY] = np.nan
    return {name: values for name, values in found.items() if columns is None or name in (*columns, INSIDE)}
