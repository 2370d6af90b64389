"""Run every row of a table with yade-batch, and fail if a row failed (yade-batch itself returns 0 then, too).

    python3 yade_scripts/run_table.py yade_scripts/studies/seeds.table [options of yade-batch: -j 2, -l 4-7]

Logs go to runs/logs/. Exit status: 0 when every row's run came to its planned end, otherwise 1, with one line
on stderr for each row that did not. study.py does more: it skips what has ended, resumes, and estimates the time.
"""

import os
import re
import signal
import subprocess
import sys

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
from analysis.signals import end_quietly

end_quietly(signal.SIGINT)
from yade_scripts.run.table import TableError, read
from yade_scripts.runner.batch_command import LOGS, batch_command, failure

LONGEST = 255  # bytes of a file's name


def require_names(table):
    """Raise TableError when the table can't be read, or a description is too long for the name of a log."""
    for row in read(table):
        length = len(
            os.path.basename(log_name(table)).replace("%", str(row.line)).replace("@", row.description).encode()
        )
        if length > LONGEST:
            raise TableError(
                f"{table}: line {row.line}: its log's name would have {length} bytes; must be at most {LONGEST}, so the "
                "description shorter"
            )


def log_name(table):
    """Path of the logs, in which yade-batch puts a row's line for % and its description for @."""
    return os.path.join(LOGS, f"{os.path.splitext(os.path.basename(table))[0]}.%.@.log")


def run_batch(table, options):
    """Run yade-batch, its output passed on; returns what it printed. Raises OSError when it isn't there."""
    os.makedirs(LOGS, exist_ok=True)
    command = batch_command(table, log_name(table), options)
    lines = []
    # yade-batch ends without flushing: what it still had in its buffer would be lost.
    environment = {**os.environ, "PYTHONUNBUFFERED": "1"}
    with subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, env=environment
    ) as batch:
        for line in batch.stdout:
            print(line, end="", flush=True)
            lines.append(line)
    return batch.returncode, "".join(lines)


def log_files(output):
    """The logs of all jobs, from what yade-batch printed (a job that failed to start has one too)."""
    found = re.search(r"^Log files: (.*)$", output, re.MULTILINE)
    return found.group(1).split(" ") if found and found.group(1) else []


def main(arguments):
    if not arguments or arguments[0].startswith("-"):
        print(__doc__)
        return 0 if "--help" in arguments else 2
    table, *options = arguments
    if not os.path.isfile(table):
        sys.exit(f"run_table.py: {table}: no such table")
    try:
        require_names(table)
        status, output = run_batch(table, options)
    except TableError as error:
        sys.exit(f"run_table.py: {error}")
    except OSError as error:
        sys.exit(f"run_table.py: yade-batch: {error.strerror}")
    logs = log_files(output)
    failures = [text for text in map(failure, logs) if text]
    if status or not logs:
        failures.append(f"yade-batch: exit status {status}, {len(logs)} rows")
    for text in failures:
        sys.stderr.write(f"run_table.py: {text}\n")
    print(f"{len(logs)} rows, {len(failures)} failures")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
