"""The section "Scenes of the papers" of bench.md, out of what paper_speed.py measured."""

from paper_moments import by_scene, is_whole, minutes, moments_of, title_of, weights
from paper_scenes import FAST_STRAIN, RELAXED
from paper_targets import targets
from quiet import LOUD

TITLE = "## Scenes of the papers"


def text(found):
    """The section, from its title on."""
    moments = moments_of(found)
    if not moments:
        return ""
    tables = (targets_section, speed, beside_lammps, cost_of_drag, lists_and_events, solution)
    parts = [head(found, moments), *(table_of(moments) for table_of in tables)]
    return f"\n{TITLE}\n\n" + "\n\n".join(part for part in parts if part) + "\n"


def head(found, moments):
    commits = sorted({moment.found["engine"]["commit"][:7] for moment in moments})
    about = found["machine"]
    settings = moments[0].found["settings"]
    skins = ", ".join(f"{skin:g}" for skin in settings["skins"])
    lines = [
        f"Measured on {about['cpu']}, {about['cores']} cores, commit {', '.join(commits)}, in YADE (with what an O.step adds to its small steps, but without "
        "the scripts' samples).",
        "Later moments are reached by the engine itself and kept in files. Aggregates in flight are moved back on their straight lines, for a flight long "
        f"enough to measure. The denser cells are made at C_v = {FAST_STRAIN:g} and then follow the paper's C_v for {RELAXED:g} t0.",
        "One and two threads take turns in one run. ms a step: the best turn, and by how much the slowest was slower; ns: of the best turn.",
        f"LAMMPS has its best skin (of {skins} r), contacts without springs at the start, no drag, and its cell does not shrink.",
    ]
    fraction = min(turn["fraction"] for moment in moments for turn in moment.found["engine"]["turns"])
    if fraction < 1 - LOUD:
        lines.append(f"**The machine was not quiet: measurements got as little as {100 * fraction:.0f} % of a core.**")
    return "\n".join(lines)


LEFT = ("scene", "moment", "weights", "two threads unless said", "wanted", "measured", "")


def table(columns, rows):
    """Of columns "a | b" and rows of cells."""
    rule = "|".join("---" if column in LEFT else "---:" for column in columns.split(" | "))
    return "\n".join([f"| {columns} |", f"|{rule}|", *("| " + " | ".join(row) + " |" for row in rows)])


def of_moments(moments, columns, cells):
    """Table with a row for each moment; cells(moment): those behind the scene and the moment. A scene's title stands once."""
    rows, last = [], None
    for moment in moments:
        rows.append([title_of(moment.scene) if moment.scene != last else "", moment.name, *cells(moment)])
        last = moment.scene
    return table("scene | moment | " + columns, rows)


def ms_text(turns):
    best, worst = min(turns), max(turns)
    return f"{best:.3g} +{100 * (worst / best - 1):.0f} %"


def number(value, digits=3):
    return "-" if value is None else f"{value:.{digits}g}"


def speed(moments):
    def cells(moment):
        best = {threads: moment.best(threads) for threads in (1, 2)}
        return [
            str(moment.grains),
            f"{moment.contacts:.0f}",
            *(ms_text(moment.turns(threads)) for threads in (1, 2)),
            *(f"{1e6 * best[threads] / moment.grains:.1f}" for threads in (1, 2)),
            *(f"{1e6 * best[threads] / moment.contacts:.1f}" for threads in (1, 2)),
            *(f"{moment.contacts / best[threads] / 1e3:.1f}" for threads in (1, 2)),
        ]

    columns = (
        "grains | contacts | ms a step, one thread | two | ns a grain-step, one | two | ns a contact update, one | two | "
        "million contact updates/s, one | two"
    )
    return of_moments(moments, columns, cells)


def beside_lammps(moments):
    def cells(moment):
        ratios = [moment.against_lammps(cores) for cores in (1, 2)]
        each = [number(moment.lammps(cores)) for cores in (1, 2)]
        return [*each, *(ratio.text(1) if ratio else "-" for ratio in ratios)]

    missing = sorted({moment.found["lammps"].get("missing") for moment in moments} - {None})
    notes = [f"LAMMPS was not measured where {reason}." for reason in missing]
    measured = [moment for moment in moments if "missing" not in moment.found["lammps"]]
    if not measured:
        return "\n".join(notes)
    columns = "LAMMPS, ms a step, one core | two | engine / LAMMPS, one | two"
    return "\n\n".join([of_moments(measured, columns, cells), *notes])


