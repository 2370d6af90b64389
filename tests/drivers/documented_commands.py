"""Runs the commands of README.md and docs/ as written, in a folder of its own: called by make test-docs.

A command that runs on after LONGEST seconds has started, and is ended. Left out are those with a name in
capitals, which stands for the reader's own.
"""

import re
import subprocess
from pathlib import Path

import pytest

TOP = Path(__file__).resolve().parents[2]
LONGEST = 120  # s
PAGES = [TOP / "README.md", *sorted((TOP / "docs").glob("*.md")), *sorted((TOP / "docs").glob("*.ipynb"))]
COMMAND = r"(?:^    |`)((?:yade -n -x|/usr/bin/python3|python3) [^`\n\\]*)"
LINES = dict.fromkeys(line.strip() for page in PAGES for line in re.findall(COMMAND, page.read_text(), re.M))
WRITTEN = [line for line in LINES if not re.search(r"\b[A-Z]{2,}\b", line.partition("#")[0])]


@pytest.fixture(scope="module")
def checkout(tmp_path_factory):
    """A folder with links to the checkout's, in which the demo has run, and an aggregate of three grains as text."""
    folder = tmp_path_factory.mktemp("checkout")
    for name in ("analysis", "contact_law", "yade_scripts", "build"):
        (folder / name).symlink_to(TOP / name)
    (folder / "agg.xyz").write_text("3\n\n" + "".join(f"C {0.199 * k} 0 0\n" for k in range(3)))
    run(folder, "yade -n -x yade_scripts/collide.py table=yade_scripts/studies/demo.table:4 out=runs/demo", 600)
    return folder


def run(folder, line, longest=LONGEST):
    command = ["timeout", str(longest), "bash", "-c", line]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    assert done.returncode in (0, 124) and "Traceback" not in done.stderr, f"{line}\n{done.stdout}{done.stderr}"


@pytest.mark.parametrize("line", WRITTEN)
def test_it_runs(checkout, line):
    run(checkout, re.sub(r"^python3", "/usr/bin/python3", line))
