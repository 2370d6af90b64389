"""bench.md, out of the tables of results.py."""

from math import isnan

import errors
import pandas as pd
from codes import CODES
from measured_on import LOUD
from measured_scenes import all_scenes
from moments import FAST_STRAIN, RELAXED
from results import weights

LEFT = {"scene", "scenes", "set", "moment", "code", "weights", "version; skin, newton"}
TWO = {"one": 1, "two": 2}  # cores
HEAD = f"""# Speed and error

A contact update is one step of one touching contact; rates are in million a second. Two CPE aggregates are of ice
(r = 0.1 um, filling 0.4) at 3.16 m/s, with steps of 0.1 t0, unless said. The engine runs in YADE (with what an O.step adds to
its small steps, but without the scripts' samples). All codes, and one and two threads, are measured in turn, in rounds: rates
are the median (least - most) of the rounds, ratios are taken within a round first where both were measured in it. ms a step:
the best round, and by how much the slowest was slower; ns: of the best round.

Later moments are reached by the engine itself and kept in files. Aggregates in flight are moved back on their straight lines,
for a flight long enough to measure. Denser cells are made at C_v = {FAST_STRAIN:g} and then follow the paper's C_v for
{RELAXED:g} t0. LAMMPS and LIGGGHTS have the best of the skins that were tried (speed.csv), contacts without springs at the
start, no drag, and their cells do not shrink.
"""
OF_COUNTS = """Parts of the time are of one thread, sampled by perf. Ledger's error: the change of all channels together through
the measurements, over K of their beginning, or over the boundaries' work in them where that is larger. Memory: what the process
holds beyond YADE's scene, two threads."""
OF_SOLUTION = """Time to solution: the run's steps times the mean of the median ms a step over the moments, each with the
fraction of the run that is nearest to it. K13 itself takes steps of 0.1 t0."""


def text(results, settings):
    """The whole page."""
    scenes = all_scenes(settings)
    sections = {
        "Speed": (speed(results, scenes), of_codes(results)),
        "Lists, events and memory": (counts(results, scenes), OF_COUNTS),
        "Whole runs": (solution(results, scenes), OF_SOLUTION),
        "Error against the time step": (errors_by_step(results), of_errors(results, settings)),
    }
    there = {title: section for title, section in sections.items() if len(section[0])}
    parts = [f"## {title}\n\n{markdown(rows)}\n\n{note}".rstrip() for title, (rows, note) in there.items()]
    return "\n\n".join([HEAD + measured_on(results), *parts]) + "\n"


def markdown(table):
    """A DataFrame of cells as Markdown; words to the left, numbers to the right."""
    rule = "|".join("---" if column in LEFT else "---:" for column in table.columns)
    rows = [["-" if cell is None or cell != cell else str(cell) for cell in row] for row in table.to_numpy(object)]
    lines = [" | ".join(row) for row in [list(table.columns), *rows]]
    return "\n".join([f"| {lines[0]} |", f"|{rule}|", *(f"| {line} |" for line in lines[1:])])


def measured_on(results):
    """Where and of what the tables are, and whether the machine was quiet."""
    lines = []
    for table in (results.moments, results.error):
        for (cpu, commit), rows in table.groupby(["cpu", "commit"], sort=False):
            lines.append(f"- Measured on {cpu}, commit {commit[:7]}: {', '.join(rows.scene.unique())}.")
    others, fraction = results.moments.others.max(), results.speed[results.speed.threads == 1].fraction.min()
    if others == others:
        got = f"measurements on one core got at least {100 * fraction:.0f} % of it"
        lines.append(f"- Other programs took up to {100 * others:.0f} % of the machine; {got}.")
    if others > LOUD or fraction < 1 - LOUD:
        lines.append("- **The machine was not quiet: ratios suffer, those with two cores most.**")
    return "\n" + "\n".join(lines)


def each_moment(results, scenes):
    """(title, row of moments.csv) in the order of the scenes; a scene's title stands once."""
    for name in sorted(results.moments.scene.unique(), key=lambda name: [*scenes, name].index(name)):
        for k, row in enumerate(results.moments[results.moments.scene == name].itertuples()):
            yield "" if k else scenes[name].title if name in scenes else name, row


def number(value, digits=3):
    return None if value is None or isnan(value) else f"{value:.{digits}g}"


def spread(found, digits, unit=1.0):
    return found.text(digits, unit) if found else None


def both(words, cell):
    """{"WORDS, one": ..., "two": ...}: cells for one and two cores; columns of a table need different names."""
    return {f"{words}, {name}": cell(n) for name, n in TWO.items()}


def speed(results, scenes):
    """Every code that was measured, where it was."""
    rows = []
    for title, at in each_moment(results, scenes):
        for code in CODES:
            places = {n: (at.scene, at.moment, code, n) for n in TWO.values()}
            if not any(results.rate(*place) for place in places.values()):
                continue
            best = {n: results.milliseconds(*place).min() for n, place in places.items()}
            ours = {n: (at.scene, at.moment, "engine", n) for n in places}
            row = {"scene": title, "moment": at.moment, "grains": number(at.grains, 6)}
            row |= {"contacts": f"{at.contacts:.0f}", "code": CODES[code].name}
            row |= both("ms a step", lambda n: with_worst(results.milliseconds(*places[n])))
            row |= both("ns a contact update", lambda n: number(1e6 * best[n] / at.contacts))
            row |= both("million contact updates/s", lambda n: spread(results.rate(*places[n]), 2, 1e6))
            row |= {"two / one": spread(results.ratio(places[2], places[1]), 2)}
            rows.append(row | both("engine / code", lambda n: spread(results.ratio(ours[n], places[n]), 2)))
            title = ""
    return pd.DataFrame(rows)


