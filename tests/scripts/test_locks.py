"""One start has a run folder; whether a run is under way is read from its folder on every machine."""

import json
import os
import signal
from dataclasses import asdict, replace

import pytest

from analysis.runs import lock
from analysis.runs.format import LOCK_FILE
from analysis.runs.lock import Lock, read_lock, under_way
from yade_scripts.parameters import InputError
from yade_scripts.run.folder import RunFolder

ELSEWHERE = Lock("node7", "another boot", 99)


@pytest.fixture(autouse=True)
def no_slurm(monkeypatch):
    monkeypatch.setattr(lock, "_ANSWERS", {})
    for name in ("SLURM_JOB_ID", "SLURM_ARRAY_JOB_ID", "SLURM_ARRAY_TASK_ID", "SLURM_RESTART_COUNT"):
        monkeypatch.delenv(name, raising=False)


def left_by(folder, of):
    """Path of a folder in which a run has left its lock."""
    folder.mkdir(exist_ok=True)
    (folder / LOCK_FILE).write_text(json.dumps(asdict(of)))
    return str(folder)


def test_a_run_says_where_it_is_until_it_ends(tmp_path, monkeypatch):
    for name, value in {"ARRAY_JOB_ID": "12", "ARRAY_TASK_ID": "3", "RESTART_COUNT": "2"}.items():
        monkeypatch.setenv(f"SLURM_{name}", value)
    folder = RunFolder(str(tmp_path / "run"))
    assert read_lock(folder.path) == under_way(folder.path) == Lock(*lock.this_machine(), os.getpid(), "12_3", 2)
    folder.close()
    assert os.listdir(folder.path) == [] and under_way(folder.path) is None


def test_a_folder_in_use_here_is_refused_until_the_run_is_killed(tmp_path):
    path = str(tmp_path / "run")
    begun, has_begun = os.pipe()
    other = os.fork()
    if other == 0:
        RunFolder(path)
        os.write(has_begun, b".")
        signal.pause()
    os.read(begun, 1)
    with pytest.raises(InputError, match="another run is writing there"):
        RunFolder(path)
    assert under_way(path).pid == other
    os.kill(other, signal.SIGKILL)
    os.waitpid(other, 0)
    assert read_lock(path).pid == other and under_way(path) is None
    RunFolder(path).close()


def test_a_folder_of_another_machine_is_refused_and_its_host_named(tmp_path):
    folder = left_by(tmp_path / "run", ELSEWHERE)
    for options in ({}, {"overwrite": True}, {"resume": True}):
        with pytest.raises(InputError, match="another run is writing there, on node7; must be another folder"):
            RunFolder(folder, **options)
    assert os.listdir(folder) == [LOCK_FILE] and read_lock(folder) == ELSEWHERE
    os.unlink(tmp_path / "run" / LOCK_FILE)
    RunFolder(folder).close()


@pytest.mark.parametrize(
    "answer, status, is_running",
    [
        ("12_3 RUNNING", 0, True),
        ("12_3 PENDING", 0, False),  # the job was ended, and waits for its next start
        ("slurm_load_jobs error: Unable to contact slurm controller", 1, True),
    ],
)
def test_slurm_says_whether_a_job_elsewhere_is_over(tmp_path, program, answer, status, is_running):
    program("squeue", f'[ "$*" = "-h -r -j 12 -o %i %T" ] || exit 3\necho "{answer}" >&{1 + status}\nexit {status}')
    folder = left_by(tmp_path / "run", replace(ELSEWHERE, job="12_3"))
    assert bool(under_way(folder)) == is_running
    if is_running:
        with pytest.raises(InputError, match="on node7, Slurm job 12_3"):
            RunFolder(folder)
    else:
        RunFolder(folder).close()


def test_a_job_that_is_begun_anew_takes_its_own_folder_over(tmp_path, monkeypatch):
    monkeypatch.setenv("SLURM_JOB_ID", "12")
    folder = left_by(tmp_path / "run", replace(ELSEWHERE, job="12"))
    assert under_way(folder)
    monkeypatch.setenv("SLURM_RESTART_COUNT", "1")
    assert under_way(folder) is None
