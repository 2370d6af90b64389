"""Whether a checkpoint or an ended run is of the run that is wanted. Needs no YADE."""

from math import isclose


def difference(kind, wanted, run, but=()):
    """'name = this, not that' for the first parameter in which a run is not what is wanted, or None.

    kind: the Kind wanted; wanted: its parameters, complete or not; run: a dictionary as in run.json, with 'parameters'
    and 'derived'; but: names that are not compared. A parameter that the run doesn't know (an older one) had its default, or stands under 'derived'.
    A run that was continued has a longer duration than is wanted, and is what is wanted all the same.
    """
    there = run.get("kind", "collision")  # format 1 had collisions only
    if there != kind.name:
        return f"kind = {there}, not {kind.name}"
    expected = {**wanted.as_dict(), **kind.expected(wanted, run)}
    columns, held = kind.parameters.columns(), run.get("parameters", {})
    left_out = {"tolerance" if _compares_steps(wanted, held) else "stepFraction", *but}
    for name, column in columns.items():
        if not column.of_consequence or name in left_out:
            continue
        value, found = expected[name], held.get(name, run.get("derived", {}).get(name, column.default))
        if not _same(value, found) and not (name == "duration" and _is_longer(found, value)):
            return f"{name} = {_text(found)}, not {_text(value)}"
    return None


def _compares_steps(wanted, held):
    """Whether stepFraction is compared, rather than tolerance.

    A step that is still to be chosen is that of any run that chose it for the same tolerance. A number is compared as
    such, whether or not it was chosen.
    """
    return not (isinstance(wanted.stepFraction, str) and held.get("tolerance") is not None)


def _same(one, other):
    if _are_numbers(one, other):
        return one == other or isclose(one, other, rel_tol=1e-12)
    return one == other


def _is_longer(one, other):
    return _are_numbers(one, other) and one > other


def _are_numbers(*values):
    return all(isinstance(value, (int, float)) for value in values)


def _text(value):
    if value is None:
        return "the default"
    return f"{value:.12g}" if isinstance(value, float) else str(value)
