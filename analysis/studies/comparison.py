"""A paper's numbers beside ours: one row each, the words that say how they compare, and the tables and pages that show
them."""

import base64
import math
import re
from collections import Counter
from dataclasses import dataclass
from html import escape

import numpy as np
import pandas

from ..printable import Refused
from ..version import version_text
from .estimates import Estimate

AGREES, DIFFERS, UNCLEAR, NOT_RUN = "agrees", "differs", "unclear", "not run"
OURS = "Ours: mean ± standard error (independent {}){}"
WORDS = (
    "; difference in combined standard errors. *Agrees*: within two, these below a quarter of the number (of limits' "
    "width; of a one-sided limit: on its side by two). *Differs*: beyond three. *Unclear*: all else."
)


@dataclass(frozen=True)
class Row:
    """A number of ours, beside a paper's where it has one.

    Parameters
    ----------
    quantity : str
        What it is, with its place (velocity, size, ...) and unit in words; no two rows have the same.
    ours : Estimate
        Not run where its value is NaN.
    paper : float or (float or None, float or None), optional
        The paper's number, or the limits that its words set (None: open); left out where a phrase sets none.
    printed, source : str
        How the paper prints it ('' for a number that is ours alone), and its section or equation.
    runs : int, optional
        Independent runs behind the paper's number, which are taken to scatter as ours do.
    """

    quantity: str
    ours: Estimate
    paper: object = None
    printed: str = ""
    source: str = ""
    runs: int | None = None

    @property
    def limits(self):
        """(low, high) of the paper: its number twice, or limits, infinite where it sets none."""
        low, high = self.paper if isinstance(self.paper, tuple) else (self.paper, self.paper)
        return -math.inf if low is None else low, math.inf if high is None else high

    @property
    def combined(self):
        """Standard error of the difference (None without ours): the paper's runs scatter as our pairs do."""
        error, runs = self.ours.error, self.runs
        return error and (math.hypot(error, error * math.sqrt(self.ours.pairs / runs)) if runs else error)

    @property
    def difference(self):
        """How far ours lies beyond the paper's number or limits in combined standard errors, with its sign; None where
        that is not known."""
        if self.paper is None or not self.combined or math.isnan(self.ours.value):
            return None
        low, high = self.limits
        return (self.ours.value - float(np.clip(self.ours.value, low, high))) / self.combined

    @property
    def word(self):
        """One of the four words; '' for a number that is ours alone."""
        value, error = self.ours.value, self.ours.error
        low, high = self.limits
        if math.isnan(value):
            return NOT_RUN
        if self.paper is None:
            return UNCLEAR if self.printed else ""
        if not self.ours.pairs:
            return AGREES if low <= value <= high else DIFFERS
        if not error:
            return UNCLEAR
        if abs(self.difference) > 3:
            return DIFFERS
        if math.isinf(low) or math.isinf(high):
            return AGREES if min(value - low, high - value) >= 2 * error else UNCLEAR
        precise = self.combined < (abs(low) if low == high else high - low) / 4
        return AGREES if abs(self.difference) <= 2 and precise else UNCLEAR


def of_table(rows):
    """DataFrame with all numbers of the rows: what comparison.csv holds."""
    found = [
        {
            "quantity": row.quantity,
            "paper": row.printed,
            "low": None if row.paper is None else row.limits[0],
            "high": None if row.paper is None else row.limits[1],
            "source": row.source,
            "paper_runs": row.runs if row.printed else None,
            "ours": row.ours.value,
            "error": row.ours.error,
            "pairs": row.ours.pairs,
            "counted": row.ours.counted,
            "text": str(row.ours),
            "difference": row.difference,
            "word": row.word,
        }
        for row in rows
    ]
    if not found:
        return pandas.DataFrame(columns=["quantity", "text"])
    return pandas.DataFrame(found).replace([-np.inf, np.inf], np.nan).astype({"paper_runs": "Int64", "pairs": "Int64"})


def as_text(rows):
    """The table of pages and terminals, lines of words: its head, then quantity, paper, ours, difference, word."""
    yield "quantity", "paper", "ours", "difference", " "
    for row in rows:
        difference = "" if row.difference is None else f"{row.difference + 0.0:.1f}"
        if row.word == NOT_RUN:
            yield row.quantity, row.printed, NOT_RUN, difference, ""
        else:
            yield row.quantity, row.printed, str(row.ours), difference, row.word


