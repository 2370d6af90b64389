"""What a prompt or a notebook shows of a run and of a state: a few lines, or a small table of HTML."""

import textwrap
from html import escape

from .format import PARAMETER_UNITS

# What is said of a run's parameters, as far as it has them.
TOLD = (
    *("packing", "filling", "radius", "grains", "projectileGrains", "velocity", "impact"),
    *("material", "grainRadius", "viscoelasticTime", "neck", "finalFilling", "strainRate", "seed"),
)
WIDTH = 100


def settings(parameters):
    """'packing cpe, velocity 10 m/s, ...': the parameters TOLD of a run's."""
    given = ((name, parameters.get(name)) for name in TOLD)
    return ", ".join(_setting(name, value) for name, value in given if value not in (None, ""))


def run_text(run):
    """RunFolder.__repr__."""
    lines = (f"{name}: {text}" for name, text in _facts(run))
    folded = (textwrap.fill(line, WIDTH, initial_indent="  ", subsequent_indent="    ") for line in lines)
    return "\n".join([f"run {run.path}", *folded])


def run_html(run):
    """RunFolder._repr_html_."""
    rows = (f"<tr><th>{escape(name)}</th><td>{escape(text)}</td></tr>" for name, text in _facts(run))
    return f"<table><caption>run {escape(str(run.path))}</caption>{''.join(rows)}</table>"


def state_text(state):
    """State.__repr__."""
    grains, contacts, arrays = len(state.radius), len(state.contact_pairs), vars(state)
    names = ", ".join(name for name, value in arrays.items() if value is not None)
    return f"state at {1e9 * state.time:.4g} ns: {grains} grains, {contacts} contacts\n" + textwrap.fill(
        names, WIDTH, initial_indent="  ", subsequent_indent="  "
    )


def _facts(run):
    """(name, text) of what is said of a RunFolder."""
    time = run.history["time"]
    yield "kind", f"{run.kind.name}, {'ended' if run.ended else 'NOT ENDED'} at {1e9 * time[-1]:.4g} ns"
    yield "parameters", settings(run.parameters)
    yield "history", f"{len(time)} samples of " + ", ".join(run.history)
    yield "states", f"{len(run.states)}; first and last: .start, .last"


def _setting(name, value):
    text, unit = f"{value:.6g}" if isinstance(value, float) else str(value), PARAMETER_UNITS.get(name, "")
    return f"{name} {text}" + (f" {unit}" if unit not in ("", "1") else "")
