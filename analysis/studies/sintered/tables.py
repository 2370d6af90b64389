"""Every point of the study, as tables: outcomes and structure, broken necks, energies, fits, the chain model beside the runs."""

import math

from ...report.beside_paper import number
from ...report.section import Column, Section
from . import paper
from .bouncing import chain_grains, predicted_ratio
from .measure import EARLY, TIMES
from .results import LAW, POINT, same
from .words import probability

_POINT = (
    Column("", lambda r: "plane" if r["planar"] else "space"),
    Column("V_g", lambda r: f"{r['growth_velocity']:g}" if r["growth_velocity"] else "BCCA"),
    Column("beta", lambda r: f"{r['neck']:g}"),
    Column("V_c [m/s]", lambda r: f"{r['velocity']:.3g}"),
    Column("else", lambda r: _special(r)),
    Column("seeds", lambda r: str(r["runs"])),
)


def points_section(results):
    """Section with one row a point: outcomes, efficiency, structure."""
    columns = (
        *_POINT,
        Column("sticks", lambda r: _probability(r, "sticking")),
        Column("bounces", lambda r: _probability(r, "bouncing")),
        Column("largest", lambda r: _pair(r["largest"])),
        Column("second", lambda r: _pair(r["second"])),
        Column("fragments", lambda r: _pair(r["fragments"])),
        Column("R_g/R", lambda r: _pair(r["gyration_radius"])),
        Column("start", lambda r: _pair(r["initial_radius"]), long="R_g/R at the start"),
        Column("contacts", lambda r: _pair(r["contacts"])),
        Column("loops", lambda r: _pair(r["loops_at_start"]), long="loops at the start"),
    )
    records = tuple(
        {
            **_parameters(point),
            "sticking": point.sticking,
            "bouncing": point.bouncing,
            **{name: _known(point.means[name]) for name in _STRUCTURE},
        }
        for point in results.points
    )
    intro = (
        "Fractions of the mass in the largest and second piece and in pieces lighter than a quarter (S17's fragments), radius of "
        "gyration of the largest, that of an aggregate at the start, contacts a grain and independent loops at the start; mean and "
        "standard error."
    )
    return Section("all points", columns, records, intro=intro)


_STRUCTURE = ("largest", "second", "fragments", "gyration_radius", "initial_radius", "contacts", "loops_at_start")


def necks_section(results):
    """Section of broken necks; None without sintered runs."""
    records = tuple(
        {
            **_parameters(point),
            "energy_ratio": point.energy_ratio,
            "cut_per_grain": _known(point.means["cut_per_grain"]),
            "paper": paper.FIT[0] * point.energy_ratio ** paper.FIT[1],
            "by_rolling": _known(point.means["by_rolling"]),
            "cut_energy": _known(point.means["cut_energy"]),
            **{name: _known(point.means[f"part_{name}"]) for name in _PARTS},
        }
        for point in results.points
        if point.neck
    )
    columns = (
        *_POINT,
        Column("E_k/E_sint", lambda r: f"{r['energy_ratio']:.3g}"),
        Column("N_cut/N_t", lambda r: _pair(r["cut_per_grain"])),
        Column("paper's fit", lambda r: f"{r['paper']:.2g}"),
        Column("over ours", lambda r: _over(r["paper"], r["cut_per_grain"])),
        Column("by rolling", lambda r: _pair(r["by_rolling"])),
        Column("kinetic", lambda r: _pair(r["kinetic"]), long="kinetic [K(0)]"),
        Column("elastic", lambda r: _pair(r["elastic"]), long="elastic [K(0)]"),
        Column("roll. fr.", lambda r: _pair(r["rolling_friction"]), long="rolling friction [K(0)]"),
        Column("slid. fr.", lambda r: _pair(r["sliding_friction"]), long="sliding friction [K(0)]"),
        Column("necks", lambda r: _pair(r["necks"]), long="breaking of necks [K(0)]"),
        Column("N E_sint", lambda r: _pair(r["cut_energy"]), long="N_cut E_sint [K(0)]"),
    )
    return Section("broken necks and the energy at the end", columns, records) if records else None


_PARTS = ("kinetic", "elastic", "rolling_friction", "sliding_friction", "necks")


def energy_section(results):
    """Section of the energies after several times; None where no run is long enough for one."""
    times = tuple(f"left_{number}" for number in TIMES)
    early = tuple(f"part_{name}_{EARLY}" for name in (*_PARTS, "stretching"))
    records = tuple(
        {**_parameters(point), **{name: _known(point.means[name]) for name in times + early}}
        for point in results.points
        if any(point.means[name] is not None for name in times)
    )
    heads = ("kinetic", "elastic", "roll. fr.", "slid. fr.", "necks", "contacts")
    columns = (
        *_POINT,
        *(
            Column(f"left {n}", lambda r, name=name: _pair(r[name]), long=f"kinetic and elastic after {n} periods")
            for n, name in zip(TIMES, times)
        ),
        *(
            Column(head, lambda r, name=name: _pair(r[name]), long=f"{head} after {EARLY}")
            for head, name in zip(heads, early)
        ),
    )
    intro = (
        f"In K(0): kinetic and elastic energy after so many periods of the stretching vibration (1.22 ns), then the parts after {EARLY}; "
        "at the end of runs in which nothing could meet or break any more before; -: not all runs of the point are so long."
    )
    return Section("the energy in time", columns, records, intro=intro) if records else None


