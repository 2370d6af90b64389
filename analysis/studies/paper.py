"""A paper's numbers as data: NAME/paper.toml (or beside a study of one's own), and what the page of a study says in words. All keys:

[page]
paper = "Arakawa, Tanaka & Kokubo (2022)"     # written out: it heads the page
figure = "fig03_mean_growth"                   # the one figure on it
runs = 5                                       # of every claim that doesn't say otherwise; 1 where it is left out
sentence                                       # what was found, in one sentence that can be quoted: on the page above all studies
verdict, differs, new, missing                 # Markdown; {{ say("quantity", column = value) }} stands for "54.0 ± 1.0 m/s". All but
                                               # differs are of the gallery's runs, and on no other page

[[claim]]
quantity = "v_fra"                             # of the study
label = "threshold velocity of fragmentation"  # how a table names it
where = { grains = 50000, viscoelasticTime = 0 }   # SI; {name} in the label stands for a value. Of lists each combination, and of a list of
                                               # such places each, is a claim of its own; any other key may then list a value for each
value = 50.0        # as printed, in the quantity's unit; or low and/or high: limits that the paper's words set (-inf, inf: none)
printed = "50 to 60 m/s"                       # how the paper prints it
source = "section 3.2"
sentence = "..."                               # the sentence it is from
runs = 1                                       # independent pairs of aggregates behind the paper's number; inf: it has no error
looks = 1           # how often our pairs were looked at, more added after each look: each counts as a test (Bonferroni)
margin = 5.0        # agreement: our interval of the difference (or our interval) within this of the value (or of the limits), in their unit; else 0
note = "a phrase"   # why it is shown, and not in the page's family of tests (test = false says the same without a reason)
row = true          # on the page's first screen; 8 claims at most"""

from dataclasses import dataclass, field, fields
from itertools import product

import numpy as np

try:
    import tomllib
except ModuleNotFoundError:  # Python 3.10
    import tomli as tomllib

from ..arguments import FINITE, NOT_NEGATIVE, Kind, WrongArgument, number, shown

FILE = "paper.toml"
MOST_ROWS = 8
INF = float("inf")
# What the value of a key must be, by its name or else by its type.
MUST = {
    "value": number(FINITE),
    "low": number(("{} or -inf", lambda x: x < INF)),
    "high": number(("{} or inf", lambda x: x > -INF)),
    "margin": number(("finite {} >= 0", NOT_NEGATIVE[1])),
    "runs": number(("whole {} >= 1, or inf", lambda x: (x >= 1) & (x == np.floor(x)))),
    "looks": number(("whole {} >= 1", lambda x: (x >= 1) & (x < INF) & (x == np.floor(x)))),
    str: Kind("text", lambda value: isinstance(value, str)),
    bool: Kind("true or false", lambda value: isinstance(value, bool)),
    dict: Kind("a table", lambda value: isinstance(value, dict)),
}


class PaperError(Exception):
    """A paper.toml that can't be used; the message is one line: which, where, what it must be."""


@dataclass(frozen=True)
class Claim:
    """One number or statement of a paper, as the head of this file describes it."""

    quantity: str
    label: str
    printed: str
    source: str
    where: dict = field(default_factory=dict)
    value: float = None
    low: float = None
    high: float = None
    sentence: str = ""
    runs: int = 1
    looks: int = 1
    margin: float = 0.0
    test: bool = True
    row: bool = False
    note: str = ""

    @property
    def limits(self):
        """(low, high) that it sets: its value twice, or limits, infinite where it sets none."""
        if self.value is not None:
            return self.value, self.value
        return (-INF if self.low is None else self.low), (INF if self.high is None else self.high)


@dataclass(frozen=True)
class Page:
    """Words of a page: paper (its name, written out), figure (name of the figure on the first screen), sentence, verdict, differs, new, missing
    (Markdown with numbers by say()); runs: Claim.runs of claims that don't say it."""

    paper: str = ""
    figure: str = ""
    runs: int = 1
    sentence: str = ""
    verdict: str = ""
    differs: str = ""
    new: str = ""
    missing: str = ""


