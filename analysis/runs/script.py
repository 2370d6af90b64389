"""A user's own Python file."""

from types import ModuleType


def module_of(file, name):
    """The module of this name that a file (path, str) defines; whatever its code raises, and OSError. Nothing is left
    beside the file, as import would leave compiled code, which it takes for that of another file of the same second
    and size."""
    module = ModuleType(name)
    module.__file__ = file
    with open(file, "rb") as source:
        exec(compile(source.read(), file, "exec"), module.__dict__)
    return module
