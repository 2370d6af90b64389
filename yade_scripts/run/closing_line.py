"""The last line that a script prints, by which a log tells how its run ended."""

import re

from analysis.printable import printable


def closing_line(path, outcome, seconds):
    """What a script prints at its end; outcome_told() finds it in a log."""
    return f"run folder: {printable(path)} ({printable(outcome)}, {seconds:.1f} s)"


def outcome_told(log):
    """The outcome in the text of a log, or None when the script didn't get to its end."""
    found = re.findall(r"^run folder: .*? \((completed|interrupted|failed: .*), [0-9.]+ s\)$", log, re.MULTILINE)
    return found[-1] if found else None
