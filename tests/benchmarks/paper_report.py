"""The section "Scenes of the papers" of bench.md, out of what paper_speed.py measured."""

import json
import statistics
from dataclasses import dataclass

from paper_scenes import FAST_STRAIN, RELAXED, SCENES
from quiet import LOUD
from ratios import Spread
from targets import Target

TITLE = "## Scenes of the papers"
RESULT = "papers.json"


def read(folder):
    """What papers.json of a folder holds, or nothing yet."""
    path = folder / RESULT
    return json.loads(path.read_text()) if path.exists() else {"scenes": {}}


@dataclass(frozen=True)
class Moment:
    """A scene at a moment: what was measured there."""

    scene: str
    name: str
    found: dict

    @property
    def contacts(self):
        return self.found["engine"]["contacts"]

    @property
    def grains(self):
        return self.found["engine"]["grains"]

    def turns(self, threads):
        """ms a small step of each measurement with so many threads."""
        turns = self.found["engine"]["turns"]
        return [1e3 * turn["seconds"] / turn["steps"] for turn in turns if turn["threads"] == threads]

    def best(self, threads):
        """ms a small step."""
        return min(self.turns(threads))

    def median(self, threads):
        return statistics.median(self.turns(threads))

    def rate(self, threads):
        """Spread of the million contact updates a second."""
        return Spread.of([self.contacts / ms / 1e3 for ms in self.turns(threads)])

    def lammps(self, cores):
        """ms a step, or None."""
        run = self.found["lammps"].get(str(cores))
        return run["msPerStep"] if run else None

    def against_lammps(self, cores):
        """Spread of LAMMPS's ms a step over the engine's; a contact counts as much in either. None where LAMMPS was not measured."""
        run = self.found["lammps"].get(str(cores))
        if not run:
            return None
        theirs = run["msPerStep"] / run["contacts"]
        return Spread.of([theirs / (ms / self.contacts) for ms in self.turns(cores)])

    def steps(self):
        """Small steps of all measurements."""
        return sum(turn["steps"] for turn in self.found["engine"]["turns"])


def moments_of(found):
    """[Moment], in the order of the scenes and of time."""
    return [
        Moment(name, moment, found["scenes"][name][moment])
        for name in [*SCENES, *(name for name in found["scenes"] if name not in SCENES)]
        if name in found["scenes"]
        for moment in sorted(found["scenes"][name], key=lambda one: found["scenes"][name][one]["run"]["progress"])
    ]


def by_scene(moments):
    """{scene: its Moments}"""
    found = {}
    for moment in moments:
        found.setdefault(moment.scene, []).append(moment)
    return found


def title_of(scene):
    return SCENES[scene].title if scene in SCENES else scene


def weights(moments):
    """Fraction of the run's steps that each of a scene's moments stands for: those nearer to it than to another (of a compression in the logarithm of the
    filling, in which its time is even)."""
    at = [moment.found["run"]["progress"] for moment in moments]
    ends = [0.0, *((a + b) / 2 for a, b in zip(at, at[1:])), 1.0]
    return [end - begin for begin, end in zip(ends, ends[1:])]


def minutes(moments, ms):
    """Of the whole run; ms: function of a Moment. None where it is not known of all."""
    each = [ms(moment) for moment in moments]
    if None in each:
        return None
    mean = sum(weight * one for weight, one in zip(weights(moments), each))
    return mean * moments[0].found["run"]["steps"] / 60e3


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
            *(interval_text(steps, engine[name]) for name in ("farRebuilds", "nearRebuilds")),
            *(f"{100 * parts[part]:.0f}" if part in parts else "-" for part in ("lists", "forces", "integration")),
            f"{100 * slips / engine['contactUpdates']:.2g}",
            *(f"{engine[name] / steps:.2g}" for name in ("formed", "broken")),
            ledger_text(moment),
        ]

    columns = (
        "far lists redone every … steps | near lists | % of the time: lists | forces | integration | % of contact updates that slip | formed a step | "
        "broken a step | ledger's error"
    )
    note = (
        "Parts of the time are of one thread, sampled by perf. Ledger's error: the change of all channels together through the measurements, over K of their "
        "beginning, or (w) over the boundaries' work in them."
    )
    return of_moments(moments, columns, cells) + "\n\n" + note


def interval_text(steps, times):
    return f"{steps / times:.0f}" if times else f"> {steps}"


def ledger_text(moment):
    engine = moment.found["engine"]
    work = moment.found["run"]["compression"]
    scale = abs(engine["boundaryWork"]) if work else engine["kinetic"]
    return f"{abs(engine['energyChange']) / scale:.1e}{' (w)' * work}" if scale else "-"


def solution(moments):
    rows = []
    for scene, ones in by_scene(moments).items():
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
        "Time to solution: the run's steps times the mean of the median ms a step over the moments, each with the fraction of the run that is nearest to it "
        "(moments that were not measured are left out). K13 itself takes steps of 0.1 t0."
    )
    return table(columns, rows) + "\n\n" + note


def targets_section(moments):
    lines = [target.line() for target in targets(moments)]
    return (
        "\n".join(["| two threads unless said | wanted | measured | |", "|---|---|---|---|", *lines]) if lines else ""
    )


def targets(moments):
    """Of what was measured."""
    scenes, found = by_scene(moments), []
    bounds = {"a22": 6, "a22-drag": 6, "k13": 40}  # minutes
    for scene, bound in bounds.items():
        if scene in scenes:
            turns = [minutes(scenes[scene], lambda moment, pick=pick: pick(moment.turns(2))) for pick in (min, max)]
            median = minutes(scenes[scene], lambda moment: moment.median(2))
            spread = Spread(median, *turns)
            found.append(Target(f"minutes for a run, {title_of(scene)}", bound, spread, at_least=False))
    for scene in ("a22", "a22-drag"):
        ratios = [moment.against_lammps(2) for moment in scenes.get(scene, [])]
        if ratios and None not in ratios:
            worst = min(ratios, key=lambda spread: spread.median)
            found.append(Target(f"slowest moment / LAMMPS on two cores, {title_of(scene)}", 8, worst))
    if "a22" in scenes and "a22-slow" in scenes:
        flying, slow = scenes["a22"][0].rate(2), scenes["a22-slow"][0].rate(2)
        ratio = Spread(flying.median / slow.median, flying.least / slow.most, flying.most / slow.least)
        found.append(Target("flying at 50.1 m/s / the same grains at 0.5 m/s", 0.9, ratio))
    for threads, bound in ((1, 100), (2, 190)) if "cpe" in scenes else ():
        words = f"million contact updates a second, two CPE, R 40, {'one thread' if threads == 1 else 'two threads'}"
        found.append(Target(words, bound, scenes["cpe"][0].rate(threads)))
    return found


def with_section(bench, section):
    """The text of bench.md with this section in the place of the one that it had."""
    before = bench.split(f"\n{TITLE}\n")[0]
    return before.rstrip("\n") + "\n" + section
