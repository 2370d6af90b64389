"""The conformance suite: its references come out of its generator, this law agrees, and a code that differs is told so."""

import json
import random
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOM = Path(__file__).resolve().parent
sys.path[:0] = [str(ROOM), str(ROOM / "adapters")]
import check
import check_ensembles
import results_page
from answers import SUITE, answer

SAMPLE = "equilibrium hysteresis sliding rolling twisting two-at-once under-load turning-slip bond-tension bond-shear".split()
LEVELS = 2  # of three


def sampled(series_of):
    """Cases of the sample that differ, in words."""
    cases = {case["id"]: case for case in SUITE["cases"]}
    found = {name: check.verdict(cases[name], answer(cases[name], series_of, LEVELS), SUITE) for name in SAMPLE}
    return {name: check.in_words(one) for name, one in found.items() if one["said"] != "agrees"}


def test_the_references_are_what_the_generator_gives():
    quick = [case for case in SUITE["cases"] if case["id"] not in ("free-rotation", "viscous-drag")]
    command = [sys.executable, ROOM / "generator/generate.py", *(case["id"] for case in quick)]
    assert json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout) == quick
    assert len(SUITE["cases"]) == 22


@pytest.mark.in_yade
@pytest.mark.parametrize("code", ["engine", "functors"])
def test_this_law_agrees(code):
    import yade_codes

    yade_codes.CODE = code
    assert sampled(yade_codes.series_of) == {}


def test_the_toy_is_told_where_it_agrees(tmp_path):
    subprocess.run([sys.executable, ROOM / "toy/toy.py", ROOM / "cases.json", tmp_path / "toy.json"], check=True)
    found = check.verdicts(json.loads((tmp_path / "toy.json").read_text()))
    said = lambda word: {name: one for name, one in found.items() if one["said"] == word}
    assert set(said("agrees")) == {"equilibrium", "hysteresis", "oscillation"}
    assert set(said("differs")) == {"collision", "sticking", "linear-drag"}
    assert max(one["difference"] for one in said("differs").values()) < 2e-3
    assert check.main(tmp_path / "toy.json") == 1


@pytest.mark.parametrize("spoilt", [2e-6, None])
def test_a_value_that_is_wrong_is_noticed(spoilt):
    results = json.loads((ROOM / "results/engine.json").read_text())
    values = results["cases"]["twisting"]["values"]
    name = next(iter(values))
    values[name] = [v * (1 + spoilt) if spoilt else None for v in values[name]]
    found = check.verdicts(results)
    assert [case for case, one in found.items() if one["said"] != "agrees"] == ["twisting"]


def test_a_case_agrees_only_where_all_is_answered_but_the_ledger():
    results = json.loads((ROOM / "results/engine.json").read_text())
    values = results["cases"]["collision"]["values"]
    values["energy lost as it breaks"] = None
    assert check.verdicts(results)["collision"]["said"] == "agrees"
    del values["time of the break"]
    found = check.verdicts(results)["collision"]
    assert (found["said"], found["answered"]) == ("incomplete", (5, 7))
    assert check.in_words(found).startswith("incomplete (5 of 7 answered")
    values["greatest overlap"][-1] *= 1.001
    assert check.verdicts(results)["collision"]["said"] == "differs"


@pytest.mark.parametrize(
    "spoil, said",
    [
        (lambda cases: cases.update(colision=cases.pop("collision")), "colision: must be one of equilibrium, "),
        (lambda cases: cases["sliding"]["values"].update(work=[1, 1, 1]), "sliding: work: must be one of force1.y of "),
        (lambda cases: cases["sliding"].update(steps=[1e-11] * 3), r"sliding: steps \[1e-11, .*: must be two or more"),
        (lambda cases: cases["sliding"]["steps"].reverse(), "sliding: steps .*the longest first"),
        (lambda cases: cases["sliding"].update(steps=[1e-11]), r"sliding: steps \[1e-11\]: must be two or more"),
        (lambda cases: cases["sliding"]["steps"].pop(), "sliding: force1.y of .*: 3 values: must be 2, one a step"),
        (lambda cases: cases["sliding"].pop("steps"), "KeyError.*: must be a results file"),
    ],
)
def test_results_that_cannot_be_compared_are_refused(tmp_path, spoil, said):
    results = json.loads((ROOM / "results/engine.json").read_text())
    spoil(results["cases"])
    path = tmp_path / "results.json"
    path.write_text(json.dumps(results))
    with pytest.raises(SystemExit, match=said):
        check.main(path)


