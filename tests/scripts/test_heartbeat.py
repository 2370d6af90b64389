"""Whether a run is under way is told by its lock, by Slurm or by its heartbeat, and of several starters one has the folder."""

import json
import os
import time
from dataclasses import asdict, replace

import numpy as np
import pytest
from running import wait_for

from analysis.__main__ import main
from analysis.runs import running
from analysis.runs.format import HEARTBEAT_FILE
from analysis.runs.running import INTERVAL, MISSED, Heartbeat, place, read_heartbeat
from yade_scripts.experiments.collision import KIND
from yade_scripts.run import heartbeat
from yade_scripts.run.folder import RunFolder, RunFolderError
from yade_scripts.run.heartbeat import Beating, RunsElsewhere
from yade_scripts.runner import rows

ELSEWHERE = Heartbeat("node7", "another boot", 99, start=1)
STALE = MISSED * INTERVAL + 5


@pytest.fixture(autouse=True)
def first_looks(monkeypatch):
    """No look was taken before, squeue was not asked, and this is no job of Slurm."""
    monkeypatch.setattr(running, "_LOOKS", running._Looks())
    monkeypatch.setattr(running, "_ANSWERS", {})
    for name in ("SLURM_JOB_ID", "SLURM_ARRAY_JOB_ID", "SLURM_ARRAY_TASK_ID", "SLURM_RESTART_COUNT"):
        monkeypatch.delenv(name, raising=False)


def left_by(folder, of, age=0.0):
    """A folder with the heartbeat of a run that wrote it `age` seconds ago, and its path."""
    folder.mkdir(exist_ok=True)
    for name in (HEARTBEAT_FILE, f".heartbeat-{of.start}"):
        (folder / name).write_text(json.dumps(asdict(of)))
        os.utime(folder / name, (time.time() - age,) * 2)
    return str(folder)


def as_machine(monkeypatch, host):
    monkeypatch.setattr(running, "this_machine", lambda: (host, "its boot"))


def test_a_run_beats_until_it_ends_and_a_job_of_an_array_says_its_task(tmp_path, monkeypatch):
    (tmp_path / "run").mkdir()
    beating = Beating(str(tmp_path / "run"), interval=0.02)
    host, boot = running.this_machine()
    first = read_heartbeat(tmp_path / "run")
    assert (first.host, first.boot, first.pid, first.job, first.interval) == (host, boot, os.getpid(), None, 0.02)
    wait_for(lambda: read_heartbeat(tmp_path / "run").beat >= 3, 20)
    beating.stop()
    assert os.listdir(tmp_path / "run") == []
    monkeypatch.setenv("SLURM_JOB_ID", "14")
    assert running.this_job() == ("14", 0)
    for name, value in {"ARRAY_JOB_ID": "12", "ARRAY_TASK_ID": "3", "RESTART_COUNT": "2"}.items():
        monkeypatch.setenv(f"SLURM_{name}", value)
    beating = Beating(str(tmp_path))
    assert (read_heartbeat(tmp_path).job, read_heartbeat(tmp_path).restarts) == ("12_3", 2)
    beating.stop()


def test_on_this_machine_the_lock_tells_elsewhere_the_age_by_the_file_servers_clock(tmp_path, monkeypatch):
    host, boot = running.this_machine()
    assert place(left_by(tmp_path / "killed", Heartbeat(host, boot))) is None
    assert place(left_by(tmp_path / "before a new start of the machine", Heartbeat(host, "another boot"))).host == host
    folder = RunFolder(str(tmp_path / "run"), heartbeat=True)
    assert place(folder.path) == running.Place(host, None, True)
    folder.close()
    os.close(folder._lock)
    assert place(folder.path) is None
    young, old = left_by(tmp_path / "young", ELSEWHERE), left_by(tmp_path / "old", ELSEWHERE, STALE)
    monkeypatch.setattr(time, "time", lambda: 0.0)  # this machine's clock is years behind
    assert place(young) == running.Place("node7", None, False) and str(place(young)) == "on node7"
    assert place(old) is None
    assert sorted(os.listdir(young)) == [".heartbeat-1", HEARTBEAT_FILE]


def test_a_heartbeat_that_changes_is_one_until_it_stops_for_three_intervals(tmp_path):
    """Whatever the file server's clock says of it."""
    folder = left_by(tmp_path / "run", ELSEWHERE, STALE)
    assert place(folder) is None
    left_by(tmp_path / "run", replace(ELSEWHERE, beat=1), STALE)
    assert place(folder) and place(folder)
    quick = left_by(tmp_path / "quick", replace(ELSEWHERE, interval=0.1))
    assert place(quick)
    wait_for(lambda: not place(quick), 20)


