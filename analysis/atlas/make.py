"""Fit the model to the atlas's table of runs, and write what follows from it:

    python3 -m analysis.atlas.make [FOLDER]

Of each structure outcomes.txt and outcomes-impact.txt (close-packed ones: outcomes-close-packed.txt), the tables of outcomes on grids, and model.md,
how good the model is and where it lets aggregates bounce, into FOLDER (analysis/gallery/atlas), from its runs.csv."""

import sys
from pathlib import Path

from ..commands import complain
from ..runs.table import TableError, read_table
from ..runs.write import write_text
from ..studies.columns import flat
from ..studies.tables import markdown_table
from ..version import version
from .barrier import barrier_text
from .columns import MEASURED
from .grid import FOLDER, RUNS_FILE, outcome_grid, outcomes_file
from .model import Model, NoLearning
from .neighbours import slow
from .outcome_table import write_outcomes
from .remains import LEVEL
from .scores import foretold, probabilities_of_atlas, reliability, scores
from .variables import CHOSEN, GROWN, STRUCTURES, fit_and_held_out, of_structure

ALL = "of all collisions"
SLOW = "All {known.number} fitted runs of {structure} aggregates with a kinetic energy below {known.energy:.3g} E_break stuck: the chance of anything else is {known.most:.2g} there at most (95 %)."
FORETOLD = """
Rows from {before} on, which were drawn at random, as the model fitted to the rows before tells them: number of runs observed (told).
"""
UPTO = {ALL: 1.0, "of collisions with b < 1/2": 0.25}  # b^2
HEAD = """# How good the model of the atlas is

Fitted to {fit} decided runs; {held} more were held out, drawn before any run was made. Cross-validated: each of the fitted runs foretold from the others.
Brier score: mean over runs of the sum over the five outcomes of (p - observed)^2, 0 at best; more: than the atlas's, with the standard error of
that, runs paired. Log loss: mean of -ln p of what was observed. Miss: mean of |p - observed| over bins of p a tenth wide, each with its number of
values. Within: fraction of the runs in the {level:.0%} intervals of the largest piece and of its filling. Of the largest piece these are of runs that
leave more than one piece: {whole:.0%} of the fitted leave one, and no interval that ends there can hold a chosen fraction.

{slow}
Paszun & Dominik (2009): their tables (as extended by Ormel et al. 2009: CDS, J/A+A/502/845) could not be had for this comparison.
"""


def read_runs(file=RUNS_FILE):
    """The table of runs (DataFrame); TableError, OSError."""
    return read_table(file, flat(MEASURED))[0]


def report(table, grids, tables):
    """model.md (str) of a table of runs, and of {(structure, of which impact parameters): OutcomeTable} and {structure: OutcomeTable at each}."""
    found = scores(table, tables)
    fit, held = fit_and_held_out(table)
    known = [SLOW.format(structure=structure, known=slow(of_structure(fit, structure))) for structure in STRUCTURES]
    numbers = {"fit": len(fit), "held": len(held), "whole": (fit.pieces == 1).mean()}
    head = HEAD.format(level=LEVEL, slow="\n".join(known), **numbers)
    shown = found.drop(columns="number").round(3).astype(str).replace("nan", "")
    shown["more"] = [f"{more} ± {error}" if more else "" for more, error in zip(shown.more, shown.pop("error"))]
    shown.columns = [name.replace("mean_miss", "miss").replace("_", " ") for name in shown.columns]
    bins = reliability(probabilities_of_atlas(fit, held), held.outcome).round(3)
    later = foretold(table, CHOSEN.stop)
    parts = [
        head,
        markdown_table(shown),
        "\nHeld-out runs, in bins of probability of all outcomes together:\n",
        markdown_table(bins),
        *([FORETOLD.format(before=f"{CHOSEN.stop:,}"), markdown_table(later.round(3))] if len(later) else []),
        "\n## Where aggregates bounce\n",
        *(line for names, grid in grids.items() for line in barrier_text(" aggregates, ".join(names), grid)),
    ]
    return "\n".join(parts) + "\n"


def main(arguments):
    """Exit status: 0, or 2 with one line on stderr."""
    folder = Path(arguments[0]) if arguments else FOLDER
    try:
        table = read_runs(folder / RUNS_FILE.name)
        grids, tables = {}, {}
        for structure in STRUCTURES:
            model = Model(of_structure(table, structure))
            grids |= {(structure, name): outcome_grid(model, structure, version(), upto) for name, upto in UPTO.items()}
            write_outcomes(folder / outcomes_file(structure, False).name, grids[structure, ALL])
            tables[structure] = outcome_grid(model, structure, version(), None)
            write_outcomes(folder / outcomes_file(structure, True).name, tables[structure])
        write_text(folder / "model.md", report(table, grids, tables))
    except OSError as error:
        complain(f"{error.filename or folder}: {error.strerror}")
        return 2
    except (TableError, NoLearning, ValueError) as error:
        complain(error)
        return 2
    print(folder / outcomes_file(GROWN, False).name)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
