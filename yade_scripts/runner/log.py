"""The log of a row's run: all that it printed, and how it ended, in the words of yade-batch."""

import os
import re
import signal

from yade_scripts.run.closing_line import outcome_told

STOPPED = (128 + signal.SIGINT, 128 + signal.SIGTERM)


def summary(status):
    """What a log ends with; status: of the run, as a shell has it. Nothing for a run that was stopped, which is none that failed."""
    return "" if status in STOPPED else f"\nJOB SUMMARY\nstatus  : {status << 8} ({'FAILED' if status else 'OK'})\n"


def failure(log, folder):
    """Why the run of a log and a run folder (paths) failed, in one line; None when it did not, was stopped, or is under way."""
    if not os.path.isfile(log):  # a pipe would be waited for
        return None
    try:
        with open(log, errors="replace") as file:
            text, _, end = file.read().partition("JOB SUMMARY")
    except OSError:
        return None
    status = re.search(r"^status  : (\d+)", end, re.MULTILINE)
    if not status:
        return None
    code = int(status.group(1)) >> 8
    if code > 128 and code not in STOPPED:
        return f"killed by signal {code - 128}"
    outcome = outcome_told(text)
    if outcome is None:
        message = re.findall(r"^[\w.-]+\.py: .*$", text, re.MULTILINE)
        return message[-1] if message else "the script did not come to its end"
    return None if outcome == "completed" else f"{folder}: {outcome}"
