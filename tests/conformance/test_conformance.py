"""The conformance suite: its references come out of its generator, and this law agrees with them."""

import json
import sys
from pathlib import Path

import pytest

ROOM = Path(__file__).resolve().parent
sys.path[:0] = [str(ROOM), str(ROOM / "adapters"), str(ROOM / "generator")]
import check
from answers import SUITE, answer

# The functors and the engine are equal step by step (tests/equivalence): the engine alone runs the long cases.
SAMPLE = {"functors": "equilibrium hysteresis sliding rolling twisting two-at-once under-load bond-tension bond-shear"}
SAMPLE["engine"] = f"{SAMPLE['functors']} turning-slip chain"
FREE = "collision bond-break chain"  # others: make conformance
CASES = {case["id"]: case for case in SUITE["cases"]}
LEVELS = 2  # of three


def test_the_references_are_what_the_generator_gives(monkeypatch):
    import generate

    slow = (generate.tangential.free_rotation, generate.tangential.chain, generate.normal.viscous_drag)
    monkeypatch.setattr(generate, "CASES", [made for made in generate.CASES if made not in slow])
    quick = [case for case in SUITE["cases"] if case["id"] not in ("free-rotation", "chain", "viscous-drag")]
    assert json.loads(json.dumps(generate.suite())) == {**SUITE, "cases": quick}
    assert len(SUITE["cases"]) == 23


@pytest.mark.in_yade
@pytest.mark.parametrize("code", SAMPLE)
def test_this_law_agrees(code):
    import yade_codes

    yade_codes.CODE = code
    for name in SAMPLE[code].split():
        found = check.compare_case(CASES[name], answer(CASES[name], yade_codes.series_of, LEVELS), SUITE)
        assert found["word"] == "agrees", (name, found["why"])


@pytest.mark.parametrize("case", FREE.split())
def test_the_ensemble_agrees_where_grains_are_free(case):
    import ensemble_code

    found = check.compare_case(CASES[case], answer(CASES[case], ensemble_code.series_of), SUITE)
    assert found["word"] == "agrees", found["why"]


def results(case="sliding"):
    """A results file that has a case's reference values."""
    values = {question["name"]: [float(question["value"])] * 2 for question in CASES[case]["asked"]}
    return {"suite": SUITE["version"], "cases": {case: {"steps": [2e-12, 1e-12], "values": values}}}


def test_a_case_agrees_only_where_all_is_answered_but_the_ledger():
    word = lambda given: check.compare_cases(given)["collision"]["word"]
    given = results("collision")
    values = given["cases"]["collision"]["values"]
    assert word(given) == "agrees"
    values["energy lost as it breaks"] = None
    assert word(given) == "agrees"
    del values["time of the break"]
    assert word(given) == "incomplete"
    values["greatest overlap"][-1] *= 1 + 2e-6
    assert word(given) == "differs"


def test_errors_that_fall_as_the_step_are_no_difference():
    word = lambda given: check.compare_cases(given)["sliding"]["word"]
    given = results()
    values = next(iter(given["cases"]["sliding"]["values"].values()))
    exact = values[0]
    for errors, verdict in (((2e-3, 1.05e-3), check.CONVERGES), ((2e-3, 1.5e-3), "differs")):
        values[:] = [exact * (1 + error) for error in errors]
        assert word(given) == verdict


def test_results_that_cannot_be_compared_are_refused_in_a_line(tmp_path):
    given, path = results(), tmp_path / "results.json"
    given["cases"]["sliding"]["steps"].reverse()
    path.write_text(json.dumps(given))
    with pytest.raises(SystemExit, match="the longest first"):
        check.main(str(path))


def test_samples_of_aggregates_are_compared(tmp_path, capsys):
    suite, path = json.loads((ROOM / "ensembles.json").read_text()), tmp_path / "samples.json"
    same = {d["id"]: d["values"] for d in suite["distributions"]}
    for spoilt, status in ({}, 0), ({"bcca-sticking": [1.0] * 60}, 1):
        path.write_text(json.dumps({"suite": suite["version"], "samples": {**same, **spoilt}}))
        assert check.main(str(path)) == status
        assert capsys.readouterr().out.count("differs") == status