@pytest.mark.parametrize(
    "text", ["", "[]", '{"interval": -1, "job": "1; rm", "host": 3}', '{"interval": 1e99, "start": 1.5}']
)
def test_a_damaged_heartbeat_is_judged_by_its_age(tmp_path, text):
    folder, file = left_by(tmp_path / "run", ELSEWHERE), tmp_path / "run" / HEARTBEAT_FILE
    file.write_text(text)
    assert place(folder) == running.Place("an unknown machine", None, False)
    os.utime(file, (1, 1))
    running._LOOKS.__init__()
    assert place(folder) is None


@pytest.mark.parametrize(
    "answer, status, age, is_running",
    [
        ("12_3 RUNNING", 0, STALE, True),
        ("12_3 COMPLETING", 0, STALE, True),
        ("12_3 PENDING", 0, 0.0, False),  # the job was ended, and waits for its next start
        ("12_4 RUNNING", 0, 0.0, False),
        ("", 0, 0.0, False),
        ("", 1, 0.0, True),  # squeue knows no such job, or can't reach its server: the heartbeat tells
        ("", 1, STALE, False),
    ],
)
def test_slurm_tells_before_the_heartbeat(tmp_path, program, answer, status, age, is_running):
    program("squeue", f'[ "$*" = "-h -r -j 12 -o %i %T" ] || exit 3\necho "{answer}"\nexit {status}')
    found = place(left_by(tmp_path / "run", replace(ELSEWHERE, job="12_3"), age))
    assert bool(found) == is_running
    assert not found or str(found) == "on node7, Slurm job 12_3"


def test_a_job_that_is_begun_anew_takes_over_at_once(tmp_path, monkeypatch):
    monkeypatch.setenv("SLURM_JOB_ID", "12")
    folder = left_by(tmp_path / "run", replace(ELSEWHERE, job="12"))
    assert place(folder)
    monkeypatch.setenv("SLURM_RESTART_COUNT", "1")
    assert place(folder) is None


@pytest.mark.parametrize("left", [None, ELSEWHERE], ids=["new folder", "killed run"])
def test_of_many_starters_one_has_the_folder(tmp_path, left):
    """Each a process as if on a machine of its own, which begin at the same moment; ten times."""
    for attempt in range(10):
        folder = tmp_path / str(attempt)
        folder.mkdir()
        if left:
            left_by(folder, left, STALE)
        ready, go = os.pipe()
        starters = []
        for number in range(6):
            starters.append(os.fork())
            if starters[-1] == 0:
                os.close(go)
                os.read(ready, 1)  # ends when the other side closes
                _start_and_end(str(folder), number)
        os.close(ready)
        os.close(go)
        won = [os.waitstatus_to_exitcode(os.waitpid(starter, 0)[1]) for starter in starters]
        assert sorted(won) == [0, 1, 1, 1, 1, 1]
        assert read_heartbeat(folder).host == f"host{won.index(0)}"
        assert sorted(os.listdir(folder)) == [f".heartbeat-{2 if left else 1}", HEARTBEAT_FILE]


def _start_and_end(folder, number):
    """Exit status 0 for who has the folder (and is killed without an end), 1 for the others, 2 for anything else."""
    try:
        running.this_machine = lambda: (f"host{number}", "its boot")
        Beating(folder)
        os._exit(0)
    except RunsElsewhere:
        os._exit(1)
    finally:
        os._exit(2)


def test_a_start_that_was_killed_at_once_is_taken_over_too(tmp_path, monkeypatch):
    """It has left its own file, but no heartbeat yet."""
    left_by(tmp_path / "run", Heartbeat("node7", "another boot", start=4), STALE)
    left_by(tmp_path / "run", ELSEWHERE, STALE)  # heartbeat.json is an earlier start's
    (tmp_path / "run" / ".heartbeat-4").touch()
    with pytest.raises(RunsElsewhere, match="on node7"):
        Beating(str(tmp_path / "run"))
    os.utime(tmp_path / "run" / ".heartbeat-4", (1, 1))
    running._LOOKS.__init__()
    assert Beating(str(tmp_path / "run")).now.start == 5
    assert sorted(os.listdir(tmp_path / "run")) == [".heartbeat-5", HEARTBEAT_FILE]


def test_a_starter_that_was_paused_for_all_of_another_run_is_refused(tmp_path, monkeypatch):
    """It has seen start 4 killed; a run then came to its end, and another one has begun, counting from 1."""
    left_by(tmp_path / "run", Heartbeat("node7", "another boot", start=4), STALE)
    make = heartbeat.make_new

    def paused(path, content):
        for name in os.listdir(tmp_path / "run"):
            os.unlink(tmp_path / "run" / name)
        left_by(tmp_path / "run", ELSEWHERE)
        return make(path, content)

    monkeypatch.setattr(heartbeat, "make_new", paused)
    with pytest.raises(RunsElsewhere):
        Beating(str(tmp_path / "run"))
    assert sorted(os.listdir(tmp_path / "run")) == [".heartbeat-1", HEARTBEAT_FILE]


