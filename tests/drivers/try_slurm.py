"""A dozen rows as a job array of Debian's Slurm on this machine (slurm_loopback.py).

    python3 tests/drivers/try_slurm.py      root; some five minutes on two cores

While the first of three long rows runs, the task is requeued; during the second it gets the signal that Slurm sends
before a time limit; the run of the third is killed; each after its first checkpoint. One row fails, eight end. Exit
status: 0 when all was as it must be, otherwise 1."""

import os
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), *(str(HERE.parent / room) for room in ("..", ".", "scripts"))]
from running import PYTHON, STUDY, TOP, environment, process_writing
from slurm_loopback import Loopback, NoSlurm

LONG = ("requeued", "limit", "killed")
SEEDS = (1, 2, 3, 4, 5, 7, 8, 9)  # 6: the aggregates don't meet
SHORT = [f"short{seed}" for seed in SEEDS]
PATIENCE = 300  # s


def write_table(folder):
    lines = ["description radius filling velocity unusual seed duration stepFraction checkpointInterval threads out"]
    for seed, name in enumerate(LONG, 1):
        lines.append(f"{name} 10 0.4 10 * {seed} 500e-9 * 0.1 1 runs/dozen/{name}")
    lines.append("fails 5 0.4 3000 1 1 10e-9 0.4 * 1 runs/dozen/fails")  # a step too long for such an impact
    for seed, name in zip(SEEDS, SHORT):
        lines.append(f"{name} 6 0.4 5 * {seed} 100e-9 * * 1 runs/dozen/{name}")
    (folder / "dozen.table").write_text("\n".join(lines) + "\n")


class Trial:
    """Slurm's node, the folder of the study, and how many things were not as they must be."""

    def __init__(self, node, folder):
        self.node, self.folder, self.wrong = node, folder, 0

    def check(self, what, found, wanted):
        self.wrong += found != wanted
        print(f"ok  {what}: {found}" if found == wanted else f"NOT {what}: {found}, must be {wanted}", flush=True)

    def study(self, *arguments):
        own = environment(PYTHONPATH=TOP, SLURM_CONF=self.node.environment["SLURM_CONF"])
        how = {"cwd": self.folder, "env": own, "timeout": PATIENCE}
        return subprocess.run([PYTHON, STUDY, "dozen.table", *arguments], capture_output=True, text=True, **how)

    def wait(self, condition):
        deadline = time.monotonic() + PATIENCE
        while not condition():
            if time.monotonic() > deadline:
                raise NoSlurm(f"waited in vain for {PATIENCE} s: {self.node.ask('squeue', '-r')}")
            time.sleep(0.1)

    def with_checkpoint(self, name):
        """The process of a row, stopped (SIGSTOP) when it has a checkpoint."""
        run = self.folder / "runs" / "dozen" / name
        self.wait(lambda: (run / "checkpoint" / "recorder.npz").exists() and process_writing(run))
        os.kill(process_writing(run), signal.SIGSTOP)
        return process_writing(run)

    def until_over(self, job):
        self.wait(lambda: not self.node.ask("squeue", "-h", "-r", "-t", "PD,R,CG,S", "-j", job).strip())


def try_all(trial):
    write_table(trial.folder)
    first = trial.study("--slurm", "--", "--time=10")
    job = first.stdout.split()[2].rstrip(":")
    trial.check("submitted", first.stdout.splitlines()[-1].rpartition(", ")[2], "12 submitted")
    trial.check("a second call submits", trial.study("--slurm").stdout.split(", ")[-1].strip(), "0 submitted")
    trial.with_checkpoint("requeued")
    interrupt(trial, job)
    trial.until_over(job)
    ends(trial, job)
    what_is_left(trial)


def interrupt(trial, job):
    trial.node.ask("scontrol", "requeue", f"{job}_1")
    process = trial.with_checkpoint("limit")
    os.kill(process, signal.SIGCONT)
    near = ["scancel", "--signal=USR1", "--batch", f"{job}_1"]
    # it retries without end when the task is in the queue again
    with subprocess.Popen(near, env=trial.node.environment, stderr=subprocess.DEVNULL) as scancel:
        trial.wait(lambda: trial.node.job(f"{job}_1")["Restarts"] == "2")
        scancel.kill()
    os.kill(trial.with_checkpoint("killed"), signal.SIGKILL)


def ends(trial, job):
    """State of the task, and what --status says."""
    found = trial.node.job(f"{job}_1")
    text = "{JobState}, exit code {ExitCode}, begun anew {Restarts} times"
    trial.check("the task", text.format(**found), text.format(JobState="FAILED", ExitCode="1:0", Restarts=2))
    status = trial.study("--status").stdout.splitlines()
    trial.check("--status", status[-1].partition(";")[0], "dozen: 10 done, 0 running, 0 waiting, 2 failed")
    for name, words in (("killed", "killed by signal 9"), ("fails", "the run broke down")):
        line = next(line for line in status if f" {name} " in line)
        trial.check(f"--status of `{name}`", words if words in line else line, words)


def what_is_left(trial):
    """The killed row resumes, the other one fails again, and nothing else is run."""
    ended = [trial.folder / "runs" / "dozen" / name / "ended" for name in (*LONG[:2], *SHORT)]
    before = [path.stat().st_mtime_ns for path in ended]
    again = trial.study("--slurm", "-j", "1")
    trial.check("called again", again.stdout.splitlines()[-1].rpartition(", ")[2], "2 submitted")
    trial.until_over(again.stdout.split()[2].rstrip(":"))
    status = trial.study("--status").stdout.splitlines()
    trial.check("--status then", status[-1].partition(";")[0], "dozen: 11 done, 0 running, 0 waiting, 1 failed")
    trial.check("runs that had ended were left alone", [path.stat().st_mtime_ns for path in ended] == before, True)


def main():
    if os.getuid():
        sys.exit("try_slurm.py: must be run as root, as slurmd starts jobs of users")
    signal.signal(signal.SIGTERM, lambda number, frame: sys.exit(128 + number))  # not without ending Slurm
    with tempfile.TemporaryDirectory() as folder:
        for name in ("slurm", "study"):
            Path(folder, name).mkdir()
        with Loopback(Path(folder, "slurm")) as node:
            trial = Trial(node, Path(folder, "study"))
            try_all(trial)
    return int(trial.wrong > 0)


if __name__ == "__main__":
    sys.exit(main())
