"""run.json from the start of a run to its end, and the line that says how it ended."""

import os
import platform
import re
import sys
import time
from contextlib import suppress

import numpy as np

from analysis.printable import printable
from yade_scripts.parameters.errors import tell
from yade_scripts.run import resuming
from yade_scripts.run.loop import one_line


def closing_line(path, outcome, seconds):
    """The last line that a script prints, by which a log says how its run ended: outcome_in() finds it."""
    return f"run folder: {printable(path)} ({printable(outcome)}, {seconds:.1f} s)"


def outcome_in(log):
    """The outcome in the text of a log, or None when the script didn't get to its end."""
    found = re.findall(r"^run folder: .*? \((completed|interrupted|failed: .*), [0-9.]+ s\)$", log, re.MULTILINE)
    return found[-1] if found else None


def made_with():
    """What run.json says of the software: its versions, and the plugin's commit. Called within YADE."""
    import yade.config

    import contact_law

    return {
        "versions": {
            "yade": yade.config.version,
            "python": sys.version.split()[0],
            "numpy": np.__version__,
            "contact_law": contact_law.__version__,
        },
        "commit": contact_law.commit,
    }


class Report:
    """Writes run.json at the start (outcome "running", which a killed run keeps) and at the end.

    about: what run.json has of the run beside software and hardware; start: of this process, on the clock of
    time.monotonic(); earlier: wall time [s] before interruptions.
    """

    def __init__(self, folder, about, start, earlier=0.0):
        self.folder, self.start = folder, start - earlier
        self.run = {**about, **made_with(), "hardware": hardware(), "endedBy": None}
        self.undecided = None  # why the run's outcome is

    def wall_time(self):
        """Seconds that the run has taken, those before interruptions included."""
        return time.monotonic() - self.start

    def begin(self):
        """Write the outcome "running"; raises OSError."""
        self._write("running")

    def end(self, outcome, status, time):
        """Write the outcome, the time that was reached [s] (None: none) and, if the run came to its end, the mark of
        that; print one line; the exit status, which is `status` unless something can't be written."""
        self.run["timeReached"] = time
        try:
            self._write(outcome)
            if outcome == "completed":
                self.folder.write_ended()
        except OSError as error:
            if not outcome.startswith("failed"):
                outcome, status = f"failed: {one_line(error)}", 1
                with suppress(OSError):
                    self._write(outcome)
        if outcome == "completed" and not self.undecided:
            with suppress(OSError):
                self.folder.remove_checkpoint()
        self._tell(outcome)
        return status

    def _write(self, outcome):
        self.folder.write_run({**self.run, "wallTime": self.wall_time(), "outcome": outcome})

    def _tell(self, outcome):
        """The last line of the log, and one on stderr for a failure; neither when it can't be written."""
        if outcome.startswith("failed"):
            tell(outcome)
        try:
            if self.run["endedBy"]:
                print(f"ended by {self.run['endedBy']}")
            if self.undecided:
                twice = resuming.command(self.folder.path, duration=2 * self.run["parameters"]["duration"])
                print(f"outcome undecided: {self.undecided}; to continue: {twice}")
            if outcome == "interrupted":
                print(f"to continue: {resuming.command(self.folder.path)}")
            print(closing_line(self.folder.path, outcome, self.wall_time()), flush=True)
        except OSError:  # what is left in the buffer would fail again at exit
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def hardware():
    """{'cpu': model, 'cores': number} of this machine."""
    model = platform.machine()
    try:
        with open("/proc/cpuinfo") as lines:
            names = (line.split(":", 1)[1].strip() for line in lines if line.startswith("model name"))
            model = next(names, model)
    except OSError:
        pass
    return {"cpu": model, "cores": os.cpu_count()}
