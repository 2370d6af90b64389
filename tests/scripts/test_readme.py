"""What the README says, run as written."""

import re
import subprocess
from pathlib import Path

import pytest
from scenes import *

from yade_scripts.runner import cost, rows

TOP = Path(__file__).resolve().parents[2]

BYTES_A_GRAIN = 130  # of a state
README = (TOP / "README.md").read_text()
DOCUMENTS = [TOP / name for name in "README.md analysis/STUDIES.md yade_scripts/RUNS.md contact_law/SCRIPTS.md".split()]


@pytest.mark.in_yade
def test_the_script_and_the_fused_line():
    """The README's engines and the fused engine in their place, each with two grains that meet."""
    block = re.search(r"```python\n(import contact_law.*?)```", README, re.S).group(1)
    fused = re.search(r"`(O\.engines = \[JKRWadaEngine.*?\])`", README).group(1)
    connection = []
    for engines, together in ((block, 1), (f"{block}\nO.dt *= 50\n{fused}", 50)):
        O.reset()
        names = dict(globals())
        exec(engines, names)
        for x, v in ((0, 1), (2.01e-7, -1)):
            grain((x, 0, 0), 1e-7, names["ice"], (v, 0, 0))
        O.run(1000 // together, True)
        connection.append(O.energy["connection"])
    assert connection[0] > 0 and abs(connection[1] / connection[0] - 1) < 0.02


def test_the_commands_are_there():
    known = subprocess.run(["make", "-pRrq", ":"], cwd=TOP, capture_output=True, text=True).stdout
    for document in DOCUMENTS:
        text = document.read_text().replace("study-NAME", "study-viscous").replace("NAME", "viscous")
        for target in re.findall(r"(?:^    |`)make ([a-z]+(?:-[a-z]+)*)", text, re.M):
            assert re.search(rf"^{target}:", known, re.M), f"{document.name}: {target}"
        for path in re.findall(r"(?<![\w/])(?:yade_scripts|contact_law|analysis|tests)/[\w./-]*\w/?", text):
            assert (TOP / path.rstrip("/")).exists(), f"{document.name}: {path}"
        for link in re.findall(r"\]\((?!https?:|#)([^)]+)\)", text):
            assert (document.parent / link).exists(), f"{document.name}: {link}"
    subprocess.run(["/usr/bin/python3", "-m", "analysis", "--help"], cwd=TOP, capture_output=True, check=True)


def test_the_table_of_studies_is_that_of_their_tables():
    study, seen = None, set()
    for line in (TOP / "analysis/STUDIES.md").read_text().splitlines():
        cells = [cell.strip() for cell in line.split("|")[1:-1]]
        if len(cells) != 8 or cells[2] not in ("first", "desk", "full", "own", "beyond", "prediction"):
            continue
        study = cells[0].strip("`") or study
        found = rows.read(str(TOP / f"yade_scripts/studies/{study}-{cells[2]}.table"))
        assert int(cells[3]) == len(found), line
        assert float(cells[4]) == pytest.approx(sum(map(cost.contact_updates, found)), rel=0.05), line
        grains = sum(row.estimate.grains * row.parameters.states for row in found)
        assert float(cells[7].split()[0]) == pytest.approx(grains * BYTES_A_GRAIN * 1e-9, rel=0.2), line
        seen.add((study, cells[2]))
    assert len(seen) == 12
