# SPDX-License-Identifier: MIT
"""What cases.json asks, out of the time series of a scene, and a results file: for adapters in Python with numpy.

An adapter has series_of(scene, materials, steps): a dict of arrays, a row for every step from 0 on, grains in the
file's order (a plane is no grain): time (n,), position, velocity, spin, torque (n, grains, 3), force (n, 3) on grain 1,
all of the same moment, mass (grains,); SI units. channels, where the code has an energy ledger: {"connection",
"disconnection", "bond breaking", "total": (n,)}. README.md says the questions in words.
"""

import json
from math import nan
from pathlib import Path

import numpy as np

ROOM = Path(__file__).resolve().parents[1]
SUITE = json.loads((ROOM / "cases.json").read_text())


class NotModelled(Exception):
    """A code has no such mechanism; the message says which, in a line."""


def quantity(series, scene, name):
    """(n,) of a name in a question: time, overlap, approach, push, force1.y, torque2.z, position2.x, ..."""
    first, last = series["position"][:, 0], series["position"][:, -1]
    speeds, radii = series["velocity"], sum(grain["radius"] for grain in scene["grains"])
    if "plane" in scene:
        last, speeds = 0 * first, np.concatenate([speeds, 0 * speeds], axis=1)
        last[:, 1:] = first[:, 1:]
    distance = np.linalg.norm(first - last, axis=1)
    normal = (first - last) / distance[:, None]
    if name == "time":
        return series["time"]
    if name == "overlap":
        return radii - distance
    if name == "approach":
        return -((speeds[:, 0] - speeds[:, -1]) * normal).sum(axis=1)
    if name == "push":
        return (series["force"] * normal).sum(axis=1)
    of, axis = name.split(".")
    if of == "angular_momentum":
        vector = angular_momentum(series, scene)
    else:
        vector = series["force"] if of == "force1" else series[of[:-1]][:, int(of[-1]) - 1]
    return vector[:, "xyz".index(axis)]


def angular_momentum(series, scene):
    """(n, 3) of two equal grains, about their centre of mass."""
    mass = np.array(series["mass"])[:, None]
    x = series["position"] - (mass * series["position"]).sum(axis=1, keepdims=True) / mass.sum()
    inertia = 0.4 * mass * np.array([[grain["radius"] ** 2] for grain in scene["grains"]])
    return (mass * np.cross(x, series["velocity"]) + inertia * series["spin"]).sum(axis=1)


def measured(question, series_of, scenes):
    """The value that a question asks for; nan where it does not occur, None where the code keeps no such ledger."""
    what = question["measure"]
    if what["kind"] == "sticking":  # v'^2 is linear in v^2: its zero
        w1, w2 = (quantity(series_of[name], scenes[name], "approach")[-1] ** 2 for name in what["scenes"])
        v1, v2 = (v**2 for v in what["speeds"])
        square = v1 - w1 * (v2 - v1) / (w2 - w1)
        return float(np.sqrt(square)) if square > 0 else nan
    series, scene = series_of[what["scene"]], scenes[what["scene"]]
    return KINDS[what["kind"]](what, series, scene)


def value(what, series, scene):
    y = quantity(series, scene, what["of"])
    if "at" in what:
        return float(row_at(series["time"], what["at"], y) / what.get("over", 1.0))
    inside, passing = window(what, series), quantity(series, scene, what["when"]) - what["equals"]
    signs = np.sign(passing[inside])
    found = np.flatnonzero(signs[:-1] * signs[1:] <= 0)
    return cubic_at_zero(passing, y, inside.start + found[0]) if len(found) else nan


def row_at(time, at, y):
    step = time[1] - time[0]
    k = round(at / step)
    assert abs(k * step - at) < 1e-3 * step, f"{at} s is no multiple of the step {step}"
    return y[k]


def window(what, series):
    low, high = np.searchsorted(series["time"], [what["after"], what["before"] or np.inf])
    return slice(low, high)


