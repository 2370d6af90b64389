"""What a script does before it imports anything large: signals that end it quietly, libraries that it needs."""

import os
import signal
import sys
from contextlib import suppress
from importlib.util import find_spec
from pathlib import Path

ENDING = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
NEEDED = ("numpy", "scipy", "pandas", "matplotlib", "tqdm", "jinja2", "markdown", "PIL")


def require_libraries():
    """Ends the process with one line on stderr and exit status 2 where some are missing."""
    active = os.environ.get("VIRTUAL_ENV")
    if active and os.path.realpath(active) != os.path.realpath(sys.prefix):  # IPython, in YADE, puts it first
        sys.path[:] = [folder for folder in sys.path if not folder.startswith(active + os.sep)]
    if problem := missing_libraries():
        script = Path(sys.argv[0])
        print(f"{'analysis' if script.name == '__main__.py' else script.name}: {problem}", file=sys.stderr)
        sys.exit(2)


def missing_libraries():
    """A line about what this Python lacks; None when it has all."""
    if sys.version_info < (3, 10):
        return (
            f"{sys.executable} is Python {sys.version.split()[0]}: must be 3.10 or later (/usr/bin/python3 after make)"
        )
    missing = [name for name in NEEDED if find_spec(name) is None]
    if not missing:
        return None
    return f"{sys.executable} has no {', '.join(missing)}: must be a Python that has (/usr/bin/python3 after make)"


def end_quietly(*numbers):
    """From now on these signals end the process with status 128 + number, without a traceback, and what it has begun to
    write goes; to be called before slow imports. One that is ignored (nohup, a job in the background) stays so. What
    the terminal's encoding can't write is escaped."""
    for stream in (sys.stdout, sys.stderr):
        with suppress(AttributeError):  # another kind of stream
            stream.reconfigure(errors="backslashreplace")
    for number in numbers:
        if signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, lambda number, frame: sys.exit(128 + number))
