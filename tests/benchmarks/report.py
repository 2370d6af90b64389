"""The tables of bench.md, out of what bench.py measured."""

from math import isnan

import errors
from peers import PHYSICS
from quiet import LOUD
from ratios import Speeds
from targets import engine, targets

NAMES = {
    "engine": "JKRWadaEngine",
    "functors": "functors in YADE's loop",
    "stock": "YADE's own loop, stock cohesive law",
    "lammps": "LAMMPS",
    "liggghts": "LIGGGHTS",
}
OURS = {
    "engine": "This law, all channels of the energy ledger.",
    "functors": "This law, all channels of the energy ledger.",
    "stock": "CohFrictPhys with moments: linear springs with sliding, rolling and twisting, a bond between grains; no JKR, no energy ledger.",
}
KINDS = {"uniform": "like grains", "materials": "two materials", "radii": "two sizes, 1 : 0.41"}


def text(how, found):
    parts = [
        head(found),
        section(
            "Targets",
            ["| at R = %g unless said | wanted | measured | |" % how.reference, "|---|---|---|---|"]
            + [t.line() for t in targets(how, found)],
        )
        if "speed" in found or "collision" in found
        else "",
    ]
    if "speed" in found:
        speeds = Speeds(found["speed"]["results"], how.reference)
        parts += [
            codes(how, speeds, found),
            sizes(how, speeds),
            instruction_sets(how, speeds),
            kinds(speeds),
            memory(found["speed"]["memory"]),
        ]
    if "collision" in found:
        parts += [collision(one) for one in found["collision"]]
    if "error" in found:
        parts.append(error(how, found["error"]))
    return "\n".join(part for part in parts if part)


def section(title, lines):
    return f"\n## {title}\n\n" + "\n".join(lines) + "\n"


def head(found):
    about = found["machine"]
    lines = [
        f"Measured on {about['cpu']}, {about['cores']} cores, commit {about['commit']}.",
        "A contact update is one step of one touching contact; rates are in million a second. Two CPE aggregates of ice (r = 0.1 um, filling 0.4, 3.16 m/s), step 0.1 t0.",
        "All codes are measured in turn, in rounds; rates are the median (least - most) of the rounds, ratios are taken within a round first.",
    ]
    if "speed" in found:
        others, fraction = (
            found["speed"]["others"],
            min(result["fraction"] for result in found["speed"]["results"] if result["threads"] == 1),
        )
        lines.append(
            f"Other programs took up to {100 * others:.0f} % of the machine; measurements on one core got at least {100 * fraction:.0f} % of it."
        )
        if others > LOUD or fraction < 1 - LOUD:
            lines.append("**The machine was not quiet: ratios suffer, those with two cores most.**")
    return "\n".join(lines) + "\n"


def million(spread, digits=2):
    if spread is None:
        return "-"
    return f"{spread.median / 1e6:.{digits}f} ({spread.least / 1e6:.{digits}f} - {spread.most / 1e6:.{digits}f})"


def ratio_text(spread):
    return "-" if spread is None else spread.text(2)


def codes(how, speeds, found):
    lines = [
        "| code | contacts | one core | two cores | engine / code, one core | two cores | physics |",
        "|---|---:|---:|---:|---:|---:|---|",
    ]
    for code, name in NAMES.items():
        if code in found["missing"]:
            lines.append(f"| {name} | - | - | - | - | - | not measured: {found['missing'][code]} |")
            continue
        version = f" ({found['versions'][code]})" if code in found["versions"] else ""
        contacts = next(
            (f"{result['contacts']:.0f}" for threads in (1, 2) for result in speeds.find(code, threads)), "-"
        )
        ratios = [ratio_text(speeds.ratio(engine(threads), {"code": code, "threads": threads})) for threads in (1, 2)]
        rates = [million(speeds.rate(code, threads)) for threads in (1, 2)]
        lines.append(
            f"| {name}{version} | {contacts} | {rates[0]} | {rates[1]} | {ratios[0]} | {ratios[1]} | {OURS.get(code) or PHYSICS[code]} |"
        )
    failed = [
        f"- {name} core{'s' * (name[-1] != '1')} failed: {' '.join(words.split())[:300]}"
        for name, words in found["speed"]["failed"].items()
    ]
    return section(f"The same grains in every code (R = {how.reference:g})", lines + [""] * bool(failed) + failed)


