"""What the public functions are given, checked where it comes in: WrongArgument says which argument, its value and
what it must be.

@takes(position=numbers("N,3"), radius=numbers("N", POSITIVE), contact_pairs=PAIRS) is all that a function says of
it."""

import os
from collections.abc import Mapping
from dataclasses import dataclass
from functools import wraps
from inspect import signature
from itertools import zip_longest
from typing import Callable

import numpy as np

from .printable import printable
from .runs.format import CHANNELS

LONGEST = 60  # characters of a value in a message
LIKE_VALUES = "None", "True", "False", "nan", "inf"  # texts that are quoted


class WrongArgument(ValueError, TypeError):
    """An argument that cannot be; the message is one line: its name and value, and what it must be."""


def wrong(name, value, must):
    """The WrongArgument of an argument."""
    return WrongArgument(f"{name} = {shown(value)}: must be {must}")


def shown(value):
    """A value in a message: one short line.

    >>> shown("ice"), shown("5"), shown([0.1, None]), shown(np.zeros((9, 3))), shown({1: 2}.items())
    ('ice', "'5'", '[0.1, None]', 'array (9, 3)', 'a dict_items')
    """
    if isinstance(value, np.ndarray) and value.ndim:
        return f"array {value.shape}"
    if not isinstance(value, (str, bytes, int, float, complex, list, tuple, dict, np.generic, type(None))):
        return f"a {type(value).__name__}"
    plain = (
        isinstance(value, np.generic) or isinstance(value, str) and value.isidentifier() and value not in LIKE_VALUES
    )
    text = printable(value if plain else repr(value))
    return text if len(text) <= LONGEST else text[:LONGEST] + "..."


def takes(**kinds):
    """Decorator of a function whose arguments of these names must be of these kinds: objects with require(name,
    value, sizes). None passes where it is the default."""

    def of(function):
        defaults = {name: each.default for name, each in signature(function).parameters.items()}

        @wraps(function)
        def checking(*given, **named):
            values, sizes = {**dict(zip(defaults, given)), **named}, {}
            for name, kind in kinds.items():
                if name in values and not (values[name] is None and defaults[name] is None):
                    kind.require(name, values[name], sizes)
            return function(*given, **named)

        return checking

    return of


# What numbers must be, in words ({}: "number" or "numbers") and as a test.
FINITE = "finite {}", np.isfinite
POSITIVE = "{} > 0", lambda x: (x > 0) & (x < np.inf)
NOT_NEGATIVE = "{} >= 0", lambda x: (x >= 0) & (x < np.inf)
WHOLE = "whole {} >= 0", lambda x: (x >= 0) & (x == np.floor(x)) & (x < np.inf)
COUNT = "whole {} >= 1", lambda x: (x >= 1) & (x == np.floor(x)) & (x < np.inf)
NOT_NAN = "{}", lambda x: x == x
ANY = "{} or NaN", lambda x: np.full(np.shape(x), True)


@dataclass(frozen=True)
class Numbers:
    """Numbers of a shape, each of which is_right(): letters stand for sizes, one letter for the same in all arguments
    of a call, N for at least 1; '' is one number, '...' any shape, 'N,3 or 3' either."""

    shape: str
    words: str
    is_right: Callable

    def require(self, name, value, sizes):
        must = self._must(sizes)
        try:
            array = np.asarray(value)
        except ValueError:  # lists of unequal length
            raise wrong(name, value, must) from None
        if array.dtype.kind not in "fiu":
            raise wrong(name, value, must)
        if not self._fits(array.shape, sizes):
            raise WrongArgument(f"{name}: has shape {array.shape}; must be {must}")
        right = self.is_right(array)
        if not np.all(right):
            raise wrong(name, array[~right].flat[0], must)

    def _fits(self, shape, sizes):
        return self.shape == "..." or any(_fits(each, shape, sizes) for each in self.shape.split(" or "))

    def _must(self, sizes):
        if self.shape in ("", "..."):
            return "a " + self.words.format("number")
        known = {"N": ">= 1"} | {letter: f"= {size}" for letter, size in sizes.items()}
        where = "".join(f", {letter} {size}" for letter, size in known.items() if letter in self.shape)
        return self.words.format("numbers") + f" ({self.shape}{',' * self.shape.isalpha()}){where}"


def numbers(shape="...", right=FINITE):
    """Kind of an array of numbers; right: (words, which are right)."""
    return Numbers(shape, *right)


def number(right=FINITE):
    """Kind of one number."""
    return Numbers("", *right)


def _fits(letters, shape, sizes):
    for letter, size in zip_longest(filter(None, letters.split(",")), shape):
        if letter is None or size is None or letter.isdigit() and size != int(letter):
            return False
        if letter.isalpha() and (sizes.setdefault(letter, size) != size or letter == "N" and size == 0):
            return False
    return True


@dataclass(frozen=True)
class Kind:
    """Anything that is_right()."""

    must: str
    is_right: Callable

    def require(self, name, value, sizes):
        if not self.is_right(value):
            raise wrong(name, value, self.must)


class Pairs:
    """Pairs of grains (M,2): rows of the arrays of size N, where there is one."""

    def require(self, name, value, sizes):
        empty = value.size == 0 if isinstance(value, np.ndarray) else value in ([], ())
        if not empty:
            right = lambda x: WHOLE[1](x) & (x < sizes.get("N", np.inf))
            below = f" and < {sizes['N']}" if "N" in sizes else ""
            numbers("M,2", (WHOLE[0] + below, right)).require(name, value, {})


class GrainCount:
    """A number of grains, which is N."""

    def require(self, name, value, sizes):
        number(WHOLE).require(name, value, sizes)
        sizes["N"] = int(value)


class History:
    """Arrays (T,) of the energy channels by name; names: of others that it must have."""

    def __init__(self, *names):
        self.names = (*names, *CHANNELS)

    def require(self, name, value, sizes):
        if not isinstance(value, Mapping):
            raise wrong(name, value, "a dict of arrays, as run.history")
        for each in self.names:
            if each not in value:
                raise WrongArgument(f"{name}: lacks {each!r}; must have {', '.join(self.names)}, as run.history")
            numbers("N", ANY).require(f"{name}[{each!r}]", value[each], sizes)


PAIRS, GRAIN_COUNT = Pairs(), GrainCount()


def one_of(*names):
    """Kind of a word that must be one of these names."""
    return Kind(" or ".join(name or "''" for name in names), lambda value: isinstance(value, str) and value in names)


FLAG = Kind("True or False", lambda value: isinstance(value, (bool, np.bool_)))
PATH = Kind("a path", lambda value: isinstance(value, (str, os.PathLike)) and os.fspath(value) != "")
NAMES = Kind(
    "a list of names", lambda value: isinstance(value, (list, tuple)) and all(isinstance(name, str) for name in value)
)
