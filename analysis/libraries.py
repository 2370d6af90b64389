"""Whether this Python has what the suite needs: for scripts, before they import it."""

import sys
from importlib.util import find_spec
from pathlib import Path

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
