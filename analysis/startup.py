"""What a script does before it imports anything large: signals that end it quietly, libraries that it needs."""

import signal
import sys
from importlib.util import find_spec
from pathlib import Path

ENDING = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
NEEDED = ("numpy", "scipy", "pandas", "matplotlib", "tqdm", "jinja2", "markdown", "PIL")


def require_libraries():
    """Ends the process with one line on stderr and exit status 2 where some are missing."""
    missing = [name for name in NEEDED if find_spec(name) is None]
    if not missing:
        return
    script = Path(sys.argv[0])
    name = "analysis" if script.name == "__main__.py" else script.name
    need = "must be a Python that has (/usr/bin/python3 after make)"
    print(f"{name}: {sys.executable} has no {', '.join(missing)}: {need}", file=sys.stderr)
    sys.exit(2)


def end_quietly(*numbers):
    """From now on these signals end the process with status 128 + number, without a traceback, and what it has begun to
    write goes; to be called before slow imports. One that is ignored (nohup, a job in the background) stays so."""
    for number in numbers:
        if signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, lambda number, frame: sys.exit(128 + number))
