"""The pages of a study in Markdown: one screen that answers, and the details behind it. All studies have the same."""

from collections import Counter
from functools import partial

import pandas

from ..measures.outcome import UNDECIDED
from ..runs.collect import provenance_lines
from .estimate import EXACT
from .paper import PaperError
from .tables import claims_table, markdown_table, quantity_table, tests_table

TEXT_ALONE = "The paper enters by its text and printed numbers alone; its figures were not measured."
OURS = "Ours: mean ± standard error (independent {}); margins are ours. *Yes*, *no*: by the tests declared in paper.toml; *untested*: undecided, not run or without a test."
WORDS = (("How our set-up differs", "differs"), ("New", "new"), ("Missing, and what it would cost", "missing"))
DETAILS_FILE, PAGE_FILE = "details.md", "README.md"


def screen(analysis, pictures, prose):
    """The first screen (str) of an analyse.Analysis. pictures: {figure's name: (file name, caption)}; prose: whether the words of paper.toml
    are of these runs. PaperError where these name what there is not."""
    words, judged = analysis.words, [j for j in analysis.judgements if j.claim.row]
    parts = [f"# {analysis.study.title}", analysis.study.question]
    if words.paper:
        parts.append(f"Beside {words.paper}. {TEXT_ALONE}")
    parts.append(filled(words.verdict, analysis) if prose and words.verdict else counted(analysis.judgements))
    if words.figure in pictures:
        name, caption = pictures[words.figure]
        parts.append(f"![{words.figure}]({name})\n\n{caption}")
    if judged:
        parts += [markdown_table(claims_table(judged)), OURS.format(analysis.study.independent)]
    parts += [undecided(analysis.results.table, analysis.study)]
    for head, name in WORDS:
        text = getattr(words, name)
        if text and (prose or name == "differs"):
            parts.append(f"**{head}.**\n\n{filled(text, analysis)}")
    return _joined(parts)


def details(analysis, pictures, commands=()):
    """Everything behind the first screen (str): tests, predictions, every quantity, figures, where the runs come from."""
    parts = [f"# {analysis.study.title}: details"]
    if analysis.judgements:
        claims = [j.claim for j in analysis.judgements if j.claim.sentence]
        said = "\n".join(f"- {claim.label}: “{claim.sentence}” ({claim.source})" for claim in claims)
        parts += ["## Beside the paper", markdown_table(tests_table(analysis.judgements)), said]
    if analysis.predictions:
        table = pandas.DataFrame(analysis.predictions).rename(columns={"held": "held?"})
        parts += ["## Predictions, made before the runs", markdown_table(table)]
    parts.append("## Quantities")
    for quantity in analysis.listed:
        parts += [
            f"**{quantity.name}**{quantity.in_unit}: {quantity.meaning}",
            markdown_table(quantity_table(quantity)) if len(quantity.values) else "No runs.",
        ]
    if pictures:
        parts += ["## Figures", *(f"![{caption}]({name})\n\n{caption}" for name, caption in pictures.values())]
    lines = (*provenance_lines(analysis.found.provenance), *analysis.closures, *analysis.notes)
    parts += ["## Runs", "\n".join(f"- {line}" for line in lines), *(f"Made by `{command}`" for command in commands)]
    return _joined(parts)


def counted(judgements):
    """One sentence on how many of the comparisons with a paper these runs decide; '' without any."""
    if not judgements:
        return ""
    numbers = Counter(j.state for j in judgements)
    formulas = sum(j.state == "reproduced" and j.ours.pairs == EXACT for j in judgements)
    reproduced = f"{numbers['reproduced']} are reproduced" + (f" ({formulas} by formulas alone)" if formulas else "")
    return (
        f"Of {len(judgements)} comparisons with the paper (a statement at each size, velocity and rule is one) {reproduced} "
        f"and {numbers['contradicted']} contradicted; {numbers['undecided']} are undecided, {numbers['without a test']} without a test and "
        f"{numbers['not run']} not run."
    )


def undecided(table, study):
    """A sentence on runs of a definition.Study whose outcome is undecided; '' where there is none."""
    number = int((table.outcome == UNDECIDED).sum()) if "outcome" in table else 0
    return (
        f"Undecided: {number} of {len(table)} runs ended before their outcome was clear; {study.open_runs}."
        if number
        else ""
    )


def filled(text, analysis):
    """Words with their numbers: {{ say("quantity", column = value) }} gives '54.0 ± 1.0 m/s (4)', or 'not run'. PaperError for a
    quantity or column that there is not."""
    # slow to load, and the numbers do without it
    from jinja2 import Environment, StrictUndefined, TemplateError

    say = partial(number, analysis.results)
    try:
        return Environment(undefined=StrictUndefined).from_string(text.strip()).render(say=say)
    except (TemplateError, KeyError, ValueError) as error:
        raise PaperError(
            f"{analysis.study.name}: paper.toml: [page]: {error.args[0] if error.args else error}"
        ) from None


def number(results, name, **where):
    """'54.0 ± 1.0 m/s (4)' (str): a quantity of a definition.Results there, or 'not run'. KeyError for a name that there is not."""
    quantity = results[name]
    estimate = quantity.at(**where)
    if estimate is None:
        return "not run"
    shown = quantity.shown(estimate)
    return f"{shown!r} {quantity.unit}".rstrip() + shown.text.removeprefix(repr(shown))


def _joined(parts):
    return "\n\n".join(part.strip("\n") for part in parts if part) + "\n"
