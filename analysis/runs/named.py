"""Read-only mappings that say what they hold when a wrong name is asked for."""

from collections.abc import Mapping

import numpy as np

from ..printable import suggested


class UnknownName(KeyError, AttributeError):
    """A name that a mapping or a state doesn't have; the message is one line, with those that it has."""

    def __str__(self):
        return self.args[0]


class Named(Mapping):
    """Values by name; what: whose they are, in messages. Arrays are read-only."""

    def __init__(self, what, values):
        self._what, self._values = what, dict(values)
        protect(self._values)

    def __getitem__(self, name):
        if name not in self._values:
            raise unknown(self._what, name, self._values)
        return self._values[name]

    def __getattr__(self, name):
        if name.startswith("_"):  # what copying and notebooks ask every object for
            raise AttributeError(name)
        self[name]
        raise UnknownName(f'{self._what}: {name} is no attribute; must be read as ["{name}"]')

    def __iter__(self):
        return iter(self._values)

    def __len__(self):
        return len(self._values)

    def __repr__(self):
        return f"{self._what}: {', '.join(self._values)}"

    def __setstate__(self, state):
        self.__dict__.update(state)
        protect(self._values)

    def _ipython_key_completions_(self):
        return list(self._values)


def unknown(what, name, names):
    """UnknownName for a name that isn't one of `names`; many are not listed where one is close."""
    return UnknownName(f"{what}: no {name}{suggested(name, names)}")


def protect(values):
    """Make the arrays of a dict read-only, as they must be again after pickling."""
    for value in values.values():
        if isinstance(value, np.ndarray):
            value.flags.writeable = False
