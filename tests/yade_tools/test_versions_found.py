"""What the Makefile finds out of this system, and what it says of a YADE that has not been tried."""

import re
import subprocess
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]


def make(*arguments):
    return subprocess.run(["make", "--no-print-directory", *arguments], cwd=TOP, capture_output=True, text=True)


def test_another_yade_is_refused_in_one_line():
    done = make("known-yade", "YADE_VERSION=2027.1.0")
    lines = [line for line in done.stderr.splitlines() if not re.match(r"make(\[\d+\])?: \*\*\*", line)]
    assert done.returncode != 0 and len(lines) == 1
    assert "YADE 2027.1.0 is installed: must be one of 2023.02a 2025.2.0 2026.1.0" in lines[0]
    assert make("known-yade", "YADE_VERSION=2027.1.0", "YADE_INCLUDE=/source").returncode == 0
