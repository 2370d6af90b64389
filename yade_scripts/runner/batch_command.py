"""yade-batch's command line, and what its logs say of a run."""

import os
import re
import shutil

from yade_scripts.run.closing_line import read_closing_line

DEFAULT_SCRIPT = os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "collide.py")
LOGS = os.path.join("runs", "logs")


def batch_command(table, log, options=()):
    """yade-batch's command line; log: a path in which % stands for a row's line and @ for its description.

    Rows without a column !SCRIPT are collisions.
    """
    return [
        "yade-batch",
        "--disable-pynotify",
        "--plot-update",
        "0",
        "--executable",
        shutil.which("yade") or "yade",
        "--log",
        log,
        *options,
        table,
        DEFAULT_SCRIPT,
    ]


def failure(log_file):
    """One line that says why the run of a log failed, or None when it came to its planned end."""
    try:
        with open(log_file, errors="replace") as file:
            log = file.read()
    except OSError as error:
        return f"{log_file}: {error.strerror}"
    closing = read_closing_line(log)
    if closing is None:
        message = re.findall(r"^[\w.-]+\.py: .*$", log, re.MULTILINE)
        return f'{log_file}: {message[-1] if message else "the script did not come to its end"}'
    folder, outcome = closing
    if outcome != "completed" or not os.path.exists(os.path.join(folder, "ended")):
        return f"{log_file}: {folder}: {outcome}"
    return None
