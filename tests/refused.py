"""What cannot be done is refused in one line."""

from contextlib import contextmanager

import pytest


@contextmanager
def refused(kinds, *words):
    """The block must raise one of these exceptions, whose message is one line with all of these words in it."""
    with pytest.raises(kinds) as error:
        yield
    message = str(error.value)
    assert "\n" not in message and all(word in message for word in words), message