def test_a_starter_that_is_refused_is_no_end_of_the_run_before_it(tmp_path, monkeypatch):
    """Start 2 has the folder; start 3 is refused, and takes its file away while start 4 looks at it."""
    left_by(tmp_path / "run", replace(ELSEWHERE, start=2))
    refused, read = tmp_path / "run" / ".heartbeat-3", running.read_heartbeat
    refused.touch()

    def while_it_goes(folder, name=HEARTBEAT_FILE):
        refused.unlink(missing_ok=True)
        return read(folder, name)

    monkeypatch.setattr(running, "read_heartbeat", while_it_goes)
    with pytest.raises(RunsElsewhere, match="on node7"):
        Beating(str(tmp_path / "run"))
    assert sorted(os.listdir(tmp_path / "run")) == [".heartbeat-2", HEARTBEAT_FILE]


def test_a_start_that_has_the_number_of_a_refused_one_is_another(tmp_path, monkeypatch):
    """While start 3 sees that 1 was killed and 2 refused, another start 2 takes the folder."""
    left_by(tmp_path / "run", ELSEWHERE, STALE)
    refused, beats = tmp_path / "run" / ".heartbeat-2", running.beats
    refused.touch()

    def while_another_begins(file, heartbeat):
        if file != str(refused):
            return beats(file, heartbeat)
        refused.unlink()
        left_by(tmp_path / "run", replace(ELSEWHERE, start=2))
        return False

    monkeypatch.setattr(running, "beats", while_another_begins)
    with pytest.raises(RunsElsewhere, match="has just begun"):
        Beating(str(tmp_path / "run"))


def test_a_file_system_without_hard_links_will_do(tmp_path, monkeypatch):
    def no_link(*_):
        raise PermissionError(1, "Operation not permitted")

    monkeypatch.setattr(os, "link", no_link)
    beating = Beating(str(tmp_path))
    as_machine(monkeypatch, "node8")
    with pytest.raises(RunsElsewhere):
        Beating(str(tmp_path))
    assert not heartbeat.make_new(beating._own(), b"")
    beating.stop()
    assert os.listdir(tmp_path) == []


def test_a_folder_that_is_written_elsewhere_is_refused_and_left_as_it_is(tmp_path):
    folder = left_by(tmp_path / "run", ELSEWHERE)
    (tmp_path / "run" / "run.json").write_text("{}")
    before = sorted(os.listdir(folder))
    for options in ({}, {"overwrite": True}, {"resume": True}):
        with pytest.raises(RunFolderError, match="another run is writing there, on node7; must be another folder"):
            RunFolder(folder, heartbeat=True, **options)
    assert sorted(os.listdir(folder)) == before


def test_a_run_that_was_paused_for_too_long_writes_nothing_any_more(tmp_path, monkeypatch):
    paused = RunFolder(str(tmp_path / "run"), heartbeat=True)
    as_machine(monkeypatch, "node8")
    file = tmp_path / "run" / HEARTBEAT_FILE
    os.utime(file, (1, 1))
    other = Beating(paused.path)
    paused.write_history({"time": np.zeros(1)})  # its heartbeat is a moment old
    monkeypatch.setattr(paused._heartbeat, "_written", -1e9)
    for write in (paused.write_ended, lambda: paused.write_run({}), lambda: paused.write_state(0, {})):
        with pytest.raises(OSError, match="another run has taken over the folder"):
            write()
    paused.close()
    assert read_heartbeat(tmp_path / "run").host == "node8" and os.path.exists(other._own())
    other.stop()


def test_both_commands_show_where_a_run_is(tmp_path, capsys):
    folder = left_by(tmp_path / "run", ELSEWHERE)
    (tmp_path / "run" / "run.json").write_text('{"outcome": "failed: earlier"}')
    given = rows.StudyRow("row", {}, "collide.py", KIND, KIND.parse({"out": folder}))
    found = rows.state(given, str(tmp_path / "log"))
    assert (found.kind, found.note, found.host) == (rows.RUNNING, "on node7", "node7")
    assert main(["status", folder]) == 0
    assert capsys.readouterr().out.splitlines()[0].endswith("on node7")
    assert main(["status", folder, "--json"]) == 0
    assert json.loads(capsys.readouterr().out)[0]["host"] == "node7"
    os.utime(tmp_path / "run" / HEARTBEAT_FILE, (1, 1))
    running._LOOKS.__init__()
    assert rows.state(given, str(tmp_path / "log")).kind == rows.FAILED