def words_of(rows, independent):
    """What the cells of a table mean, and how many of its comparisons agree (str)."""
    own = OURS.format(independent, WORDS if counted(rows) else ".")
    return f"{own}\n{counted(rows)}".rstrip("\n")


def counted(rows):
    """One sentence on all comparisons with the paper; '' without any."""
    words = Counter(row.word for row in rows if row.printed)
    numbers = sum(row.difference is not None for row in rows)
    if not words:
        return ""
    parts = ", ".join(f"{words[word]} {word}" for word in (AGREES, DIFFERS, UNCLEAR, NOT_RUN))
    return (
        f"All {sum(words.values())} comparisons: {parts}. By chance alone {0.0455 * numbers:.1f} of {numbers} would "
        f"lie beyond two errors, {0.0027 * numbers:.1f} beyond three."
    )


def markdown_table(rows):
    """as_text() in Markdown (str)."""
    head, *lines = (" | ".join(cell.replace("|", "\\|") for cell in cells) for cells in as_text(rows))
    return "\n".join([f"| {head} |", "|" + "---|" * 5, *(f"| {line} |" for line in lines)])


def text_table(rows):
    """The same for a terminal, words to the left."""
    lines = list(as_text(rows))
    widths = [max(map(len, column)) for column in zip(*lines)]
    return "\n".join("  ".join(map(str.ljust, cells, widths)).rstrip() for cells in lines)


# ---- pages ----

START, END = "<!-- table: made by `make gallery` -->", "<!-- end of the table -->"
NUMBER = re.compile(r"\d+(?:\.\d+)? ± \d+(?:\.\d+)?")
STYLE = """body { font: 16px/1.5 Arial, sans-serif; color: #222; max-width: 62rem; margin: 2rem auto; padding: 0 1rem; }
img { max-width: 100%; } table { border-collapse: collapse; font-size: 0.8rem; }
th, td { padding: 0.15rem 0.5rem; border-bottom: 1px solid #ddd; text-align: left; vertical-align: top; }"""


def filled(file, text, rows, independent):
    """The text of a README (str) whose table, between its marks, has the rows that it lists made anew. Refused where
    it lacks the second mark, lists a quantity that no row has, or has a number with an error that no row has."""
    if text.count(START) != 1 or text.count(END) != 1:
        raise Refused(f"{file}: must have the lines {START} and {END} once")
    before, rest = text.split(START)
    table, after = rest.split(END)
    listed = [line.split(" | ")[0].removeprefix("| ") for line in table.splitlines() if line.startswith("| ")][1:]
    known = {row.quantity: row for row in rows}
    for quantity in listed:
        if quantity not in known:
            raise Refused(f"{file}: its table has {quantity}: must be a quantity of comparison.csv")
    require_numbers(file, before + after, [str(row.ours) for row in rows])
    shown = markdown_table([known[quantity] for quantity in listed])
    return f"{before}{START}\n\n{shown}\n\n{words_of(rows, independent)}\n\n{END}{after}"


def require_numbers(file, text, made):
    """Refused where a number with an error in a text (str), '54.0 ± 1.0', is in none of the numbers made ([str]),
    but for its sign."""
    known = {own for number in made for own in NUMBER.findall(number)}
    for number in NUMBER.findall(text):
        if number not in known:
            raise Refused(f"{file}: {number}: no study has this number; must be one of comparison.csv")


def html_page(study, rows, figures, lines):
    """One HTML page (str) that can be sent: the table of a study.Study of comparison.Rows, its figures [(caption, PNG
    file)], which are inside it, and lines that say where the runs come from."""
    # slow to load, and the numbers do without it
    import markdown

    about = markdown_table(rows), words_of(rows, study.independent), "\n".join(f"- {line}" for line in lines)
    text = "\n\n".join([study.question, *about])
    body = markdown.markdown(escape(text, quote=False), extensions=["tables", "sane_lists"])
    for caption, file in figures:
        picture = base64.b64encode(file.read_bytes()).decode("ascii")
        body += f'\n<p><img alt="{escape(caption)}" src="data:image/png;base64,{picture}"><br>{escape(caption)}</p>'
    title = escape(study.title)
    return (
        f'<!DOCTYPE html>\n<html lang="en">\n<head><meta charset="utf-8"><title>{title}</title>\n'
        f"<style>\n{STYLE}\n</style></head>\n<body>\n<h1>{title}</h1>\n{body}\n"
        f"<p>Version {version_text()}.</p>\n</body>\n</html>\n"
    )
