"""d_max and t_max of every size and velocity beside A24's fitted model, with A24's own delta_offset."""

from ...report.section import Column, Section
from ...statistics import mean_and_error, student_chance
from . import paper
from .velocity_fit import predicted

_COLUMNS = (
    Column("R [r]", lambda b: f"{b['radius']:g}"),
    Column("v [m/s]", lambda b: f"{b['velocity']:.4g}"),
    Column("seeds", lambda b: str(b["seeds"])),
    Column("d_max [r]", lambda b: _value(b["d_max"], 2)),
    Column("A24's model", lambda b: f"{b['model_d_max']:.2f}"),
    Column("errors", lambda b: _errors(b["d_difference"])),
    Column("p", lambda b: _chance(b["d_chance"])),
    Column("t_max [ns]", lambda b: _value(b["t_max"], 1)),
    Column("A24's model", lambda b: f"{b['model_t_max']:.1f}"),
    Column("less it [ns]", lambda b: f"{b['t_max'][0] - b['model_t_max']:+.1f}"),
    Column("errors", lambda b: _errors(b["t_difference"])),
    Column("p", lambda b: _chance(b["t_chance"])),
    Column("tau_max [ns]", lambda b: _value(b["tau_max"], 1)),
    Column("A24's model", lambda b: f"{b['model_tau_max']:.1f}"),
)


def model_section(results, filling):
    """Section of one results.Filling; None where A24 has no fit at this filling factor."""
    factor = filling.factor
    if factor not in paper.YOUNG:
        return None
    rows = tuple(_row(filling.points, k, filling, results) for k in range(len(filling.points)))
    moduli = f"{paper.YIELD_STRESS[factor] / 1e6:g} MPa, {paper.YOUNG[factor] / 1e6:g} MPa"
    return Section(
        f"filling {factor:g}: d_max and t_max beside A24's fitted model",
        _COLUMNS,
        rows,
        intro=f"A24's model: Andrews's spheres with {moduli} and A24's delta_offset = {paper.OFFSET[factor]:g} r, turned into "
        "d_max and t_max with that offset, so that no offset of ours is in the differences. errors: the difference in our "
        "standard errors of the mean; p: its chance by Student's t with one degree of freedom less than seeds (A24's errors, "
        "which it doesn't give, not counted). tau_max: both with A24's delta_offset, so that it differs by as much as t_max. The "
        "same pairs recur at all velocities of a size: the rows are not independent.",
    )


def papers_model(results, filling, radius, velocity):
    """(d_max [m], t_max [s]) of A24's fitted model at one results.Filling that A24 fits, radius [grain radii] and velocity
    [m/s], floats or arrays; its own moduli (eqs 34, 35) and delta_offset (eqs 18, 20)."""
    factor, unit = filling.factor, results.grain_radius
    moduli = paper.YIELD_STRESS[factor], paper.YOUNG[factor]
    return predicted(
        velocity, radius * unit, unit, factor * results.grain_density, *moduli, paper.OFFSET[factor] * unit
    )


def _row(points, k, filling, results):
    factor, unit = filling.factor, results.grain_radius
    d, t = points.samples[k]
    velocity, radius = float(points.velocity[k]), float(points.radius[k])
    offset = paper.OFFSET[factor] * unit
    model_d, model_t = papers_model(results, filling, radius / unit, velocity)
    d, t = mean_and_error(d / unit), mean_and_error(t * 1e9)
    approach = 2e9 * (unit - offset) / velocity
    row = {
        "radius": round(radius / unit, 3),
        "velocity": velocity,
        "seeds": int(points.number[k]),
        "d_max": d,
        "model_d_max": float(model_d) / unit,
        "t_max": t,
        "model_t_max": float(model_t) * 1e9,
        "tau_max": (t[0] - approach, t[1]),
        "model_tau_max": float(model_t) * 1e9 - approach,
        "units": "grain radii, m/s, ns",
    }
    for name, value, model in (("d", d, row["model_d_max"]), ("t", t, row["model_t_max"])):
        known = bool(value[1])
        row[f"{name}_difference"] = (value[0] - model) / value[1] if known else None
        row[f"{name}_chance"] = (
            student_chance(row[f"{name}_difference"], len(points.samples[k][0]) - 1) if known else None
        )
    return row


def _value(pair, digits):
    mean, error = pair
    return f"{mean:.{digits}f}" + ("" if error is None else f" +- {error:.{digits}f}")


def _errors(value):
    return "-" if value is None else f"{value:+.1f}"


def _chance(value):
    return "-" if value is None else f"{value:.2g}"
