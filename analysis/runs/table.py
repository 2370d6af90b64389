"""A table of runs: a pandas DataFrame with one row a run, in memory and as a CSV file.

Beside what a study measures it has the columns `run` (the folder's name) and, in memory only, `folder` (its path on
this machine, None for a row read from a file). The file says in lines that begin with # where its runs come from (one
line of JSON) and what each column is; numbers are written so that reading gives back the same bits."""

import csv
import io
import json
from dataclasses import dataclass
from itertools import takewhile
from pathlib import Path

import pandas

from ..printable import Refused, printable
from .files import read_text
from .format import CHANNEL_TABLE

RUN, FOLDER = "run", "folder"
_TYPES = {"f": ("fiu", "numbers"), "i": ("iu", "integers"), "b": ("b", "True or False"), "O": ("O", "words")}
ENDING = ".csv"
LATER = {channel.name for channel in CHANNEL_TABLE if channel.since > 1}  # columns of these are zero in older tables
# With these pandas.read_csv gives numbers the bits that were written: from 3.1 on it does so by itself, and warns of
# the option.
EXACTLY = {} if tuple(map(int, pandas.__version__.split(".")[:2])) >= (3, 1) else {"float_precision": "round_trip"}


@dataclass(frozen=True)
class Column:
    """What a column holds."""

    name: str
    unit: str  # '' of numbers of things and words
    meaning: str
    kind: str = "f"  # numpy's letter of the type: "f", "i", "b", "O" for words
    gaps: bool = False  # whether it may have no value in places


def make_table(measured):
    """DataFrame from (folder, {column: value}) of each run."""
    rows = [
        {RUN: printable(Path(folder).absolute().name), FOLDER: str(folder), **values} for folder, values in measured
    ]
    return pandas.DataFrame(rows)


def described(table, columns):
    """The DataFrame with the units and meanings of its columns in .attrs["units"] and .attrs["meanings"], {name:
    text}."""
    table.attrs["units"] = {column.name: column.unit for column in columns}
    table.attrs["meanings"] = {column.name: column.meaning for column in columns}
    return table


def table_text(table, columns, head):
    """The CSV file (str) of a table; head: a dict that JSON can hold."""
    out = io.StringIO()
    about = (f"{c.name}{f' [{c.unit}]' if c.unit else ''}: {c.meaning}" for c in columns)
    out.writelines(f"# {line}\n" for line in (json.dumps(head, allow_nan=False), *about))
    names = [RUN, *(column.name for column in columns)]
    table.to_csv(out, columns=names, index=False, quoting=csv.QUOTE_MINIMAL, lineterminator="\n")
    return out.getvalue()


def read_table(file, columns):
    """(DataFrame, head) of a CSV file; Refused where it is not one with these columns, RunFolderError
    where it cannot be read."""
    try:
        lines = read_text(file).split("\n")
        comments = list(takewhile(lambda line: line.startswith("# "), lines))
        body = lines[len(comments) :]
        head = json.loads(comments[0][2:]) if comments else None
        if not isinstance(head, dict):
            raise ValueError("its first line is not '# ' with a JSON object")
        names = next(csv.reader(body), [])
        for name in names:
            if names.count(name) > 1:
                raise ValueError(f"has the column {name} {names.count(name)} times; must be once")
        text = io.StringIO("\n".join(body))
        table = pandas.read_csv(text, dtype={RUN: str}, keep_default_na=False, na_values=[""], **EXACTLY)
    except (ValueError, RecursionError) as error:  # pandas's and json's errors are ValueErrors too
        raise Refused(f"{file}: not a table of runs: {str(error).splitlines()[0]}") from None
    lacking = [name for name in (RUN, *(column.name for column in columns)) if name not in table]
    if LATER.issuperset(name.split("_")[0] for name in lacking):
        table = table.copy().assign(**dict.fromkeys(lacking, 0.0))
    else:
        raise Refused(f"{file}: lacks the column {', '.join(lacking)}")
    for column in columns:
        _check(file, column, table[column.name])
    # .copy(): pandas 3 warns of a table that is made of many pieces.
    return table.copy().assign(**{FOLDER: None}), head


def _check(file, column, values):
    kinds, words = _TYPES[column.kind]
    empty = values.isna()
    if empty.any() and not column.gaps:
        raise Refused(f"{file}: '{column.name}' has no value in row {int(empty.argmax()) + 1}")
    if values.dtype.kind not in kinds and not empty.all():
        raise Refused(f"{file}: '{column.name}' must be {words}")
