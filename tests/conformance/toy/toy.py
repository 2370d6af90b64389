# SPDX-License-Identifier: MIT
"""A code of its own that takes part: two grains on a line, JKR and linear drag, velocity Verlet; Python without packages.

    python3 toy.py cases.json results.json

It forms and breaks contacts at whole steps, so that what depends on these moments converges with first order only.
"""

import json
import math
import sys


def jkr(c, overlap, u):
    """Force at an overlap of a contact with constants c, and u = (a/a0)^(1/2) by Newton's method from the one of the step before."""
    for _ in range(60):
        change = (3 * u**4 - 2 * u - overlap / c["equilibrium_overlap"]) / (12 * u**3 - 2)
        u = max(u - change, 6 ** (-1 / 3) * 1.0000001)
        if abs(change) < 1e-15:
            break
    return 4 * c["pull_off_force"] * (u**6 - u**3), u


def run(scene, steps):
    """Rows of (time, overlap, speed of approach, push)."""
    c, (first, second) = scene["contact"], scene["grains"]
    h, touch = scene["duration"] / steps, first["radius"] + second["radius"]
    x, v = second["position"][0] - first["position"][0], second["velocity"][0] - first["velocity"][0]
    segments, rows, touching, u = scene.get("prescribed"), [], touch > second["position"][0], 1.5

    def force(x, v, touching, u):
        touching = touch - x > (-c["pull_off_overlap"] if touching else 0)
        elastic, u = jkr(c, touch - x, u) if touching else (0.0, 1.5)
        return elastic - c["linear_drag"] * v * touching, touching, u

    F, touching, u = force(x, v, touching, u)
    for k in range(steps + 1):
        rows.append((k * h, touch - x, -v, F))
        if segments:
            v = next((s["velocity"][1][0] - s["velocity"][0][0] for s in segments if s["until"] > (k + 0.5) * h), v)
            x += h * v
            F, touching, u = force(x, v, touching, u)
        else:
            v += h / 2 * F / c["reduced_mass"]
            x += h * v
            foreseen = v + h / 2 * F / c["reduced_mass"]  # for the drag
            F, touching, u = force(x, foreseen, touching, u)
            v += h / 2 * F / c["reduced_mass"]
    return rows


def interpolated(rows, y, x, zero, after, before):
    """Column y where column x passes a value, by a cubic (Lagrange) through four rows and bisection."""
    for k in range(1, len(rows) - 3):
        if after <= rows[k][0] and rows[k + 1][0] <= (before or math.inf):
            if (rows[k][x] - zero) * (rows[k + 1][x] - zero) <= 0:
                four = rows[k - 1 : k + 3]
                low, high = 1.0, 2.0
                for _ in range(60):
                    middle = (low + high) / 2
                    same = (cubic(four, x, middle) - zero) * (rows[k][x] - zero) > 0
                    low, high = (middle, high) if same else (low, middle)
                return cubic(four, y, low)
    return math.nan


def cubic(four, column, t):
    weights = [math.prod((t - j) / (i - j) for j in range(4) if j != i) for i in range(4)]
    return sum(w * row[column] for w, row in zip(weights, four))


COLUMNS = {"time": 0, "overlap": 1, "approach": 2, "push": 3}


def measured(what, rows_of, scenes):
    if what["kind"] == "sticking":
        a, b = (rows_of[name][-1][2] ** 2 for name in what["scenes"])
        v1, v2 = (v**2 for v in what["speeds"])
        return math.sqrt(v1 - a * (v2 - v1) / (b - a))
    rows, scene = rows_of[what["scene"]], scenes[what["scene"]]
    if what["kind"] == "value" and "at" in what:
        return rows[round(what["at"] / rows[1][0])][COLUMNS[what["of"]]] / what.get("over", 1.0)
    if what["kind"] == "value":
        columns = COLUMNS[what["of"]], COLUMNS[what["when"]]
        return interpolated(rows, *columns, what["equals"], what["after"], what["before"])
    if what["kind"] == "separated":
        return float(rows[-1][1] < 0 and rows[-1][3] == 0)
    if what["kind"] == "break":
        distance = sum(g["radius"] for g in scene["grains"]) - rows[-1][1]
        return rows[-1][0] + (distance - what["distance"]) / rows[-1][2] if rows[-1][2] < 0 else math.nan
    if what["kind"] == "least":
        k = min(range(len(rows)), key=lambda k: rows[k][COLUMNS[what["least"]]])
        a, b, d = (rows[j][COLUMNS[what["least"]]] for j in (k - 1, k, k + 1))
        t = (a - d) / (a - 2 * b + d) / 2  # bottom of a parabola
        return cubic(rows[k - 1 : k + 3], COLUMNS[what["of"]], 1 + t)
    return None  # a ledger, which it has none of


def main(path, results):
    with open(path) as file:
        suite = json.load(file)
    cases = {}
    for case in suite["cases"]:
        missing = set(case["mechanisms"]) - {"normal", "linear drag"}
        if missing:
            cases[case["id"]] = {"not modelled": "no " + ", ".join(sorted(missing))}
            continue
        scenes, values, steps = case["scenes"], {q["name"]: [] for q in case["asked"]}, []
        for level in range(3):
            rows_of = {name: run(scene, scene["steps"][level]) for name, scene in scenes.items()}
            steps.append(next(iter(rows_of.values()))[1][0])
            for q in case["asked"]:
                values[q["name"]].append(measured(q["measure"], rows_of, scenes))
        for name, found in values.items():
            values[name] = None if None in found else [v if math.isfinite(v) else None for v in found]
        cases[case["id"]] = {"steps": steps, "values": values}
    with open(results, "w") as file:
        json.dump({"code": "toy", "version": "1", "suite": suite["version"], "cases": cases}, file, indent=1)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit("toy.py: must be called with cases.json and the file for the results")
    main(*sys.argv[1:])
