"""Runs that are killed, or find the disk full, at one of their file-system calls, lose nothing.

Here a part of all faults is tried; `make test-faults` tries every one of them (faults/).
"""

import re
import subprocess
from pathlib import Path

import pytest
from faults.commands import COMMANDS, RECORDER, RUN, SCENARIOS, WRITERS, arrays, ended_runs
from faults.trial import power_loss, wrong_on_a_full_disk
from running import small_disk

from analysis.runs.files import is_unfinished

FIT = "contact_law/kernel/fit_contact_radius.py"  # writes a header of the code
BEGINNING = 24  # calls, in which a folder is begun or emptied


NEW, RESUMED, REPLACING, _ = SCENARIOS
each_scenario = pytest.mark.parametrize("scenario", SCENARIOS, ids=lambda scenario: scenario.name)


@each_scenario
def test_no_fault_loses_anything(trial_of, scenario):
    """Every 23rd call, each with each fault; a prime number, so that all kinds of calls come up."""
    trial = trial_of(scenario)
    assert trial.whole == ended_runs(trial.folder / "run")  # of a run without a stop
    cases = list(trial.cases(23, offset=len(scenario.name.removeprefix("collide: ")) % 23))
    assert len(cases) > 6 and not [case for case in cases if case.wrong]


def test_a_folder_that_was_begun_or_emptied_halfway_can_be_used(trial_of):
    """The end of an ended run's mark and files, one by one."""
    trial = trial_of(REPLACING)
    calls = trial.calls[:BEGINNING]
    assert {"ended", "history.npz", "run.json"} <= {call.path for call in calls}
    cases = [trial.case(call, "ends before") for call in calls[::3]]
    assert not [case for case in cases if case.wrong]


@pytest.mark.parametrize(
    "scenario, file, names", [(RESUMED, "heartbeat", {"link", "rename", "unlink"}), (NEW, "ended", {"write", "rename"})]
)
@pytest.mark.parametrize("fault", ["ends before", "disk full from"])
def test_no_fault_at_a_small_file(trial_of, scenario, file, names, fault):
    """Every call that makes, replaces or removes one: heartbeats, and the mark of the end."""
    trial = trial_of(scenario)
    calls = [call for call in trial.calls if file in call.path]
    assert {call.name for call in calls} >= names
    cases = [trial.case(call, fault) for call in calls]
    assert not [case for case in cases if case.wrong]


def test_sigterm_during_a_checkpoint_and_then_sigkill(trial_of):
    """What batch systems do: the checkpoint that is being written isn't written again in place."""
    cases = list(trial_of(NEW).stops(2, every=37))
    assert len(cases) > 8 and not [case for case in cases if case.wrong]


def test_the_calls_are_those_of_all_files(trial_of):
    """The injector sees every file that a run leaves or has had, down to what C++ writes."""
    calls = trial_of(NEW).calls
    written = {call.path for call in calls if call.name == "rename"}
    states = {f"states/{number:06d}.npz" for number in range(4)}
    scenes = {f"checkpoint/scene-{step}.yade" for step in range(1, 7)}
    assert written == states | scenes | {"run.json", "history.npz", "ended", RECORDER, "heartbeat.json"}
    removed = {call.path for call in calls if call.name.startswith(("unlink", "rmdir"))}
    others = {RECORDER, "checkpoint", "heartbeat.json", ".heartbeat-1"}
    assert {path for path in removed if not is_unfinished(path)} == scenes | others


@each_scenario
def test_a_power_loss_takes_nothing_that_counts(trial_of, scenario):
    assert power_loss(trial_of(scenario).calls) == []


def test_what_a_power_loss_takes_is_noticed(trial_of):
    """The judge of the test above, on calls without one of the fsyncs that matter."""
    calls = trial_of(NEW).calls
    for path in ("history.npz", "states", "states/000002.npz", "checkpoint"):
        assert power_loss([call for call in calls if (call.name, call.path) != ("fsync", path)]), path


def test_every_module_that_writes_files_is_known():
    """Another one needs a row, or a reason why it has none. Nothing opens a file for writing but runs/files.py, logs and the code's fits."""
    top = Path(__file__).resolve().parents[2]
    files = [file for folder in ("analysis", "yade_scripts", "contact_law") for file in (top / folder).rglob("*.py")]
    texts = {str(file.relative_to(top)): file.read_text() for file in files}
    writes = re.compile(r"\b(write_text|write_bytes|write_json|replacing|make_new|unfinished)\(")
    opens = re.compile(r"""\bopen\([^)]*, "[rbt]*[wxa+][bt+]*"|\.(write_text|write_bytes)\(""")
    own = "analysis/runs/files.py"
    assert {name for name, text in texts.items() if writes.search(text) and name != own} == {*WRITERS, FIT}
    assert {name for name, text in texts.items() if opens.search(text)} == {own, "yade_scripts/runner/workers.py", FIT}


@pytest.mark.parametrize(
    "name, every", [("analysis export", 29), ("make_packing", 4), ("analysis view", 3), ("study --slurm", 7)]
)
def test_no_fault_leaves_half_of_what_a_command_writes(trial_of, name, every):
    command = next(command for command in COMMANDS if command.name == name)
    cases = list(trial_of(command).cases(every))
    assert len(cases) > 3 and not [case for case in cases if case.wrong]


@pytest.mark.parametrize("size", [16, 24, 32, 40])
def test_a_disk_that_is_really_full(forks, tmp_path, size):
    """A small file system in memory; size in kB. A run needs less than 80."""
    with small_disk(tmp_path / "disk", f"{size}k") as disk:
        done = forks.run(RUN, disk / "run")
        wrong = wrong_on_a_full_disk(done)
        assert done.status and not wrong, wrong
        subprocess.run(["mount", "-o", "remount,size=4m", disk], check=True)
        assert forks.run(RUN + ("resume=1",), disk / "run").status == 0
        straight = forks.run(RUN, tmp_path / "straight")
        assert straight.status == 0
        assert arrays(disk / "run") == arrays(tmp_path / "straight")