def cubic_at_zero(x, y, k):
    """y where x passes zero between rows k and k + 1, both as cubics through four rows."""
    rows, t = slice(max(k - 1, 0), k + 3), np.arange(max(k - 1, 0), min(k + 3, len(x))) - k
    roots = np.roots(np.polyfit(t, x[rows] / np.abs(x[rows]).max(), len(t) - 1))
    real = roots[np.abs(roots.imag) < 1e-6].real
    return float(np.polyval(np.polyfit(t, y[rows], len(t) - 1), real[np.argmin(np.abs(real - 0.5))]))


def least(what, series, scene):
    """Of a quantity, at the bottom of the quartic through five rows, or at its end before a jump."""
    inside = window(what, series)
    x, y = quantity(series, scene, what["least"])[inside], quantity(series, scene, what["of"])[inside]
    k = int(np.argmin(x))
    if not 2 <= k < len(x) - 2:
        return nan
    if abs(np.diff(x[k : k + 3])).max() > 10 * abs(x[k - 1] - x[k - 2]):  # it ends there
        return float(y[k])
    t, rows = np.arange(-2, 3), slice(k - 2, k + 3)
    bottom = np.roots(np.polyder(np.polyfit(t, x[rows] / np.abs(x[rows]).max(), 4)))
    real = bottom[np.abs(bottom.imag) < 1e-6].real
    return float(np.polyval(np.polyfit(t, y[rows], 4), real[np.argmin(np.abs(real))])) if len(real) else nan


def work(what, series, scene):
    """Of what turns the grains, against the contact: trapezoids, spins constant within each step."""
    segments = scene["prescribed"]
    first, last = (round(what[name] / (series["time"][1] - series["time"][0])) for name in ("after", "before"))
    total, step = 0.0, series["time"][1] - series["time"][0]
    for k in range(first, last):
        segment = next(s for s in segments if s["until"] > (k + 0.5) * step)
        total -= step * (np.array(segment["spin"]) * (series["torque"][k] + series["torque"][k + 1]) / 2).sum()
    return float(total)


def broken(what, series, scene):
    """Time at which the flight after the break, drawn backwards, passed a distance."""
    overlap, speed = (quantity(series, scene, name)[-1] for name in ("overlap", "approach"))
    gone = sum(grain["radius"] for grain in scene["grains"]) - overlap - what["distance"]
    return float(series["time"][-1] + gone / speed) if speed < 0 < gone else nan


def separated(what, series, scene):
    """1 where the grains fly apart at the end, without a force; NaN where these are no numbers."""
    overlap, force = quantity(series, scene, "overlap")[-1], series["force"][-1]
    known = np.isfinite(overlap) and np.isfinite(force).all()
    return float(overlap < 0 and not force.any()) if known else np.nan


def channel(what, series, scene):
    if what["of"] not in series.get("channels", ()):
        return None
    y = series["channels"][what["of"]]
    return float(row_at(series["time"], what["at"], y) - (y[0] if what["of"] == "total" else 0.0))


KINDS = dict(value=value, least=least, work=work, separated=separated, channel=channel, **{"break": broken})


# ---- results files ----


def answer(case, series_of, levels=3):
    """A case's entry of a results file, with so many of its steps; series_of may raise NotModelled."""
    scenes, values = case["scenes"], {question["name"]: [] for question in case["asked"]}
    try:
        for level in range(levels):
            series = {
                name: series_of(scene, SUITE["materials"], scene["steps"][level]) for name, scene in scenes.items()
            }
            for question in case["asked"]:
                values[question["name"]].append(measured(question, series, scenes))
    except NotModelled as reason:
        return {"not modelled": str(reason)}
    first = next(iter(scenes.values()))
    reported = {name: found if None not in found else None for name, found in values.items()}
    return {"steps": [first["duration"] / n for n in first["steps"][:levels]], "values": reported}


def main(code, version, series_of, path, names=()):
    """Write the results file of a code; names: of cases, or all."""
    chosen = [case for case in SUITE["cases"] if not names or case["id"] in names]
    cases = {case["id"]: answer(case, series_of) for case in chosen}
    text = json.dumps({"code": code, "version": version, "suite": SUITE["version"], "cases": cases})
    Path(path).parent.mkdir(parents=True, exist_ok=True)
    Path(path).write_text(text.replace("NaN", "null") + "\n")
