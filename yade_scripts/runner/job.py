"""The run of one row: a process of YADE, started without a shell, so that names are never anything else than names."""

import os
import subprocess

from yade_scripts.runner.log import summary


class Job:
    """yade at work on a row (runner.rows.StudyRow), whose output goes to the file `log`.

    batch_row: FILE:LINE of the table that the script reads its parameters from; options: more of yade's; process: more of
    subprocess.Popen's.
    """

    def __init__(self, row, batch_row, log, options=(), **process):
        self.row = row
        self._log = open(log, "w")
        command = ["yade", "-n", f"--threads={row.threads}", *options, "-x", os.path.abspath(row.script)]
        try:
            self.process = subprocess.Popen(
                command,
                stdout=self._log,
                stderr=subprocess.STDOUT,
                stdin=subprocess.DEVNULL,
                env={**os.environ, "YADE_BATCH": batch_row, "DISPLAY": ""},
                **process,
            )
        except BaseException:
            self._log.close()
            raise

    def poll(self):
        """The run's exit status, as a shell has it; None while it runs. The log is complete then."""
        code = self.process.poll()
        if code is None:
            return None
        status = code if code >= 0 else 128 - code
        if not self._log.closed:
            with self._log:
                self._log.write(summary(status))
        return status
