"""bench.md, out of the tables of results.py."""

from math import isnan

import errors
import pandas as pd
from codes import CODES
from measured_on import LOUD
from measured_scenes import all_scenes
from moments import FAST_STRAIN, RELAXED
from results import weights
from targets import targets

LEFT = {"scene", "scenes", "set", "moment", "until", "code", "weights", "target", "wanted", "measured", "verdict"}
TWO = (1, 2)


def text(results, settings):
    """The whole page."""
    scenes = all_scenes(settings)
    sections = {
        "Targets": pd.DataFrame(
            [t.cells() for t in targets(results, settings)], columns="target wanted measured verdict".split()
        ),
        "Speed": speed(results, scenes),
        "The same grains in every code": beside_others(results, scenes),
        "Cost of drag": cost_of_drag(results),
        "Lists, events and memory": counts(results, scenes),
        "Through a collision": through(results, scenes),
        "Time to solution": solution(results, scenes),
        "Error against the time step": errors_by_step(results, settings),
    }
    notes = {
        "Speed": "ms a step: the best round, and by how much the slowest was slower; ns: of the best round.",
        "The same grains in every code": of_codes(results),
        "Lists, events and memory": "Parts of the time are of one thread, sampled by perf. Ledger's error: the change of all channels together through the measurements, over K of "
        "their beginning, or over the boundaries' work in them where that is larger. Memory: what the process holds beyond YADE's scene, two threads.",
        "Through a collision": "One and two cores take turns; before its parts the same grains in flight.",
        "Time to solution": "The run's steps times the mean of the median ms a step over the moments, each with the fraction of the run that is nearest to it. K13 itself takes "
        "steps of 0.1 t0.",
        "Error against the time step": of_errors(results, settings),
    }
    parts = [
        f"## {title}\n\n{markdown(table)}\n\n{notes.get(title, '')}".rstrip()
        for title, table in sections.items()
        if len(table)
    ]
    return "\n\n".join([head(results), *parts]) + "\n"


def markdown(table):
    """A DataFrame of cells as Markdown; words to the left, numbers to the right."""
    rule = "|".join("---" if column in LEFT else "---:" for column in table.columns)
    rows = [["-" if cell is None or cell != cell else str(cell) for cell in row] for row in table.to_numpy(object)]
    lines = [" | ".join(row) for row in [list(table.columns), *rows]]
    return "\n".join([f"| {lines[0]} |", f"|{rule}|", *(f"| {line} |" for line in lines[1:])])


def head(results):
    lines = [
        "A contact update is one step of one touching contact; rates are in million a second. Two CPE aggregates are of ice (r = 0.1 um, filling 0.4) at 3.16 m/s, with steps "
        "of 0.1 t0, unless said.",
        "The engine runs in YADE (with what an O.step adds to its small steps, but without the scripts' samples). All codes, and one and two threads, are measured in turn, in "
        "rounds: rates are the median (least - most) of the rounds, ratios are taken within a round first where both were measured in it.",
        "Later moments are reached by the engine itself and kept in files. Aggregates in flight are moved back on their straight lines, for a flight long enough to measure. "
        f"Denser cells are made at C_v = {FAST_STRAIN:g} and then follow the paper's C_v for {RELAXED:g} t0.",
        "LAMMPS and LIGGGHTS have the best of the skins that were tried (speed.csv), contacts without springs at the start, no drag, and their cells do not shrink.",
    ]
    for (cpu, cores, commit), rows in results.moments.groupby(["cpu", "cores", "commit"], sort=False):
        lines.append(f"Measured on {cpu}, {cores:g} cores, commit {commit[:7]}: {', '.join(rows.scene.unique())}.")
    for (cpu, commit), rows in results.error.groupby(["cpu", "commit"], sort=False):
        lines.append(f"Errors measured on {cpu}, commit {commit}: {', '.join(rows.scene.unique())}.")
    others, fraction = results.moments.others.max(), results.speed[results.speed.threads == 1].fraction.min()
    if len(results.moments):
        lines.append(
            f"Other programs took up to {100 * others:.0f} % of the machine; measurements on one core got at least {100 * fraction:.0f} % of it."
        )
    if others > LOUD or fraction < 1 - LOUD:
        lines.append("**The machine was not quiet: ratios suffer, those with two cores most.**")
    return "\n".join(lines)


