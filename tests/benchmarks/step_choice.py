"""The ledger's error against the step in scenes of every kind, and the constants of yade_scripts/step_choice.py from it.

    python3 tests/benchmarks/step_choice.py            measure the scenes that have no error, fit, write results (stopped, it resumes)
    python3 tests/benchmarks/step_choice.py --fit      fit and write from the results that are there
    python3 tests/benchmarks/step_choice.py --again    measure all scenes anew (an hour on one core), but those of the set study, which are runs of a study

The scenes are the lines of results/step_choice.csv (collisions) and results/step_choice_compression.csv: a new one is a line without an error.
The constants are fitted to grids of scenes and the study's runs; random scenes between and beyond only judge them. Writes these tables,
results/step_choice.md (fit and scatter) and results/step_choice.png.
"""

import sys

from measured_on import RESULTS, TOP, machine

sys.path.insert(0, str(TOP))
import errors  # noqa: E402
import step_choice_report as report  # noqa: E402
from step_choice_data import COLLISIONS, COMPRESSIONS  # noqa: E402

CHUNK = 20  # scenes in one YADE; results are written after each


def measure(table, again=False):
    """Measure the scenes of a table that have no error, or all; those that fail keep none, and are named."""
    scenes, about = table.read(), machine()
    wanted = (scenes["set"] != "study") if again else scenes.error.isna()
    numbers = list(scenes.index[wanted])
    for start in range(0, len(numbers), CHUNK):
        print(f"{table.path.stem}: {start} of {len(numbers)} scenes", flush=True)
        chunk = numbers[start : start + CHUNK]
        for number, answer in zip(
            chunk, errors.in_yade([table.given(scenes.loc[number]) for number in chunk]), strict=True
        ):
            if "failed" in answer:
                print(answer, file=sys.stderr)
            by_filling = {
                f"error{float(filling):g}": error for filling, (error, _) in answer.get("byFilling", {}).items()
            }
            for name in table.errors:
                scenes.loc[number, name] = {**by_filling, **answer}.get(name, float("nan"))
        table.write(scenes, **{"measured last on": f"{about['cpu']}, commit {about['commit']}"})


def main():
    options = set(sys.argv[1:])
    if unknown := options - {"--fit", "--again"}:
        sys.exit(f"step_choice.py: {min(unknown)}: must be --fit or --again")
    if "--fit" not in options:
        for table in (COLLISIONS, COMPRESSIONS):
            measure(table, "--again" in options)
    text = report.text()
    (RESULTS / "step_choice.md").write_text(text)
    report.draw(RESULTS / "step_choice.png")
    print(text)


if __name__ == "__main__":
    main()