def test_the_page_is_that_of_the_results():
    assert (ROOM / "results.md").read_text() == results_page.page()


def test_pairs_that_differ_are_told_from_pairs_that_scatter():
    assert results_page.paired_p([0.1] * 12) < 0.001
    assert results_page.paired_p([0.1, -0.1] * 6) > 0.9


ENSEMBLES = json.loads(check_ensembles.ENSEMBLES.read_text())


def test_a_sample_that_is_shifted_is_noticed_as_often_as_is_said():
    """Samples drawn from each distribution's own values: their level holds, and of those shifted by what is said to be found by
    90 % at least three quarters are (values are not normal, and few)."""
    draw, level = random.Random(2), ENSEMBLES["level"] / len(ENSEMBLES["distributions"])
    wrong, seen, number = 0, 0, 0
    for values in (d["values"] for d in ENSEMBLES["distributions"] if set(d["values"]) != {0.0, 1.0}):
        shift = check_ensembles.found_shift(values, level, len(values))
        for _ in range(5):
            sample = [draw.choice(values) for _ in values]
            wrong += check_ensembles.p_value(sample, values) < level
            seen += check_ensembles.p_value([x + shift for x in sample], values) < level
            number += 1
    assert wrong == 0 and seen > 0.75 * number


def test_samples_are_compared(tmp_path, capsys):
    same = {d["id"]: d["values"] for d in ENSEMBLES["distributions"]}
    for spoilt, status in ({}, 0), ({"bcca-sticking": [1.0] * 60}, 1):
        path = tmp_path / "samples.json"
        path.write_text(json.dumps({"code": "x", "suite": ENSEMBLES["version"], "samples": {**same, **spoilt}}))
        assert check_ensembles.main(path) == status
        assert capsys.readouterr().out.count("differs") == status


@pytest.mark.parametrize(
    "samples, words",
    [
        ({"cpe": [1.0, 2.0]}, "cpe: must be one of cpe-0.4"),
        ({"bcca-pressure-0.1": [50.0, 60.0, 70.0]}, "3 runs: must be 4 or more, which can differ"),
        ({"bpca-largest-50": [float("inf"), *[1.0] * 9]}, "must be finite"),
    ],
)
def test_samples_that_cannot_be_compared_are_refused(tmp_path, samples, words):
    path = tmp_path / "samples.json"
    path.write_text(json.dumps({"suite": ENSEMBLES["version"], "samples": samples}))
    with pytest.raises(SystemExit, match=words):
        check_ensembles.main(path)


MAPPING = json.loads((ROOM / "on_dem/yade_mapping.json").read_text())


@pytest.mark.in_yade
def test_the_mapping_for_on_dem_has_every_field_and_what_it_names_is_there():
    from yade.wrapper import JKRMat, JKRWadaPhys

    source = (ROOM / "on_dem/jkr_wada.py").read_text()
    for (name, fields), one in zip(MAPPING.items(), (JKRMat(), JKRWadaPhys())):
        own = source.split(f"class {name}(")[1].split("\nclass ")[0]
        assert set(re.findall(r"^    (\w+): ", own, re.M)) == set(fields)
        assert all(hasattr(one, path.rsplit(".")[-1]) for path in fields.values())


@pytest.mark.in_yade
@pytest.mark.parametrize("code", ["engine", "functors"])
def test_pointers_of_the_mapping_for_on_dem_are_in_the_global_frame(code):
    """Of a pair whose bodies have an orientation from the start, and then turn."""
    import yade_codes
    from yade import O, Quaternion, Vector3

    yade_codes.CODE, steps = code, 100
    scene = next(case for case in SUITE["cases"] if case["id"] == "two-at-once")["scenes"]["space"]
    spins = [Vector3(spin) for spin in scene["prescribed"][0]["spin"]]
    bodies = [O.bodies[i] for i in yade_codes.place(scene, SUITE["materials"])]
    sys.modules["__main__"].drive = lambda: None
    for body, spin in zip(bodies, spins):
        body.state.ori, body.state.angVel = Quaternion(Vector3(1, 2, 3), 1.0), spin
    O.dt, O.engines = 1e-12, yade_codes.engines({})
    O.run(steps, True)
    known = dict(O=O, i=O.interactions[bodies[0].id, bodies[1].id])
    for name, spin, start in zip(("pointer1", "pointer2"), spins, (Vector3(1, 0, 0), Vector3(-1, 0, 0))):
        turned = Quaternion(spin.normalized(), spin.norm() * steps * O.dt) * start
        assert (eval(MAPPING["jkr_wada_interaction"][name], known) - turned).norm() < 1e-12
