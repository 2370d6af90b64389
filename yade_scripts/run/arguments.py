"""Where a script's parameters come from: name=value arguments, and the row of a table."""

import os

from yade_scripts.parameters import ParameterError
from yade_scripts.run import table


def from_arguments(arguments):
    """{name: text} of arguments such as velocity=10 seed=3; raises ParameterError for anything else."""
    texts = {}
    for argument in arguments:
        name, equals, text = argument.partition("=")
        if not equals or not name:
            raise ParameterError(f"argument '{argument}': not understood; must be name=value, or --help")
        if name in texts:
            raise ParameterError(f"{name}: given twice; must be given once")
        texts[name] = text
    return texts


def gather(arguments, kind):
    """({name: text}, description or None) of a run: a table's row, and the arguments on top of it. None without a row, and where an argument
    makes another run of it, by the columns of the Kind.

    The row is the one that yade-batch asks for (YADE_BATCH=FILE:LINE), or that of an argument table=FILE:LINE.
    """
    texts = from_arguments(arguments)
    row = texts.pop("table", None) or os.environ.get("YADE_BATCH")
    if not row:
        return texts, None
    columns, description = read_row(row)
    known = kind.parameters.columns()
    another = any(name not in known or known[name].of_consequence for name in texts)
    return {**columns, **texts}, (None if another else description)


def read_row(row):
    """({column: text}, description) of FILE:LINE, lines counted from 1; columns named !... are yade-batch's own."""
    file, _, line = row.rpartition(":")
    if not file:
        raise ParameterError(f"table = {row}: must be FILE:LINE, one row of a table; study.py runs all")
    try:
        rows = {str(found.line): found for found in table.read(file)}
    except table.TableError as error:
        raise ParameterError(f"table {error}") from None
    if line not in rows:
        raise ParameterError(f"table {row}: no such row; must be a line of {', '.join(rows)}")
    return rows[line].parameters, rows[line].description
