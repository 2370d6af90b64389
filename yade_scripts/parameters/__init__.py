"""Typed parameters of a script: a dataclass whose fields are the one list of columns.

Defaults, types, checks and the help text follow from the fields; each is made by parameter().
"""

import inspect
import typing
from dataclasses import dataclass, field, fields, replace
from functools import cache
from textwrap import fill
from typing import Any, Callable

from analysis.printable import suggested
from yade_scripts.parameters.arithmetic import NotANumber, evaluate
from yade_scripts.parameters.errors import InputError


class ParameterError(InputError, ValueError):
    """A wrong parameter; the message is one line: what, where, what it must be."""


class UnknownParameter(ParameterError):
    """A name that no parameter has."""

    def __init__(self, name, names):
        super().__init__(
            f"{_short(name)}: unknown parameter{suggested(name, names, '; must be one that --help lists')}"
        )


@dataclass(frozen=True)
class Check:
    """What a value must be, in words and as a test."""

    text: str
    accepts: Callable[[Any], bool]


POSITIVE = Check("> 0", lambda x: x > 0)
NOT_NEGATIVE = Check(">= 0", lambda x: x >= 0)
SWITCH = Check("0 or 1", lambda x: x in (0, 1))
MEANT = 1e9  # times that a value may lie outside of what is usual, if it is meant


@dataclass(frozen=True)
class Usual:
    """The range of a quantity in nature and in laboratories (SI), and its source: what lies outside was probably given
    in another unit."""

    low: float
    high: float
    source: str


def between(low, high):
    return Check(f"{low:g} to {high:g}" if isinstance(high, float) else f"{low} to {high}", lambda x: low <= x <= high)


def one_of(names):
    return Check(" or ".join(names), lambda text: text in names)


@dataclass(frozen=True)
class Column:
    """A field of Parameters, or the column of a table; type and name are those of the field."""

    default: Any  # None: it follows from the others
    check: Check
    meaning: str  # for the help text
    unit: str = ""
    word: str | None = None  # a text that a number's column may hold as well
    of_consequence: bool = True  # whether results depend on it
    usual: Usual | None = None  # a range outside of which unusual=1 must be given too
    name: str = ""
    kind: type = str

    def value(self, text):
        """The checked value of a text or number; raises ParameterError."""
        if self.word is not None and _unquoted(text) == self.word:
            return self.word
        value = _unquoted(text) if self.kind is str else self._number(text)
        if not self.check.accepts(value):
            raise ParameterError(f"{self.name} = {_short(text)}: {self.must}")
        return value

    def require_usual(self, value, meant):
        """Raise ParameterError where a number other than 0 lies outside of the usual range; with unusual=1 only where
        constants derived from it would not be numbers."""
        if not self.usual or not value:
            return
        factor = MEANT if meant else 1.0
        low, high = self.usual.low / factor, self.usual.high * factor
        if not low <= value <= high:
            why = "also with unusual=1" if meant else f"({self.usual.source}), or unusual=1 be given if it is meant"
            raise ParameterError(f"{self.name} = {value:g} {self.unit}: must be {low:g} to {high:g} {self.unit} {why}")

    @property
    def must(self):
        """'must be ...', with the unit."""
        return f"must be {self.check.text}" + (f" [{self.unit}]" if self.unit and self.unit != "1" else "")

    def _number(self, text):
        try:
            number = evaluate(_unquoted(text) if isinstance(text, str) else repr(text))
            converted = self.kind(number)
        except (NotANumber, OverflowError):
            raise ParameterError(f"{self.name} = {_short(text)}: not a finite number; {self.must}") from None
        if self.kind is int and number != converted:
            raise ParameterError(f"{self.name} = {_short(text)}: not a whole number; {self.must}")
        return converted

    def help(self):
        """Name, default and unit, meaning, what it must be."""
        default = "" if self.default is None else f" = {self.default:g}" if self.kind is float else f" = {self.default}"
        unit = f" [{self.unit}]" if self.unit else ""
        about = f"{self.meaning}; must be {self.check.text}"
        return f"  {self.name}{default}{unit}\n" + fill(about, 100, initial_indent=6 * " ", subsequent_indent=6 * " ")


@dataclass(frozen=True)
class Parameters:
    """Base of all parameters. The first line of a class's docstring is the heading of its fields in the help text."""

    @classmethod
    @cache
    def columns(cls):
        """{name: Column} of every field, a class's own before those of its bases; not to be changed."""
        by_name = {f.name: f for f in fields(cls)}
        order = [name for owner in cls.__mro__ for name in inspect.get_annotations(owner)]
        return {name: _column(by_name[name]) for name in dict.fromkeys(order)}

    @classmethod
    def parse(cls, texts, description=None):
        """Parameters from {name: text or number}, with what follows from them (filled_in()). Numbers may be written as
        arithmetic (10**0.5), text with or without quotes. description: of a table's row. Raises ParameterError."""
        columns, values = cls.columns(), {}
        for name, text in texts.items():
            if name not in columns:
                raise UnknownParameter(name, columns)
            values[name] = columns[name].value(text)
        for name, value in values.items():
            columns[name].require_usual(value, values.get("unusual"))
        return cls(**values).filled_in()

    @classmethod
    def help_text(cls):
        """The parameters under the headings of their classes."""
        columns, lines = dict(cls.columns()), ["Parameters, as name=value or as columns of a table:"]
        for owner in cls.__mro__:
            own = [name for name in inspect.get_annotations(owner) if name in columns]
            if own:
                lines += ["", owner.__doc__.splitlines()[0].rstrip(".") + ":"]
                lines += [columns.pop(name).help() for name in own]
        return "\n".join(lines)

    # (parameter, another one, those of its values with which the first has an effect)
    ONLY_WITH = ()

    def filled_in(self):
        """The same with what follows from the parameters alone; raises ParameterError where they contradict."""
        for name, other, values in self.ONLY_WITH:
            value, found = getattr(self, name), getattr(self, other)
            if value != self.columns()[name].default and found not in values:
                value, found = (x if isinstance(x, str) else f"{x:g}" for x in (value, found))
                raise ParameterError(f"{name} = {value}: given with {other} = {found}; must be left out")
        return self

    def changed(self, **values):
        """The same with other values of some fields."""
        return replace(self, **values)

    def as_dict(self):
        """{name: value} of every field, in the order of columns()."""
        return {name: getattr(self, name) for name in self.columns()}


def parameter(default, check, meaning, unit="", **more):
    """A field of Parameters, described as by Column; its annotation is the type: float, int or str, or with None."""
    return field(default=default, metadata={"column": Column(default, check, meaning, unit, **more)})


def _column(of):
    kinds = [kind for kind in typing.get_args(of.type) or (of.type,) if kind is not type(None)]
    kind = next((kind for kind in kinds if kind is not str), str)
    return replace(of.metadata["column"], name=of.name, kind=kind)


def _unquoted(text):
    text = str(text).strip()
    return text[1:-1] if len(text) >= 2 and text[0] in "'\"" and text[-1] == text[0] else text


def _short(text, longest=60):
    text = " ".join(str(text).split())
    return text if len(text) <= longest else text[:longest] + "..."
