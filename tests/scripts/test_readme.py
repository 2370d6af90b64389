"""What the README says, run as written."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

TOP = Path(__file__).resolve().parents[2]

sys.path.insert(0, str(TOP))
from yade_scripts.runner import cost, rows  # noqa: E402

BYTES_A_GRAIN = 130  # of a state
README = (TOP / "README.md").read_text()
# The other documents that name commands.
DOCUMENTS = [
    TOP / name for name in ("README.md", "analysis/STUDIES.md", "yade_scripts/RUNS.md", "contact_law/SCRIPTS.md")
]


def test_the_script_and_the_fused_line(yade):
    """The README's engines and the fused engine in their place, each with two grains that meet."""
    block = re.search(r"```python\n(import contact_law.*?)```", README, re.S).group(1)
    fused = re.search(r"`(O\.engines = \[JKRWadaEngine.*?\])`", README).group(1)
    found = yade(f"""
from yade import utils
def two_grains():
    O.bodies.clear(); O.interactions.clear(); O.energy.clear(); O.forces.reset()
    for x, v in ((0, 1), (2.01e-7, -1)):
        body = utils.sphere((x, 0, 0), 1e-7, material=ice)
        body.state.vel = (v, 0, 0)
        O.bodies.append(body)
{block}
two_grains()
O.run(1000, True)
result["functors"] = O.energy["connection"]
O.dt *= 50
{fused}
two_grains()
O.run(20, True)
result["fused"] = O.energy["connection"]
""")
    assert found["functors"] > 0 and abs(found["fused"] / found["functors"] - 1) < 0.02


def test_the_commands_are_there():
    """Every make target, script, table and file that the documents name exists, and the analysis answers."""
    known = subprocess.run(["make", "-pRrq", ":"], cwd=TOP, capture_output=True, text=True).stdout
    for document in DOCUMENTS:
        text = document.read_text().replace("study-NAME", "study-viscous").replace("NAME", "viscous")
        for target in re.findall(r"(?:^    |`)make ([a-z]+(?:-[a-z]+)*)", text, re.M):
            assert re.search(rf"^{target}:", known, re.M), f"{document.name}: {target}"
        for path in re.findall(r"(?<![\w/])(?:yade_scripts|contact_law|analysis|tests)/[\w./-]*\w/?", text):
            assert (TOP / path.rstrip("/")).exists(), f"{document.name}: {path}"
        for link in re.findall(r"\]\((?!https?:|#)([^)]+)\)", text):
            assert (document.parent / link).exists(), f"{document.name}: {link}"
    assert (
        subprocess.run(["/usr/bin/python3", "-m", "analysis", "--help"], cwd=TOP, capture_output=True).returncode == 0
    )


def test_the_table_of_studies_is_that_of_their_tables():
    """Runs, contact updates and disk in STUDIES.md are what the tables give."""
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