def each_moment(results, scenes, through=False):
    """(title, row of moments.csv) in the order of the scenes; a scene's title stands once. through: of those that are measured on their way, or of the others."""
    names = [*scenes, *(name for name in results.moments.scene.unique() if name not in scenes)]
    for name in names:
        rows = results.moments[results.moments.scene == name]
        if (name in scenes and scenes[name].through) == through:
            title = scenes[name].title if name in scenes else name
            for k, row in enumerate(rows.itertuples()):
                yield title if k == 0 else "", row


def million(rate, digits=1):
    return rate.text(digits, 1e6) if rate else None


def ratio(spread, digits=2):
    return spread.text(digits) if spread else None


def number(value, digits=3):
    return None if value is None or isnan(value) else f"{value:.{digits}g}"


def both(words, cells):
    """{"WORDS, one thread": ..., "two": ...} of cells for one and two threads; columns of a table need different names."""
    return {f"{words}, {n}": cell for n, cell in zip(("one", "two"), cells)}


def speed(results, scenes):
    rows = []
    for title, at in each_moment(results, scenes):
        ms = [results.milliseconds(at.scene, at.moment, "engine", n) for n in TWO]
        rates = [results.rate(at.scene, at.moment, "engine", n) for n in TWO]
        if not all(map(len, ms)):
            continue
        row = {"scene": title, "moment": at.moment, "grains": f"{at.grains:.0f}", "contacts": f"{at.contacts:.0f}"}
        row |= both("ms a step", [f"{x.min():.3g} +{100 * (x.max() / x.min() - 1):.0f} %" for x in ms])
        row |= both("ns a grain-step", [f"{1e6 * x.min() / at.grains:.1f}" for x in ms])
        row |= both("ns a contact update", [f"{1e6 * x.min() / at.contacts:.1f}" for x in ms])
        row |= both("million contact updates/s", [million(rate) for rate in rates])
        ratios = results.ratio(*((at.scene, at.moment, "engine", n) for n in (2, 1)))
        rows.append({**row, "two / one": ratio(ratios)})
    return pd.DataFrame(rows)


def beside_others(results, scenes):
    """Every other code that was measured, where it was."""
    rows = []
    for title, at in each_moment(results, scenes):
        for code in CODES:
            rates = [results.rate(at.scene, at.moment, code, n) for n in TWO]
            if code == "engine" or not any(rates):
                continue
            ms = [results.milliseconds(at.scene, at.moment, code, n) for n in TWO]
            ratios = [results.ratio((at.scene, at.moment, "engine", n), (at.scene, at.moment, code, n)) for n in TWO]
            row = {"scene": title, "moment": at.moment, "code": CODES[code].name} | both(
                "ms a step", [number(x.median()) for x in ms]
            )
            row |= both("million contact updates/s", [million(rate, 2) for rate in rates])
            rows.append(row | both("engine / code", [ratio(x) for x in ratios]))
            title = ""
    return pd.DataFrame(rows)


def of_codes(results):
    """What the codes are, and where they were not measured."""
    notes = []
    for code, about in CODES.items():
        versions = results.speed[results.speed.code == code].version.dropna().unique()
        notes.append(f"- {about.name}{f' ({versions[0]})' if len(versions) else ''}: {about.physics}")
    without = results.speed[results.speed.note.notna()]
    for (code, note), rows in without.groupby(["code", "note"]):
        notes.append(f"- {CODES[code].name} was not measured: {note} ({', '.join(rows.scene.unique())})")
    return "\n".join(notes)


def cost_of_drag(results):
    """The same scene with and without viscous drag, moment by moment."""
    rows = []
    for moment in results.moments[results.moments.scene == "a22-drag"].moment:
        plain, drag = ([results.milliseconds(name, moment, "engine", n) for n in TWO] for name in ("a22", "a22-drag"))
        if all(map(len, plain)):
            best = [f"{x.min():.3g} → {y.min():.3g}" for x, y in zip(plain, drag)]
            cells = both("A22 without → with drag: ms a step", best)
            rows.append({"moment": moment, **cells, "ratio, one": f"{drag[0].min() / plain[0].min():.2f}"})
    return pd.DataFrame(rows)