def sizes(how, speeds):
    lines = [
        "| R | grains | contacts | engine, one core | two cores | two / one | functors, one core | two | stock loop, one core | two |",
        "|---:|" * 1 + "---:|" * 9,
    ]
    for radius in how.radii:
        first = speeds.find("engine", radius=radius)[0]
        cells = [
            f"{radius:g}",
            str(first["grains"]),
            f"{first['contacts']:.0f}",
            million(speeds.rate("engine", 1, radius), 1),
            million(speeds.rate("engine", 2, radius), 1),
            ratio_text(speeds.ratio(engine(2, radius=radius), engine(1, radius=radius))),
        ]
        cells += [million(speeds.rate(code, threads, radius)) for code in ("functors", "stock") for threads in (1, 2)]
        lines.append("| " + " | ".join(cells) + " |")
    return section("Sizes", lines)


def instruction_sets(how, speeds):
    lines = ["| R | instructions | one core | / best here |", "|---:|---|---:|---:|"]
    for radius in how.instruction_radii:
        for name in ("best", "avx2", "portable"):
            used = speeds.find("engine", radius=radius, instructions=name)[0]["instructions_used"]
            ratio = speeds.ratio(engine(radius=radius, instructions=name), engine(radius=radius))
            lines.append(
                f"| {radius:g} | {used} | {million(speeds.rate('engine', radius=radius, instructions=name), 1)} | {ratio_text(ratio)} |"
            )
    return section("Instruction sets", lines)


def kinds(speeds):
    lines = [
        "| grains | number | contacts | one core | two cores | / like grains, one core | two cores |",
        "|---|---:|---:|---:|---:|---:|---:|",
    ]
    for kind, name in KINDS.items():
        first = speeds.find("engine", kind=kind)[0]
        ratios = [ratio_text(speeds.ratio(engine(threads, kind=kind), engine(threads))) for threads in (1, 2)]
        rates = [million(speeds.rate("engine", threads, kind=kind), 1) for threads in (1, 2)]
        lines.append(
            f"| {name} | {first['grains']} | {first['contacts']:.0f} | {rates[0]} | {rates[1]} | {ratios[0]} | {ratios[1]} |"
        )
    return section("Unlike grains", lines)


def memory(measured):
    lines = ["| R | contacts | bytes a contact |", "|---:|---:|---:|"]
    lines += [f"| {radius:g} | {m['contacts']} | {m['bytes'] / m['contacts']:.0f} |" for radius, m in measured.items()]
    return section("Memory that the engine takes (what the process holds beyond YADE's scene, two threads)", lines)


def collision(found):
    lines = [
        "| until [ns] | contacts | pieces | events so far | one core | two cores |",
        "|---:|---:|---:|---:|---:|---:|",
    ]
    lines.append(f"| at the usual speed | | | | {found['before'][1] / 1e6:.1f} | {found['before'][2] / 1e6:.1f} |")
    lines += [
        f"| {part['until'] * 1e9:.0f} | {part['contacts']} | {part['pieces']} | {part['events']} | {part['rate1'] / 1e6:.1f} | {part['rate2'] / 1e6:.1f} |"
        for part in found["parts"]
    ]
    return section(
        f"Through a collision (R = {found['radius']:g}, {found['speed']:g} m/s; one and two cores take turns)", lines
    )


def error(how, found):
    curves = errors.curves(how, found)
    lines = [
        "| step [t0] | ledger / K(0) | d_max [r] | pair's rebound speed | seconds a run |",
        "|---:|---:|---:|---:|---:|",
    ]
    notes = []
    for step, runs in found["collision"].items():
        refused = next((run["refused"] for run in runs if "refused" in run), None)
        seconds = "refused" if refused else f"{sum(run['seconds'] for run in runs) / len(runs):.1f}"
        cells = [at(curves[name], step) for name in ("ledger", "d_max", "pair")]
        lines.append(f"| {step:g} | {cells[0]} | {cells[1]} | {cells[2]} | {seconds} |")
        notes += [f"{step:g} t0, collision: {refused}"] * bool(refused)
        notes += [f"{step:g} t0, pair: {found['pair'][step]}"] * isinstance(found["pair"][step], str)
    orders = [
        f"{name} {slope:.2f} +- {wrong:.2f}" if not isnan(slope) else f"{name} -"
        for name, (_, _, slope, wrong) in curves.items()
    ]
    lines += [
        "",
        f"Order of convergence, fitted from {how.fit[0]:g} to {how.fit[1]:g} t0: "
        + ", ".join(orders)
        + ". Root mean squares over "
        f"{len(how.error_seeds)} seeds (R = {how.error_radius:g}, 3.16 m/s) and {how.gaps} gaps of the pair; d_max against the finest step; the scripts' limit is 0.4 t0, the engine's own half a time unit.",
    ]
    return section("Error against the time step", lines + [""] * bool(notes) + [f"- {note}" for note in notes])


def at(curve, step):
    steps, error = curve[:2]
    return next((f"{e:.1e}" for s, e in zip(steps, error) if s == step), "-")
