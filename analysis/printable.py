"""Names and values from outside, as a terminal may see them."""

import shlex
import sys
from difflib import get_close_matches

LISTED = 20  # names in a message
FAILED = 2  # exit status


class Refused(ValueError):
    """What cannot be done, or used; the message is one line that says why."""


def printable(text):
    """One line of a text (or of anything's str()): what is not printable becomes an escape, as with ls -b.

    >>> print(printable("a\\x1b[31mb\\nc \\u00e4 \\udcff"))
    a\\x1b[31mb\\nc \u00e4 \\xff
    """
    return "".join(c if c.isprintable() else _escape(c) for c in str(text))


def printable_lines(text):
    """printable() of each line of a text."""
    return "\n".join(map(printable, text.split("\n")))


def shell_line(words):
    """A command, as one may paste it into a shell; words: strings and paths.

    >>> print(shell_line(["ls", "my runs", "$x"]))
    ls 'my runs' '$x'
    """
    words = [str(word) for word in words]
    return " ".join(shlex.quote(word) if word.isprintable() else f"$'{_ansi_c(word)}'" for word in words)


def complain(message):
    """One line on stderr."""
    print(printable(f"analysis: {message}"), file=sys.stderr, flush=True)


def suggested(name, names, many=""):
    """The end of a message about a name that isn't one of `names`: which is close, and all of them, or `many` in
    place of a long list.

    >>> suggested("velocty", ["velocity", "seed"])
    ' (did you mean velocity?); must be one of velocity, seed'
    """
    names = list(map(str, names))
    hint = meant(str(name), names)
    return hint + (many if hint and len(names) > LISTED else f"; must be one of {', '.join(names)}")


def meant(name, names):
    """' (did you mean ...?)' with that one of `names` which is close to a name; or ''."""
    close = get_close_matches(name, names, 1)
    return f" (did you mean {close[0]}?)" if close else ""


def _escape(c):
    if 0xDC80 <= ord(c) <= 0xDCFF:  # a byte of a file's name that is no UTF-8
        return f"\\x{ord(c) - 0xDC00:02x}"
    return c.encode("unicode_escape").decode()


def _ansi_c(word):
    return "".join(f"\\{c}" if c in "\\'" else c if c.isprintable() else _escape(c) for c in word)
