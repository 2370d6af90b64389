"""The last line that a script prints, by which a log tells how its run ended."""

import re


def closing_line(path, outcome, seconds):
    """What a script prints at its end; read_closing_line() finds it in a log."""
    return f"run folder: {path} ({outcome}, {seconds:.1f} s)"


def read_closing_line(log):
    """(path, outcome) from the text of a log, or None when the script didn't get to its end."""
    line = r"^run folder: (.*?) \((completed|interrupted|failed: .*), [0-9.]+ s\)$"
    found = re.findall(line, log, re.MULTILINE)
    return found[-1] if found else None
