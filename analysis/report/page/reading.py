"""What a line of beside_paper.Line can tell of a difference from the paper, in words."""

DIFFERS = 2.0  # errors from which a difference is called one
CHANCE = 0.05  # Student's, below which it is called one
COARSE = 0.3  # of the paper's value: an error larger than this tells little
FEWEST_SEEDS = 5  # of fewer, an error is uncertain by more than a third

NO_DIFFERENCE, DIFFERENCE, OPEN = "no difference found", "a difference", "not decided"
VERDICTS = (NO_DIFFERENCE, DIFFERENCE, OPEN)


def reading(record, seeds=None):
    """(verdict, why) of a Line's record (dict); ('', '') where the paper has no value.

    seeds: number of seeds of all runs (None: unknown). A difference is one of DIFFERS errors or more (of both, or of ours where
    there is none of the paper's) that Student's t finds less likely than CHANCE, where the error has degrees of freedom.

    >>> reading({"paper": 1.0, "error": 0.1, "difference": 0.5, "combined_difference": None, "chance": None}, 10)
    ('no difference found', '0.5 of our errors; the paper gives none')
    """
    paper, error = record["paper"], record["error"]
    if paper is None:
        return "", ""
    if record["difference"] is None:
        return OPEN, "no standard error of ours (see the note)"
    size = _size(record)
    if seeds is not None and seeds < FEWEST_SEEDS:
        return OPEN, f"{_seeds(seeds)}: the error itself is hardly known"
    far, why, chance = _units(record) >= DIFFERS, size, record["chance"]
    if chance is not None:
        far, why = far and chance < CHANCE, f"{size}; chance {chance:.2g}"
    verdict = DIFFERENCE if far else NO_DIFFERENCE
    if verdict == NO_DIFFERENCE and paper and abs(error / paper) > COARSE:
        return OPEN, f"our error is {100 * abs(error / paper):.0f} % of the paper's value"
    return verdict, why


def count(records, seeds=None):
    """{verdict: number of lines} of all records that stand beside a value of the paper."""
    found = [reading(record, seeds)[0] for record in records if "combined_difference" in record]
    return {verdict: found.count(verdict) for verdict in VERDICTS}


def _units(record):
    combined = record["combined_difference"]
    return abs(record["difference"] if combined is None else combined)


def _size(record):
    if record["combined_difference"] is None:
        return f"{_units(record):.1f} of our errors; the paper gives none"
    return f"{_units(record):.1f} errors of both"


def _seeds(seeds):
    return "one seed" if seeds == 1 else f"{seeds} seeds"
