"""The page of throughput: every code that can be installed, on one collision and one aggregate that rings.

    /usr/bin/python3 tests/benchmarks/throughput.py    make bench-peers measures, and makes the page

Writes results/throughput.md and results/throughput/cost.png from the tables there (results.py).
"""

import sys

import numpy as np
import pandas as pd
from measured_on import RESULTS, TOP

sys.path.insert(0, str(TOP))
from codes import CODES
from errors import FOLLOWED, INTERVAL, MEETING, PAIR_SPEED, PAIRS, RINGING_RATE
from matplotlib.figure import Figure
from measured_scenes import EVERY, all_scenes
from report import markdown, measured_on, of_codes, spread
from results import Results
from settings import FULL

FOLDER, WANTED = RESULTS / "throughput", 1e-4  # fraction of K(0)
COLOURS = dict(zip(EVERY, ("#0072b2", "#56b4e9", "#009e73", "#d55e00", "#e69f00", "#cc79a7")))


def of(results, scene, code):
    """Rows of error.csv, the finest step first, which the others are compared with."""
    rows = results.error[(results.error.scene == scene) & (results.error.code == code)]
    return rows.sort_values("step")


def costs(results, scene, code):
    """(error of K(t) over K(0) (n,), seconds (n,)) of the steps but the finest: of as many steps of the aggregate that rings."""
    rows, rung = of(results, scene, code)[1:], of(results, "ringing", code)
    return rows.kinetic.to_numpy(), (rung.seconds * rung.step).mean() / rows.step.to_numpy()


def seconds_to(error, seconds, wanted=WANTED):
    """In words: seconds from which on the error, of the shortest step first, is what is wanted, between the steps' own."""
    first = np.argmax(error > wanted) if (error > wanted).any() else len(error)
    if first in (0, len(error)):
        return f"> {seconds[0]:.2g}" if first == 0 else f"< {seconds[-1]:.2g}"
    at = [np.log(x[first - 1 : first + 1]) for x in (error, seconds)]
    return f"{np.exp(np.interp(np.log(wanted), *at)):.2g}"


def table(results):
    rows = []
    for code in (code for code in EVERY if len(results.of("peers", "flying", code, 1))):
        rate = lambda moment, n: spread(results.rate("peers", moment, code, n), 1, 1e6)
        places = [("peers", "flying", name, 1) for name in ("engine", code)]
        best = results.of(*places[1]).iloc[0]
        how = f"{best.version}; {best.skin:g} r, newton {best.newton}" if best.skin == best.skin else best.version
        row = {"code": CODES[code].name, "version; skin, newton": how, "in flight, one core": rate("flying", 1)}
        row |= {"two cores": rate("flying", 2), "compressed, one core": rate("compressed", 1)}
        row |= {"engine / code": spread(results.ratio(*places), 1)}
        rows.append(row | {f"s, {scene}": seconds_to(*costs(results, scene, code)) for scene in FOLLOWED})
    return pd.DataFrame(rows)


def draw(results, path):
    figure = Figure((9, 3.8), layout="constrained")
    both = figure.subplots(1, 2, sharex=True, sharey=True)
    for axes, scene, title in zip(both, FOLLOWED, ("An aggregate that rings: springs alone", MEETING)):
        for code in EVERY:
            error, seconds = costs(results, scene, code)
            axes.loglog(seconds, error, "o-", ms=4, color=COLOURS[code], label=CODES[code].name)
        axes.axhline(WANTED, color="0.6", lw=0.8, ls="--")
        axes.set_xlabel("time to solution, one core [s]")
        axes.set_title(title, fontsize=10)
    both[0].set_ylabel("error of K(t), fraction of K(0)")
    both[0].legend(fontsize=7, frameon=False)
    figure.savefig(path, dpi=130)


def text(results):
    scene, start = all_scenes(FULL)["peers"], results.moments.iloc[0]
    return f"""# Throughput of cohesive contacts, and what an error of energy costs

All codes that Debian and PyPI have, on the same grains of ice (r = 0.1 um). Made by `make bench-peers`, which installs them, in some ten minutes.

![Error of the kinetic energy against time to solution](throughput/cost.png)

{markdown(table(results))}

**Rates**: updates of touching contacts, in million a second; {scene.title}, {start.grains:.0f} grains with {start.contacts:.0f} contacts, in flight and most compressed; median (least - most) of rounds in which all codes take turns. LAMMPS and LIGGGHTS have the best of skins of {", ".join(f"{skin:g}" for skin in FULL.skins)} r and of newton on and off (LIGGGHTS needs off); all codes are as they are packaged, the plugin is built for this processor.

**Left, springs**: an aggregate of R = {FULL.rung[0]:g} r is stretched at {RINGING_RATE:g}/s and rings for {1e9 * INTERVAL * FULL.rung[1]:g} ns; no contact is made, broken or slips, so every code does the same physics with its own springs. Error: root mean square of K(t) at {FULL.rung[1]} moments against the same code with a fine step ({of(results, "ringing", "engine").step.iloc[0]:g} t0), over K(0); time: the processor's, of the steps alone. All codes are leapfrogs of second order with like errors for like steps, so the faster one is faster for any error.

**Right, contacts that are born and break**: {PAIRS} pairs meet at {PAIR_SPEED:g} m/s, at times that differ by parts of a step; the same error (fine step: {of(results, "meeting", "engine").step.iloc[0]:g} t0) against the time that as many steps of the aggregate take. A force that begins or ends with a jump at a whole step leaves errors of first order, which scatter: LAMMPS's at both ends, the stock law's as it breaks. This law takes the moment within the step; LIGGGHTS's force has no jump.

**s, ringing** and **s, meeting**: seconds for an error of {WANTED:g} of K(0) in the two.

What is compared is not one law: [the suite of two grains](../../conformance/results.md) says where each code differs. Only this law keeps an energy ledger; in a whole collision the energy error of the others cannot be told from their output. K and springs do not add up in LAMMPS even without events: its speed of sliding takes levers r, its torque r − δ/2 (`granular_model.cpp`), so that what sliding springs take and give differs by δ/2r, 0.5 % here, at any step.

{of_codes(results, EVERY)}
{measured_on(results)}
"""


def main():
    results = Results(FOLDER)
    draw(results, FOLDER / "cost.png")
    FOLDER.with_suffix(".md").write_text(text(results))
    print(FOLDER.with_suffix(".md"))


if __name__ == "__main__":
    main()
