"""Typed parameters of a script: a dataclass whose fields are the one list of columns.

Defaults, types, checks and the help text follow from the fields; each is made by parameter().
"""

import ast
import inspect
import math
import operator
import os
import sys
import typing
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field, fields, replace
from functools import cache
from itertools import chain
from textwrap import fill
from typing import Any, Callable

from analysis.printable import printable, suggested


class InputError(Exception):
    """Input that can't be used; the message is one line: what, where, what it must be."""


@contextmanager
def one_line_errors(script):
    """Within it wrong input, or a plugin that isn't built, ends the script with one line on stderr and status 2."""
    try:
        yield
    except (InputError, ImportError, MemoryError, OSError) as error:
        tell(one_line(error), script)
        sys.exit(2)


def one_line(error):
    """The message of an exception, on one line."""
    if isinstance(error, OSError) and error.filename:
        return f"{error.filename}: {error.strerror}"
    return " ".join(str(error).split()) or type(error).__name__


def tell(text, script=None):
    """One line on stderr that begins with the name of the script (this process's); nothing when it can't be written."""
    with suppress(OSError):
        print(printable(f"{script or os.path.basename(sys.argv[0])}: {text}"), file=sys.stderr, flush=True)


def show(text):
    """Print a text, as far as the reader (head, less) wants it."""
    try:
        print(text, flush=True)
    except BrokenPipeError:  # what is left in the buffer would fail again at exit
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


class ParameterError(InputError, ValueError):
    """A wrong parameter; the message is one line: what, where, what it must be."""


class UnknownParameter(ParameterError):
    """A name that no parameter has."""

    def __init__(self, name, names):
        hint = suggested(name, names, "; must be one that --help lists")
        super().__init__(f"{_short(name)}: unknown parameter{hint}")


@dataclass(frozen=True)
class Check:
    """What a value must be, in words and as a test."""

    text: str
    accepts: Callable[[Any], bool]


POSITIVE = Check("> 0", lambda x: x > 0)
NOT_NEGATIVE = Check(">= 0", lambda x: x >= 0)
SWITCH = Check("0 or 1", lambda x: x in (0, 1))


@dataclass(frozen=True)
class Usual:
    """The range of a quantity in nature and laboratories (SI); beyond, it was probably given in another unit."""

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
    before: Any = None  # what runs had that are older than this column; None: the default
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

    def require_usual(self, value):
        """Raise ParameterError where a number other than 0 lies outside of the usual range."""
        usual = self.usual
        if usual and value and not usual.low <= value <= usual.high:
            must = f"must be {usual.low:g} to {usual.high:g} {self.unit} ({usual.source})"
            raise ParameterError(f"{self.name} = {value:g} {self.unit}: {must}, or unusual=1 be given if it is meant")

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
        for name in () if values.get("unusual") else values:
            columns[name].require_usual(values[name])
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

    # (parameter, another one, those of its values with which the first has an effect), of a class and of its bases
    ONLY_WITH = ()

    def filled_in(self):
        """The same with what follows from the parameters alone; raises ParameterError where they contradict."""
        for name, other, values in chain(*(vars(owner).get("ONLY_WITH", ()) for owner in type(self).__mro__)):
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


# ---- numbers written as arithmetic, such as 10**0.5 or 2*pi/3: this grammar, and nothing else ----

LARGEST_EXPONENT = 1000
CONSTANTS = {"pi": math.pi, "e": math.e}
FUNCTIONS = {name: getattr(math, name) for name in ("sqrt", "exp", "log", "log10", "sin", "cos", "tan")}
OPERATORS = {ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: operator.truediv}
SIGNS = {ast.UAdd: operator.pos, ast.USub: operator.neg}


class NotANumber(ValueError):
    """A text that is no arithmetic."""


def evaluate(text):
    """The finite number (int or float) that a text stands for; raises NotANumber. Whole numbers stay whole under + - *
    and ** with a positive exponent."""
    try:
        number = _number(ast.parse(text.strip(), mode="eval").body)
        if math.isfinite(number):
            return number
    except (SyntaxError, ValueError, TypeError, ArithmeticError, MemoryError, RecursionError):
        pass
    raise NotANumber("not a finite number")


def _number(node):
    match node:
        case ast.Constant(value=value) if type(value) in (int, float):
            return value
        case ast.Name(id=name) if name in CONSTANTS:
            return CONSTANTS[name]
        case ast.UnaryOp(op=sign, operand=operand) if type(sign) in SIGNS:
            return SIGNS[type(sign)](_number(operand))
        case ast.BinOp(left=left, op=ast.Pow(), right=right):
            base, exponent = _number(left), _number(right)
            if abs(exponent) > LARGEST_EXPONENT:  # 9**9**9 would take long
                raise NotANumber
            return base**exponent  # complex for a root of a negative number: math.isfinite refuses it
        case ast.BinOp(left=left, op=operation, right=right) if type(operation) in OPERATORS:
            return OPERATORS[type(operation)](_number(left), _number(right))
        case ast.Call(func=ast.Name(id=name), args=[argument], keywords=[]) if name in FUNCTIONS:
            return FUNCTIONS[name](_number(argument))
    raise NotANumber
