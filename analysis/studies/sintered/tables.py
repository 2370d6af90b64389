"""Every point of the study, as tables: outcomes and structure, broken necks, the chain model beside the runs."""

import math

from ...report.beside_paper import number
from ...report.section import Column, Section
from . import paper
from .bouncing import chain_grains, predicted_ratio
from .lines import probability
from .results import LAW, POINT, same

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
        Column("contacts", lambda r: _pair(r["contacts"])),
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
        "gyration of the largest, contacts a grain at the start; mean and standard error."
    )
    return Section("all points", columns, records, intro=intro)


_STRUCTURE = ("largest", "second", "fragments", "gyration_radius", "contacts")


def necks_section(results):
    """Section of broken necks; None without sintered runs."""
    records = tuple(
        {
            **_parameters(point),
            "energy_ratio": point.energy_ratio,
            "cut_per_grain": _known(point.means["cut_per_grain"]),
            "paper": paper.FIT[0] * point.energy_ratio ** paper.FIT[1],
            "by_rolling": _known(point.means["by_rolling"]),
            **{
                name: _known(point.means[f"part_{name}"])
                for name in ("kinetic", "elastic", "rolling_friction", "sliding_friction", "necks")
            },
        }
        for point in results.points
        if point.neck
    )
    columns = (
        *_POINT,
        Column("E_k/E_sint", lambda r: f"{r['energy_ratio']:.3g}"),
        Column("N_cut/N_t", lambda r: _pair(r["cut_per_grain"])),
        Column("paper's fit", lambda r: f"{r['paper']:.2g}"),
        Column("by rolling", lambda r: _pair(r["by_rolling"])),
        Column("kinetic", lambda r: _pair(r["kinetic"]), long="kinetic [K(0)]"),
        Column("elastic", lambda r: _pair(r["elastic"]), long="elastic [K(0)]"),
        Column("roll. fr.", lambda r: _pair(r["rolling_friction"]), long="rolling friction [K(0)]"),
        Column("slid. fr.", lambda r: _pair(r["sliding_friction"]), long="sliding friction [K(0)]"),
        Column("necks", lambda r: _pair(r["necks"]), long="breaking of necks [K(0)]"),
    )
    return Section("broken necks and the energy at the end", columns, records) if records else None


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