def cost_of_drag(moments):
    """The same scene with and without viscous drag, moment by moment."""
    scenes = by_scene(moments)
    without = {moment.name: moment for moment in scenes.get("a22", [])}
    both = [(moment, without[moment.name]) for moment in scenes.get("a22-drag", []) if moment.name in without]
    rows = [
        [
            drag.name,
            *(f"{plain.best(n):.3g} → {drag.best(n):.3g}" for n in (1, 2)),
            f"{drag.best(1) / plain.best(1):.2f}",
        ]
        for drag, plain in both
    ]
    return (
        table("moment | A22 without → with drag: ms a step, one thread | two | ratio, one thread", rows) if rows else ""
    )


def lists_and_events(moments):
    def cells(moment):
        engine, steps, parts = moment.found["engine"], moment.steps(), moment.found["parts"] or {}
        slips = max(0, engine["events"] - engine["formed"] - engine["broken"])
        return [
            interval_text(steps, engine["searches"]),
            f"{engine['looks'] / steps / engine['contacts']:.2g}",
            *(f"{100 * parts[part]:.0f}" if part in parts else "-" for part in ("lists", "forces", "integration")),
            f"{100 * slips / engine['contactUpdates']:.2g}",
            *(f"{engine[name] / steps:.2g}" for name in ("formed", "broken")),
            ledger_text(moment),
        ]

    columns = (
        "neighbours of all grains searched every … steps | looks at pairs, a contact and step | % of the time: lists | forces | integration | % of contact updates that slip | formed a step | "
        "broken a step | ledger's error"
    )
    note = (
        "Parts of the time are of one thread, sampled by perf. Ledger's error: the change of all channels together through the measurements, over K of their "
        "beginning, or over the boundaries' work in them where that is larger."
    )
    return of_moments(moments, columns, cells) + "\n\n" + note


def interval_text(steps, times):
    return f"{steps / times:.0f}" if times else f"> {steps}"


def ledger_text(moment):
    engine = moment.found["engine"]
    scale = max(engine["kinetic"], abs(engine["boundaryWork"]))
    return f"{abs(engine['energyChange']) / scale:.1e}" if scale else "-"


def solution(moments):
    rows = []
    for scene, ones in by_scene(moments).items():
        if not is_whole(ones):
            continue
        of_run = [minutes(ones, lambda moment, n=n: moment.median(n)) for n in (1, 2)]
        theirs = [minutes(ones, lambda moment, n=n: moment.lammps(n)) for n in (1, 2)]
        steps = ones[0].found["run"]["steps"]
        rows.append(
            [
                title_of(scene),
                ", ".join(f"{moment.name} {weight:.2f}" for moment, weight in zip(ones, weights(ones))),
                f"{ones[0].found['run']['step']:g}",
                f"{steps:.3g}",
                *(number(60e3 * one / steps) for one in of_run),
                *(number(one) for one in of_run + theirs),
            ]
        )
    columns = "scene | weights | step [t0] | steps of the run | mean ms a step, one thread | two | minutes, one thread | two | LAMMPS, one core | two"
    note = (
        "Time to solution: the run's steps times the mean of the median ms a step over the moments, each with the fraction of the run that is nearest to it. "
        "Of scenes that were measured at all their moments. K13 itself takes steps of 0.1 t0."
    )
    return table(columns, rows) + "\n\n" + note if rows else ""


def targets_section(moments):
    lines = [target.line() for target in targets(moments)]
    return (
        "\n".join(["| two threads unless said | wanted | measured | |", "|---|---|---|---|", *lines]) if lines else ""
    )


def with_section(bench, section):
    """The text of bench.md with this section in the place of the one that it had."""
    before = bench.split(f"\n{TITLE}\n")[0]
    return before.rstrip("\n") + "\n" + section
