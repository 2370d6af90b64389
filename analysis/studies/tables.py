"""Tables of a study as DataFrames of text, and these as Markdown or for a terminal: every table of a page is made here."""

import pandas

from .estimate import number_text
from .levels import level
from .paper import INF
from .runs import keyed

WIDEST = 8  # columns over which one of the things that a quantity depends on is spread


def claims_table(judgements):
    """The rows of a page: quantity, paper, ours, reproduced."""
    rows = [
        (
            f"{j.claim.label}{f' [{j.unit}]' if j.unit else ''}",
            j.claim.printed + (f", margin {number_text(j.claim.margin)}" if j.claim.margin else ""),
            "not run" if j.ours is None else j.ours_text,
            j.verdict,
        )
        for j in judgements
    ]
    return pandas.DataFrame(rows, columns=("quantity", "paper", "ours", "reproduced"))


def tests_table(judgements):
    """The same in full: with p, p after Holm's correction, why, and where the paper says it."""
    rows = [(_p(j.p), _p(j.corrected), j.why, f"{j.claim.source}, {_runs(j.claim.runs)}") for j in judgements]
    return claims_table(judgements).join(
        pandas.DataFrame(rows, columns=("p", "p (Holm)", "why", "where the paper says it"))
    )


def quantity_table(quantity):
    """A quantity against what it depends on; the last of these that has few values as columns."""
    series = quantity.values.map(lambda estimate: quantity.shown(estimate).text)
    names = list(series.index.names)
    if names == [None]:
        return series.to_frame("")
    few = [name for name in names if 1 < series.index.unique(name).size <= WIDEST] if len(names) > 1 else []
    table = (series.unstack(few[-1]) if few else series.to_frame("value")).sort_index().fillna("")
    heads = [level(few[-1]).label(value, math=False) for value in table.columns] if few else ["value"]
    rows = [
        [level(name).text(part) for name, part in zip(table.index.names, key)] for key, _ in keyed(table.iloc[:, 0])
    ]
    left = pandas.DataFrame(rows, columns=[level(name).head() for name in table.index.names])
    return left.join(pandas.DataFrame(table.to_numpy(), columns=heads))


def markdown_table(table):
    """A DataFrame of text as Markdown (str)."""
    rows = [list(map(str, table.columns)), *table.astype(str).to_numpy().tolist()]
    cells = [" | ".join(cell.replace("|", "\\|") for cell in row) for row in rows]
    return "\n".join([f"| {cells[0]} |", "|" + "---|" * len(table.columns), *(f"| {row} |" for row in cells[1:])])


def text_table(table):
    """The same for a terminal, words to the left."""
    rows = [list(map(str, table.columns)), *table.astype(str).to_numpy().tolist()]
    widths = [max(map(len, column)) for column in zip(*rows)]
    return "\n".join("  " + "  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip() for row in rows)


def _p(value):
    return "-" if value is None else f"{value:.2g}"


def _runs(number):
    return "no runs" if number == INF else f"{number} run" + "s" * (number != 1)