def counts(results, scenes):
    rows = []
    for title, at in each_moment(results, scenes):
        row = {"scene": title, "moment": at.moment}
        if at.measuredSteps > 0:
            slips = max(0, at.events - at.formed - at.broken)
            scale = max(at.kinetic, abs(at.boundaryWork))
            row |= {
                "neighbours searched every … steps": f"{at.measuredSteps / at.searches:.0f}"
                if at.searches
                else f"> {at.measuredSteps:.0f}",
                "looks at pairs, a contact and step": f"{at.looks / at.measuredSteps / at.contacts:.2g}",
                **{
                    f"% of the time: {part}": None if isnan(share := getattr(at, part)) else f"{100 * share:.0f}"
                    for part in ("lists", "forces", "integration")
                },
                "% of contact updates that slip": f"{100 * slips / at.contactUpdates:.2g}",
                **{f"{name} a step": f"{getattr(at, name) / at.measuredSteps:.2g}" for name in ("formed", "broken")},
                "ledger's error": f"{abs(at.energyChange) / scale:.1e}" if scale else None,
            }
        rows.append(row | {"bytes a contact": None if isnan(at.bytes) else f"{at.bytes / at.contacts:.0f}"})
    return pd.DataFrame(rows).dropna(thresh=3) if rows else pd.DataFrame()


def through(results, scenes):
    rows = []
    for title, at in each_moment(results, scenes, through=True):
        row = {"scene": title, "until": at.moment if isnan(at.until) or at.until <= 0 else f"{1e9 * at.until:.0f} ns"}
        row |= {
            f"{name}": None if isnan(value := getattr(at, name)) else f"{value:.0f}"
            for name in ("contacts", "pieces", "events")
        }
        rates = [results.rate(at.scene, at.moment, "engine", n) for n in TWO]
        rows.append(row | both("million contact updates/s", [f"{rate.median / 1e6:.1f}" for rate in rates]))
    return pd.DataFrame(rows).rename(columns={"events": "events so far"})


def solution(results, scenes):
    rows = []
    for name, moments in results.whole(scenes).items():
        minutes = {code: [results.minutes(moments, code, n) for n in TWO] for code in ("engine", "lammps")}
        steps = moments.runSteps.iloc[0]
        row = {
            "scene": scenes[name].title,
            "weights": ", ".join(f"{moment} {weight:.2f}" for moment, weight in zip(moments.moment, weights(moments))),
            "step [t0]": f"{moments.step.iloc[0]:g}",
            "steps of the run": f"{steps:.3g}",
        }
        row |= both("mean ms a step", [number(60e3 * one / steps) for one in minutes["engine"]])
        row |= both("minutes", [number(one) for one in minutes["engine"]])
        rows.append(row | both("LAMMPS", [number(one) for one in minutes["lammps"]]))
    return pd.DataFrame(rows)


# ---- errors ----

QUANTITIES = {
    "ledger": "ledger",
    "d_max": "d_max [r]",
    "rebound": "rebound speed",
    "ledgerThin": "ledger, filling < 0.1",
    "workThin": "ln of the work, filling 0.05 - 0.1",
    "work": "ln of the work, to the end",
}


def curves(results):
    """{(scene, quantity): (steps, error)} of what was measured."""
    found = {}
    for name, rows in results.error.groupby("scene", sort=False):
        for quantity in QUANTITIES:
            if rows[quantity].notna().any():
                found[name, quantity] = errors.curve(rows, quantity)
    return found


def errors_by_step(results, settings):
    rows, titles = [], {name: scene.title for name, scene in errors.scenes(settings).items()}
    by_step = {key: dict(zip(*curve)) for key, curve in curves(results).items()}
    for (name, step), runs in results.error.groupby(["scene", "step"]):
        found = {words: by_step.get((name, quantity), {}).get(step) for quantity, words in QUANTITIES.items()}
        row = {"scene": titles[name], "step [t0]": f"{step:g}", "runs": len(runs)}
        row |= {words: None if error is None else f"{error:.1e}" for words, error in found.items()}
        rows.append(row | {"seconds a run": "refused" if runs.refused.notna().any() else number(runs.seconds.mean())})
    return pd.DataFrame(rows).dropna(axis=1, how="all")


def of_errors(results, settings):
    lines = []
    for (name, quantity), curve in curves(results).items():
        slope, wrong = errors.order(*curve)
        if not isnan(slope):
            lines.append(f"{name}, {QUANTITIES[quantity]} {slope:.2f} ± {wrong:.2f}")
    fitted = " to ".join(f"{step:g}" for step in errors.FITTED)
    notes = [f"Order of convergence, fitted from {fitted} t0: {'; '.join(lines)}."] * bool(lines)
    notes.append(
        "Root mean squares over the runs of a step (errors.py); d_max and work against the finest step; two aggregates of R = "
        f"{settings.error_radius:g} at 3.16 m/s; the scripts' limit is 0.4 t0, the engine's own half a time unit.\n"
    )
    refused = results.error[results.error.refused.notna()].groupby(["scene", "step"]).refused.first()
    return "\n".join(notes + [f"- {step:g} t0, {name}: {words}" for (name, step), words in refused.items()])
