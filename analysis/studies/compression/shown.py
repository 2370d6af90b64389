"""How groups of runs and their numbers are written in tables: the parameters, labels, values with errors."""

import numpy as np

from ...report.beside_paper import Line, number
from ...report.section import Column
from ...statistics import mean_and_error
from ..grains import grains_text


def material_text(parameters):
    """The material and what differs from K13's grains of it; xi_crit has a place of its own."""
    return grains_text(parameters, but=("criticalRolling",))


def label(group):
    """A group's parameters in a line."""
    p = group.parameters
    return (
        f"{material_text(p)}, N = {p['grains']}, C_v = {p['strainRate']:g}, k_n = {p['linearDamping']:g}, "
        f"xi_crit = {p['criticalRolling'] * 1e10:.3g} Å, step {p['stepFraction']:g} t0"
    )


# Of a group of runs, in every table.
PARAMETERS = (
    Column("material", material_text),
    Column("N", lambda r: f"{r['grains']}"),
    Column("C_v", lambda r: f"{r['strainRate']:g}"),
    Column("k_n", lambda r: f"{r['linearDamping']:g}"),
    Column("xi_crit [Å]", lambda r: f"{r['criticalRolling'] * 1e10:.3g}"),
    Column("step [t0]", lambda r: f"{r['stepFraction']:g}"),
)


class LogarithmicLine(Line):
    """A Line whose error is that of the logarithm (times ours): differences are those of logarithms, in their errors."""

    @property
    def difference(self):
        if self.ours is None or self.paper is None or not self.error:
            return None
        return float(np.log(self.ours / self.paper) * self.ours / self.error)


def line_of_seeds(quantity, unit, values, theirs, note=""):
    """Line of the mean of values, one a seed."""
    return Line(quantity, unit, *mean_and_error(values), theirs, note=note, freedom=len(values) - 1 or None)


def mean_with_error(values):
    """(mean, standard error or None) of values (n,), one a seed; (None, None) of none."""
    return mean_and_error(values) if len(values) else (None, None)


def with_error(value, error):
    """Such as 1.05 ± 0.03."""
    return number(value, error) + (f" ± {error:.2g}" if error else "")


def scientific(value, error):
    """Such as 1.05e+04 ± 3e+02."""
    return f"{value:.3g}" + (f" ± {error:.2g}" if error else "")


def chance_text(chance):
    """A chance p, or - where there is none."""
    return "-" if chance is None else f"{chance:.2g}"