def with_worst(ms):
    best, worst = ms.min(), ms.max()
    return None if isnan(best) else f"{best:.3g}" + f" +{100 * (worst / best - 1):.0f} %" * (len(ms) > 1)


def of_codes(results, shown=CODES):
    """What the codes are, and where they were not measured."""
    notes = []
    for code, about in ((code, CODES[code]) for code in shown):
        versions = results.speed[results.speed.code == code].version.dropna().unique()
        notes.append(f"- {about.name}{f' ({versions[0]})' if len(versions) else ''}: {about.physics}")
    for (code, note), rows in results.speed[results.speed.note.notna()].groupby(["code", "note"]):
        notes.append(f"- {CODES[code].name} was not measured: {note} ({', '.join(rows.scene.unique())})")
    return "\n".join(notes)


def counts(results, scenes):
    """What the engine did, where it counted."""
    rows = []
    for title, at in each_moment(results, scenes):
        row = {"scene": title, "moment": at.moment, "time [ns]": number(1e9 * at.time), "pieces": number(at.pieces)}
        row |= {"events": number(at.events, 8)}
        if (steps := at.measuredSteps) > 0:
            slips, scale = max(0, at.events - at.formed - at.broken), max(at.kinetic, abs(at.boundaryWork))
            row["neighbours searched every … steps"] = f"{steps / at.searches:.0f}" if at.searches else f"> {steps:.0f}"
            row["distance checks, a contact and step"] = number(at.distanceChecks / steps / at.contacts, 2)
            shares = {part: getattr(at, part) for part in ("lists", "forces", "integration")}
            row |= {f"% of the time: {part}": number(100 * share, 2) for part, share in shares.items()}
            row["% of contact updates that slip"] = number(100 * slips / at.contactUpdates, 2)
            row |= {"formed a step": number(at.formed / steps, 2), "broken a step": number(at.broken / steps, 2)}
            row["ledger's error"] = f"{abs(at.energyChange) / scale:.1e}" if scale else None
        rows.append(row | {"bytes a contact": number(at.bytes / at.contacts)})
    return pd.DataFrame(rows)


def solution(results, scenes):
    """Time to solution of the runs whose moments were all measured."""
    rows = []
    for name, moments in results.whole(scenes).items():
        steps, minutes = moments.runSteps.iloc[0], lambda code: lambda n: results.minutes(moments, code, n)
        shares = ", ".join(f"{moment} {weight:.2f}" for moment, weight in zip(moments.moment, weights(moments)))
        row = {"scene": scenes[name].title, "weights": shares, "step [t0]": f"{moments.step.iloc[0]:g}"}
        row |= {"steps of the run": number(steps)}
        row |= both("mean ms a step", lambda n: number(60e3 * minutes("engine")(n) / steps))
        row |= both("minutes", lambda n: number(minutes("engine")(n)))
        rows.append(row | both("LAMMPS", lambda n: number(minutes("lammps")(n))))
    return pd.DataFrame(rows)


# ---- errors ----

QUANTITIES = {"ledger": "ledger", "d_max": "d_max [r]"}


def curves(results):
    """{(scene, quantity): (steps, error)} of what was measured."""
    scenes, names = results.error.groupby("scene", sort=False), QUANTITIES
    return {(s, q): errors.curve(rows, q) for s, rows in scenes for q in names if rows[q].notna().any()}


def errors_by_step(results):
    rows, by_step = [], {key: dict(zip(*curve)) for key, curve in curves(results).items()}
    for (name, step), runs in results.error.groupby(["scene", "step"]):
        found = {words: by_step.get((name, quantity), {}).get(step) for quantity, words in QUANTITIES.items()}
        row = {"scene": errors.TITLES[name], "step [t0]": f"{step:g}", "runs": len(runs)}
        row |= {words: None if error is None else f"{error:.1e}" for words, error in found.items()}
        rows.append(row | {"seconds a run": "refused" if runs.refused.notna().any() else number(runs.seconds.mean())})
    return pd.DataFrame(rows).dropna(axis=1, how="all")


def of_errors(results, settings):
    orders = {key: errors.order(*curve) for key, curve in curves(results).items()}
    fits = [f"{s}, {QUANTITIES[q]} {x:.2f} ± {wrong:.2f}" for (s, q), (x, wrong) in orders.items() if not isnan(x)]
    fitted = " to ".join(f"{step:g}" for step in errors.FITTED)
    notes = [f"Order of convergence, fitted from {fitted} t0: {'; '.join(fits)}."] * bool(fits)
    notes.append(
        "Root mean squares over the runs of a step (errors.py); d_max against the finest step; two aggregates of "
        f"R = {settings.error_radius:g} at 3.16 m/s; the scripts' limit is 0.4 t0, the engine's own half a time unit.\n"
    )
    refused = results.error[results.error.refused.notna()].groupby(["scene", "step"]).refused.first()
    return "\n".join(notes + [f"- {step:g} t0, {name}: {words}" for (name, step), words in refused.items()])
