"""What was expected before runs were made: NAME/predictions.csv, a row each.

what, commit        the prediction in words, and the commit that made it
quantity, where, low, high   of the study, as in paper.toml (where: "grains=50000; velocity=50.1", SI; limits in the quantity's unit):
                    what was run, and whether it held, follow from the runs
expected, run, held    without a quantity, as it was decided at the time: expected and run in words"""

import math

import pandas

from .estimate import EXACT
from .paper import Claim, PaperError
from .verdict import NO, UNTESTED, YES, judge

FILE = "predictions.csv"
COLUMNS = ("what", "quantity", "where", "low", "high", "expected", "commit", "run", "held")
HELD = {YES: "yes", NO: "no", UNTESTED: "not decided"}


def predictions(folder, results):
    """[{what, expected, commit, run, held: words}] of a study's folder (Path; None: a study without one), beside definition.Results. PaperError."""
    file = folder / FILE if folder else None
    if file is None or not file.is_file():
        return []
    try:
        table = pandas.read_csv(file, comment="#", dtype=str, keep_default_na=False)
    except ValueError as error:
        raise PaperError(f"{file}: {error}") from None
    if tuple(table.columns) != COLUMNS:
        raise PaperError(f"{file}: its columns are {', '.join(table.columns)}: must be {', '.join(COLUMNS)}")
    rows = table.to_dict("records")
    try:
        judged = iter(judge([_claim(row) for row in rows if row["quantity"]], results))
    except ValueError as error:
        raise PaperError(f"{file}: {error}") from None
    return [_prediction(row, next(judged) if row["quantity"] else None) for row in rows]


def _claim(row):
    limits = {name: float(row[name]) for name in ("low", "high") if row[name]}
    if not limits or not limits.get("low", -math.inf) <= limits.get("high", math.inf):
        raise ValueError(
            f"{row['what']}: low = {row['low']}, high = {row['high']}: must be numbers, one or both, low <= high"
        )
    where = {
        name.strip(): _value(value) for name, _, value in (part.partition("=") for part in row["where"].split(";"))
    }
    return Claim(row["quantity"], row["what"], "", "", where, runs=EXACT, **limits)


def _value(text):
    try:
        return float(text)
    except ValueError:
        return text


def _prediction(row, judgement):
    words = {name: row[name] for name in ("what", "expected", "commit", "run", "held")}
    if judgement is None:
        return words
    low, high, unit = row["low"], row["high"], f" {judgement.unit}" if judgement.unit else ""
    expected = f"{low} to {high}" if low and high else f"at least {low}" if low else f"at most {high}"
    held = "not run" if judgement.ours is None else HELD[judgement.verdict]
    return {**words, "expected": expected + unit, "run": judgement.ours_text, "held": held}
