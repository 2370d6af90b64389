"""Whether a checkpoint or an ended run is of the run that is wanted. Needs no YADE."""

from math import isclose

from yade_scripts.parameters import BY_NAME, DURATION_PER_RADIUS
from yade_scripts.step_choice import AUTO

# They say how a run is carried out and kept, not what it gives.
OF_NO_CONSEQUENCE = ("threads", "out", "overwrite", "resume", "checkpointInterval")


def difference(wanted, run):
    """'name = this, not that' for the first parameter in which a run is not what is wanted, or None.

    wanted: parameters as parse() or complete() give them; run: a dictionary as in run.json, with 'parameters'
    and 'derived'. A parameter that the run doesn't know (an older one) had its default.
    """
    held = run.get("parameters", {})
    wanted = _step_as_compared(wanted, held)
    for name, value in wanted.items():
        if name in OF_NO_CONSEQUENCE:
            continue
        if value is None and name == "duration":
            value = DURATION_PER_RADIUS * wanted["radius"] * run["derived"]["timeUnit"]
        there = held.get(name, BY_NAME[name].default)
        if not _same(value, there):
            return f"{name} = {_text(there)}, not {_text(value)}"
    return None


def _step_as_compared(wanted, held):
    """wanted without the one of stepFraction and tolerance that says nothing beside the other.

    A step that is still to be chosen is that of any run that chose it for the same tolerance. A number is
    compared as such, whether or not it was chosen.
    """
    chosen = wanted.get("stepFraction") == AUTO and held.get("tolerance") is not None
    return {name: value for name, value in wanted.items() if name != ("stepFraction" if chosen else "tolerance")}


def _same(one, other):
    if isinstance(one, (int, float)) and isinstance(other, (int, float)):
        return one == other or isclose(one, other, rel_tol=1e-12)
    return one == other


def _text(value):
    return f"{value:.12g}" if isinstance(value, float) else str(value)
