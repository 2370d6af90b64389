"""What the README says, run as written."""

import re
import subprocess
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]

README = (TOP / "README.md").read_text()


def test_the_script_and_the_fused_line(yade):
    """The README's engines and the fused engine in their place, each with two grains that meet."""
    block = re.search(r"```python\n(.*?)```", README, re.S).group(1)
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
    """Every make target, script and table that the README names exists, and the analysis answers."""
    known = subprocess.run(["make", "-pRrq", ":"], cwd=TOP, capture_output=True, text=True).stdout
    for target in re.findall(r"`?make ([a-z]+(?:-[a-z]+)*)", README):
        assert re.search(rf"^{target}:", known, re.M), target
    for path in re.findall(r"(?:yade_scripts|contact_law|tests)/[\w./]*\w/?", README):
        assert (TOP / path.rstrip("/")).exists(), path
    assert (
        subprocess.run(["/usr/bin/python3", "-m", "analysis", "--help"], cwd=TOP, capture_output=True).returncode == 0
    )
