"""What studies of collisions have in common: columns of a run's outcome, return and energy, what follows from them, and a study of a
question of one's own."""

from ..measures.outcome import BOUNCING, FRAGMENTATION, NEVER_MET, STICKING, UNDECIDED
from ..runs.collect import Scene
from ..runs.format import CHANNELS, LOST_CHANNELS, PARAMETER_WORDS
from .columns import (  # noqa: F401
    AT_MAXIMUM,
    COMPACT,
    HEAD_ON_ICE,
    LARGEST,
    OUTCOME,
    VELOCITY,
    largest_compression,
    parameter,
)
from .definition import Quantity, Study


def outcome_quantities(runs, by):
    """Quantities of a runs.Runs with the columns of OUTCOME, by the columns `by`: fractions of the runs that stick, bounce and break, of those
    that met, with undecided ones apart, and the mean restitution of those that bounce."""
    undecided = lambda table: table.outcome == UNDECIDED
    met = runs.where(lambda table: table.outcome != NEVER_MET)
    for name, kind in (("sticking", STICKING), ("bouncing", BOUNCING), ("breaking", FRAGMENTATION)):
        values = met.fractions(lambda table, kind=kind: table.outcome == kind, by, undecided)
        yield Quantity(name, f"runs that end in {kind}", values)
    restitution = runs.where(outcome=BOUNCING).estimates("restitution", by)
    yield Quantity("restitution", "coefficient of restitution of runs that bounce", restitution)
    (largest,) = LARGEST.columns
    if largest.name in runs.table:
        yield Quantity("largest", largest.meaning, runs.estimates(largest.name, by))


def energy_quantities(runs, by, lost, changes):
    """Quantities, named lost and changes, of a runs.Runs with the columns of COMPACT, by the columns `by`: what is dissipated until t_max, and
    the change of every channel that changes at all (by `channel` too)."""
    values = runs.estimates(lambda table: table[[AT_MAXIMUM.format(c) for c in LOST_CHANNELS]].sum(axis=1), by)
    yield Quantity(lost, "dissipated until t_max, of K(0)", values, "%")
    columns = {c: AT_MAXIMUM.format(c) for c in CHANNELS if c != "kinetic"}
    changing = {c: name for c, name in columns.items() if (runs.table[name] != 0).any()} or columns  # all: of no runs
    values = runs.parts(changing, by, "channel")
    yield Quantity(changes, "change of each channel until t_max, of K(0)", values, "%")


def collision_study(title, question, varied, quantities, **values):
    """definition.Study of a question of one's own about collisions: varied: the parameters that differ from run to run, seed among them;
    quantities: a function of the table of runs, as definition.Study has it; values: parameters that every run has. Run folders that
    differ in another parameter are refused together.

    A run's row has the parameters varied, and the columns of OUTCOME and LARGEST."""
    kinds = {name: "O" if name in PARAMETER_WORDS else "f" for name in varied}
    parameters = [parameter(name, "", "as the table of runs has it", kind) for name, kind in kinds.items()]
    measured = (*parameters, *(() if "velocity" in varied else (VELOCITY,)), OUTCOME, LARGEST)
    of_numbers, of_words = (tuple(name for name in varied if kinds[name] == kind) for kind in "fO")
    scene = Scene(title, values, of_numbers, measured=of_words)
    return Study(title, question, scene, measured, quantities, alike=True)
