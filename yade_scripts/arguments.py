"""Where a script's parameters come from: name=value arguments, and the row of a table."""

import os

from yade_scripts.parameters import ParameterError


def from_arguments(arguments):
    """{name: text} of arguments such as velocity=10 seed=3; raises ParameterError for anything else."""
    texts = {}
    for argument in arguments:
        name, equals, text = argument.partition("=")
        if not equals or not name:
            raise ParameterError(f"argument '{argument}': not understood; allowed: name=value, or --help")
        if name in texts:
            raise ParameterError(f"{name}: given twice; allowed: once")
        texts[name] = text
    return texts


def gather(arguments):
    """({name: text}, description or None) of a run: a table's row, and the arguments on top of it.

    The row is the one that yade-batch asks for (YADE_BATCH=FILE:LINE), or that of an argument
    table=FILE:LINE.
    """
    texts = from_arguments(arguments)
    row = texts.pop("table", None) or os.environ.get("YADE_BATCH")
    if not row:
        return texts, None
    columns, description = read_row(row)
    return {**columns, **texts}, (None if texts else description)


def read_row(row):
    """({column: text}, description) of FILE:LINE, lines counted from 1; to be called within YADE.

    As readParamsFromTable does: = repeats the cell above, * stands for the default, columns named !... are
    yade-batch's own. (That function makes variables of unchecked values, and takes text in quotes only.)
    """
    from yade.utils import TableParamReader

    file, _, line = row.rpartition(":")
    try:
        rows = TableParamReader(file).paramDict()
    except (OSError, IndexError, RuntimeError, UnicodeDecodeError) as error:
        reason = "a row has fewer cells than the header" if isinstance(error, IndexError) else error
        raise ParameterError(
            f"table {row}: {reason}; allowed: a table with a line of names " "and rows of values"
        ) from None
    if not line.isdigit() or int(line) not in rows:
        raise ParameterError(f'table {row}: no such row; allowed lines: {", ".join(map(str, sorted(rows)))}')
    columns = dict(rows[int(line)])
    description = columns.pop("description")
    return {name: text for name, text in columns.items() if name[0] != "!" and text != "*"}, description