def read_paper(folder):
    """(Page, (Claim, ...)) of a study's folder (Path; None: a study without one); empty where it has no paper.toml. PaperError."""
    file = folder / FILE if folder else None
    if file is None or not file.is_file():
        return Page(), ()
    try:
        content = tomllib.loads(file.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise PaperError(f"{file}: {error}") from None
    page, blocks = content.pop("page", {}), content.pop("claim", [])
    if not (isinstance(page, dict) and isinstance(blocks, list) and all(isinstance(block, dict) for block in blocks)):
        raise PaperError(f"{file}: must have one [page] at most, and [[claim]] above each claim")
    page = _made(Page, page, f"{file}: [page]")
    blocks = [(f"{file}: claim {k}", block) for k, block in enumerate(blocks, 1)]
    claims = tuple(_claim(own, page.runs, where) for where, block in blocks for own in _each(block, where))
    if content:
        raise PaperError(f"{file}: has {', '.join(content)}: must have page and claim alone")
    if sum(claim.row for claim in claims) > MOST_ROWS:
        raise PaperError(f"{file}: {sum(c.row for c in claims)} claims with row = true: must be {MOST_ROWS} at most")
    return page, claims


def _each(block, where):
    """The claims of a block: one for each of the places that its `where` lists. A key that has a list has a value for each; the first has the
    sentence."""
    where = _labelled(where, block)
    places = _places(block.get("where", {}))
    if not places or not all(isinstance(place, dict) for place in places):
        raise PaperError(
            f"{where}: where = {shown(block['where'])}: must be a table of levels, or a list of such tables"
        )
    for name, values in block.items():
        if name != "where" and isinstance(values, list) and len(values) != len(places):
            raise PaperError(f"{where}: {name} has {len(values)} values: must be {len(places)}, one for each place")
    for k, place in enumerate(places):
        own = {name: value[k] if isinstance(value, list) else value for name, value in block.items()}
        own["where"] = place
        if k and not isinstance(block.get("sentence"), list):
            own["sentence"] = ""
        try:
            own |= {"label": own["label"].format(**place)} if isinstance(own.get("label"), str) else {}
        except (LookupError, ValueError, AttributeError):
            raise PaperError(f"{where}: label: what it has in {{}} must be of where: {', '.join(place)}") from None
        yield own


def _labelled(where, block):
    return f"{where} ({block.get('label', 'without label')})"


def _places(where):
    """[{level: value}] of a list of them, or all combinations of the values that one lists."""
    if not isinstance(where, dict):
        return where if isinstance(where, list) else []
    values = [value if isinstance(value, list) else [value] for value in where.values()]
    return [dict(zip(where, chosen)) for chosen in product(*values)]


def _claim(values, runs, where):
    values = {"runs": runs, "test": not values.get("note"), **values}
    where = _labelled(where, values)
    claim = _made(Claim, values, where)
    low, high = claim.limits
    if claim.test and (low, high) == (-INF, INF):
        raise PaperError(f"{where}: is tested, and has no number: must have value, low or high")
    if low > high:
        raise PaperError(f"{where}: low = {low}: must be at most high, {high}")
    return claim


def _made(kind, values, where):
    known = {f.name: f.type for f in fields(kind)}
    if unknown := sorted(set(values) - set(known)):
        raise PaperError(f"{where}: has {', '.join(unknown)}: must be of {', '.join(sorted(known))}")
    try:
        for name, value in values.items():
            MUST.get(name, MUST.get(known[name])).require(name, value, {})
        return kind(**values)
    except (WrongArgument, TypeError) as error:
        raise PaperError(f"{where}: {str(error).split('__init__() ')[-1]}") from None
