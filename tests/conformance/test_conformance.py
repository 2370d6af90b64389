"""The conformance suite: its references come out of its generator, this law agrees, and a code that differs is told so."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

ROOM = Path(__file__).resolve().parent
sys.path[:0] = [str(ROOM), str(ROOM / "adapters")]
import check
import results_page
from answers import SUITE, answer

SAMPLE = "equilibrium hysteresis sliding rolling twisting two-at-once bond-tension bond-shear".split()
LEVELS = 2  # of three


def sampled(series_of):
    """Cases of the sample that differ, in words."""
    found = {
        c["id"]: check.verdict(c, answer(c, series_of, LEVELS), SUITE) for c in SUITE["cases"] if c["id"] in SAMPLE
    }
    return {name: check.in_words(one) for name, one in found.items() if one["said"] != "agrees"}


def test_the_references_are_what_the_generator_gives():
    quick = [case for case in SUITE["cases"] if case["id"] not in ("free-rotation", "viscous-drag")]
    command = [sys.executable, ROOM / "generator/generate.py", *(case["id"] for case in quick)]
    assert json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout) == quick
    assert len(SUITE["cases"]) == 20


@pytest.mark.in_yade
@pytest.mark.parametrize("code", ["engine", "functors"])
def test_this_law_agrees(code):
    import yade_codes

    yade_codes.CODE = code
    assert sampled(yade_codes.series_of) == {}


def test_the_toy_is_told_where_it_agrees(tmp_path):
    subprocess.run([sys.executable, ROOM / "toy/toy.py", ROOM / "cases.json", tmp_path / "toy.json"], check=True)
    found = check.verdicts(json.loads((tmp_path / "toy.json").read_text()))
    assert {name for name, one in found.items() if one["said"] == "agrees"} == {
        "equilibrium",
        "hysteresis",
        "oscillation",
    }
    assert {name for name, one in found.items() if one["said"] == "differs"} == {"collision", "sticking", "linear-drag"}
    assert max(found[name]["difference"] for name in ("collision", "sticking", "linear-drag")) < 2e-3
    assert check.main(tmp_path / "toy.json") == 1


@pytest.mark.parametrize("spoilt", [2e-6, None])
def test_a_value_that_is_wrong_is_noticed(spoilt):
    results = json.loads((ROOM / "results/engine.json").read_text())
    values = results["cases"]["twisting"]["values"]
    name = next(iter(values))
    values[name] = [v * (1 + spoilt) if spoilt else None for v in values[name]]
    found = check.verdicts(results)
    assert [case for case, one in found.items() if one["said"] != "agrees"] == ["twisting"]


def test_the_page_is_that_of_the_results():
    assert (ROOM / "results.md").read_text() == results_page.page()
