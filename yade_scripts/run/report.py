"""run.json from the start of a run to its end, and the line that says how it ended."""

import os
import platform
import sys
import time

import numpy as np

from yade_scripts.run import checkpoint
from yade_scripts.run.closing_line import closing_line


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

    about: what run.json tells of the run beside software and hardware; start: of this process, on the clock of
    time.monotonic(); earlier: wall time [s] before interruptions.
    """

    def __init__(self, folder, about, start, earlier=0.0):
        self.folder, self.start = folder, start - earlier
        self.run = {**about, **made_with(), "hardware": hardware()}
        self._write("running")

    def wall_time(self):
        """Seconds that the run has taken, those before interruptions included."""
        return time.monotonic() - self.start

    def end(self, outcome, time):
        """Write the outcome, the time that was reached [s] (None: none) and, if the run came to its end, the mark of that;
        print one line."""
        self.run["timeReached"] = time
        self._write(outcome)
        if outcome == "completed":
            self.folder.write_ended()
            checkpoint.remove(self.folder.path)
        if outcome.startswith("failed"):
            sys.stderr.write(f"{os.path.basename(sys.argv[0])}: {outcome}\n")
        print(closing_line(self.folder.path, outcome, self.wall_time()), flush=True)

    def _write(self, outcome):
        self.folder.write_run({**self.run, "wallTime": self.wall_time(), "outcome": outcome})


def hardware():
    """{'cpu': model, 'cores': number} of this machine."""
    model = platform.processor() or platform.machine()
    try:
        with open("/proc/cpuinfo") as lines:
            names = (line.split(":", 1)[1].strip() for line in lines if line.startswith("model name"))
            model = next(names, model)
    except OSError:
        pass
    return {"cpu": model, "cores": os.cpu_count()}