def fits_section(results):
    """Section of the fits of broken necks to several selections of runs, S17's first; None without a fit."""
    amplitude, exponent = paper.FIT
    records = [
        {
            "planar": planar,
            "viscoelasticTime": drag,
            "selection": name,
            **{key: getattr(fit, key) for key in ("runs", "points", "empty", "seeds", "lowest", "highest")},
            **{
                f"{of}_{key}": [getattr(law, key), getattr(law, f"{key}_error")]
                for of, law in (("means", fit.means), ("counts", fit.counts))
                for key in ("amplitude", "exponent")
            },
        }
        for (planar, drag), laws in results.fits.items()
        for name, fit in laws.items()
    ]
    columns = (
        Column("", lambda r: "plane" if r["planar"] else "space"),
        Column(
            "runs of",
            lambda r: r["selection"]
            + (f", T_vis = {r['viscoelasticTime'] * 1e12:g} ps" if r["viscoelasticTime"] else ""),
        ),
        Column("runs", lambda r: str(r["runs"])),
        Column("points", lambda r: str(r["points"]) + (f" ({r['empty']} without)" if r["empty"] else "")),
        Column("E_k/E_sint", lambda r: f"{r['lowest']:.2g} to {r['highest']:.2g}"),
        *(
            Column(f"{key}, {of}", lambda r, name=f"{of}_{key}": _pair(r[name]))
            for of in ("means", "counts")
            for key in ("amplitude", "exponent")
        ),
    )
    intro = (
        f"The paper: amplitude {amplitude:g}, exponent {exponent:g}, of BCCA aggregates with beta = 0.7 and compacted ones. means: least "
        "squares of the logarithms of the points' means over all runs, without points in which no neck broke (given in brackets). counts: "
        "maximum likelihood of Poisson counts, of all runs. Errors from resampling seeds, which are the same in all points; they don't "
        "hold what the law leaves out: beside them stands how much the numbers change with the selection."
    )
    heading = "broken necks, N_cut/N_t = amplitude (E_k/E_sint)^exponent (Fig. 15)"
    return Section(heading, columns, tuple(records), intro=intro) if records else None


def _over(theirs, ours):
    return "-" if not ours or not ours[0] else f"{theirs / ours[0]:.2g}"


def bouncing_section(results):
    """Section of the chain model: F_c/F_max beside the fraction of runs that bounce; None without sintered runs."""
    records = tuple(
        {
            **_parameters(point),
            "bouncing": point.bouncing,
            "grains": chain_grains(point),
            "ratio": predicted_ratio(point),
            "loops": None if point.growth_velocity else predicted_ratio(point, paper.LOOP_GRAINS),
        }
        for point in results.points
        if point.neck
    )
    columns = (
        *_POINT,
        Column("N", lambda r: number(r["grains"])),
        Column("F_c/F_max", lambda r: f"{r['ratio']:.2f}"),
        Column("with N = 22", lambda r: "-" if r["loops"] is None else f"{r['loops']:.2f}"),
        Column("model", lambda r: "bounces" if _decisive(r) < 1 else "sticks"),
        Column("bounces", lambda r: _probability(r, "bouncing")),
    )
    intro = (
        "S17 eqs 14 to 19: bouncing where F_c/F_max < 1. N from the contacts a grain (eq 16) for compacted aggregates, from "
        "L = 100 R for BCCA ones, which form loops on impact: N = 22 decides there. The model knows nothing of fragmentation. "
        "Ratio 0: three contacts a grain or more, where eq 17 diverges."
    )
    return Section("bouncing beside the chain model (Fig. 17)", columns, records, intro=intro) if records else None


def _decisive(record):
    return record["ratio"] if record["loops"] is None else record["loops"]


def _parameters(point):
    return {name: getattr(point, name) for name in (*POINT, "runs")}


def _special(record):
    parts = []
    if abs(record["criticalRolling"] / 2e-10 - 1) > 2e-3:
        parts.append(f"xi = {record['criticalRolling'] * 1e10:g} A")
    if record["viscoelasticTime"]:
        parts.append(f"T_vis = {record['viscoelasticTime'] * 1e12:g} ps")
    if not record["cut"]:
        parts.append("held")
    if not same(record["sliding_factor"], LAW["sliding_factor"]):
        parts.append("W07's k_s" if record["sliding_factor"] == 1 else f"k_s {record['sliding_factor']:g} times W07's")
    return ", ".join(parts)


def _probability(record, name):
    return probability(record[name], record["runs"])


def _known(pair):
    return None if pair is None else list(pair)


def _pair(pair):
    if pair is None or not math.isfinite(pair[0]):
        return "-"
    mean, error = pair
    return number(mean, error) + (f" +- {error:.1g}" if error else "")
