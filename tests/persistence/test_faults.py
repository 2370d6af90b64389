"""Runs that are killed, or find the disk full, at one of their file-system calls, lose nothing.

Here a part of all faults is tried; `make test-faults` tries every one of them (faults/).
"""

import re
import subprocess
from pathlib import Path

import pytest
from faults import scenarios
from faults.commands import COMMANDS, WRITERS, Trial
from faults.scenarios import RECORDER, RUN, SCENARIOS, enumerated, enumerated_stops, power_loss
from running import small_disk

from analysis.runs.write import is_unfinished

FIT = "contact_law/kernel/fit_contact_radius.py"  # writes a header of the code
BEGINNING = 24  # calls, in which a folder is begun or emptied


@pytest.mark.parametrize("scenario", SCENARIOS, ids=lambda scenario: scenario.name)
def test_no_fault_loses_anything(bench, scenario):
    """Every 23rd call, each with each fault; a prime number, so that all kinds of calls come up."""
    cases = list(enumerated(bench, scenario, every=23, offset=len(scenario.name) % 23))
    assert len(cases) > 6 and not [case for case in cases if case.wrong]


def test_a_folder_that_was_begun_or_emptied_halfway_can_be_used(bench):
    """The end of an ended run's mark and files, one by one."""
    scenario = SCENARIOS[2]
    calls = bench.calls(scenario)[:BEGINNING:3]
    assert {"ended", "history.npz", "run.json"} <= {call.path for call in bench.calls(scenario)[:BEGINNING]}
    cases = [bench.case(scenario, "ends before", call) for call in calls]
    assert not [case for case in cases if case.wrong]


@pytest.mark.parametrize("fault", ["ends before", "disk full from"])
def test_no_fault_at_the_heartbeat_of_a_resumed_run(bench, fault):
    """Every call that makes, replaces or removes one of its files."""
    scenario = SCENARIOS[1]
    calls = [call for call in bench.calls(scenario) if "heartbeat" in call.path]
    assert {call.name for call in calls} >= {"link", "rename", "unlink"}
    cases = [bench.case(scenario, fault, call) for call in calls]
    assert not [case for case in cases if case.wrong]


def test_sigterm_during_a_checkpoint_and_then_sigkill(bench):
    """What batch systems do: the checkpoint that is being written isn't written again in place."""
    cases = list(enumerated_stops(bench, 2, every=37))
    assert len(cases) > 8 and not [case for case in cases if case.wrong]


def test_the_calls_are_those_of_all_files(bench):
    """The injector sees every file that a run leaves or has had, down to what C++ writes."""
    calls = bench.calls(SCENARIOS[0])
    written = {call.path for call in calls if call.name == "rename"}
    states = {f"states/{number:06d}.npz" for number in range(4)}
    scenes = {f"checkpoint/scene-{step}.yade" for step in range(1, 7)}
    assert written == states | scenes | {"run.json", "history.npz", "ended", RECORDER, "heartbeat.json"}
    removed = {call.path for call in calls if call.name.startswith(("unlink", "rmdir"))}
    assert {path for path in removed if not is_unfinished(path)} == scenes | {
        RECORDER,
        "checkpoint",
        "heartbeat.json",
        ".heartbeat-1",
    }


@pytest.mark.parametrize("scenario", SCENARIOS, ids=lambda scenario: scenario.name)
def test_a_power_loss_takes_nothing_that_counts(bench, scenario):
    assert power_loss(bench.calls(scenario)) == []


def test_what_a_power_loss_takes_is_noticed(bench):
    """The judge of the test above, on calls without one of the fsyncs that matter."""
    calls = bench.calls(SCENARIOS[0])
    for path in ("history.npz", "states", "states/000002.npz", "checkpoint"):
        assert power_loss([call for call in calls if (call.name, call.path) != ("fsync", path)]), path


def test_every_module_that_writes_files_is_known():
    """Another one needs a row, or a reason why it has none. Nothing opens a file for writing but runs/write.py, logs and the code's fits."""
    top = Path(__file__).resolve().parents[2]
    files = [file for folder in ("analysis", "yade_scripts", "contact_law") for file in (top / folder).rglob("*.py")]
    texts = {str(file.relative_to(top)): file.read_text() for file in files}
    writes = re.compile(r"\b(write_text|write_bytes|write_json|replacing|make_new|unfinished)\(")
    opens = re.compile(r"""\bopen\([^)]*, "[rbt]*[wxa+][bt+]*"|\.(write_text|write_bytes)\(""")
    own = "analysis/runs/write.py"
    assert {name for name, text in texts.items() if writes.search(text) and name != own} == {*WRITERS, FIT}
    assert {name for name, text in texts.items() if opens.search(text)} == {own, "yade_scripts/runner/workers.py", FIT}


@pytest.mark.parametrize(
    "name, every", [("analysis export", 29), ("make_packing", 4), ("analysis view", 3), ("study --slurm", 7)]
)
def test_no_fault_leaves_half_of_what_a_command_writes(forks, tmp_path, name, every):
    command = next(command for command in COMMANDS if command.name == name)
    cases = list(Trial(forks, command, tmp_path).cases(every))
    assert len(cases) > 3 and not [case for case in cases if case.wrong]


@pytest.mark.parametrize("size", [16, 24, 32, 40])
def test_a_disk_that_is_really_full(forks, tmp_path, size):
    """A small file system in memory; size in kB. A run needs less than 80."""
    with small_disk(tmp_path / "disk", f"{size}k") as disk:
        done = forks.run(RUN, disk / "run")
        wrong = scenarios.wrong_on_a_full_disk(done)
        assert done.status and not wrong, wrong
        subprocess.run(["mount", "-o", "remount,size=4m", disk], check=True)
        assert forks.run(RUN + ("resume=1",), disk / "run").status == 0
        straight = forks.run(RUN, tmp_path / "straight")
        assert straight.status == 0
        assert scenarios.arrays(disk / "run") == scenarios.arrays(tmp_path / "straight")
