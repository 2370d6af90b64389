"""Which process has a run folder, from the folder alone.

A run holds a lock of the kernel (flock) on its folder as long as it lives, which only its own machine sees, and makes
the file `lock` in it, which every machine of a shared disk sees: host, process and job of Slurm. The file goes at any
end of the run but a kill. One that is left is over when it is of this machine, where nothing holds the folder any
more, or when Slurm says that its job has ended. Of another machine nothing else can tell: such a folder is taken for
one in use."""

import json
import os
import re
import shutil
import socket
import subprocess
import time
from contextlib import suppress
from dataclasses import asdict, dataclass
from pathlib import Path

from .files import RunFolderError, read_json
from .format import LOCK_FILE

try:
    import fcntl
except ImportError:  # not of POSIX, where runs are only read
    fcntl = None

TRIES, BETWEEN = 5, 0.02  # s
SQUEUE_AGAIN = 10.0  # s for which an answer of squeue is kept
ALIVE = ("RUNNING", "COMPLETING", "SUSPENDED", "STOPPED", "SIGNALING", "RESIZING", "STAGE_OUT")
_JOB = re.compile(r"(\d+)(_\d+)?")
_ANSWERS = {}  # of squeue: {job: (when, what states_of_job() gives)}


class InUse(Exception):
    """A folder that another run has; the message is one line."""


@dataclass(frozen=True)
class Lock:
    """What the file `lock` says."""

    host: str = "an unknown machine"
    boot: str = ""  # since which start of the machine
    pid: int = 0
    job: str | None = None  # of Slurm, with the task of an array (12_3)
    restarts: int = 0  # how often Slurm had begun the job anew

    @property
    def is_here(self):
        """Whether it is of this machine, or of a container on it."""
        host, boot = this_machine()
        return self.host == host or (boot != "" and self.boot == boot)

    @property
    def can_be_followed(self):
        """Whether this machine can tell when the run has ended."""
        return self.is_here or bool(self.job and shutil.which("squeue"))

    def __str__(self):
        return f"on {self.host}" + (f", Slurm job {self.job}" if self.job else "")


def take(folder):
    """Have a run folder (path) for this process until it ends, or until release(); returns the handle of the folder.

    Raises InUse where another run has it, and OSError where it cannot be written."""
    handle = os.open(folder, os.O_RDONLY)
    try:
        _hold(handle)
        file, before = os.path.join(folder, LOCK_FILE), read_lock(folder)
        if before and not _is_over(before):
            must = f"must be another folder, or, if that run was killed, {file} removed"
            raise InUse(f"another run is writing there, {before}; {must}")
        if before or (os.path.exists(file) and not os.path.getsize(file)):
            os.unlink(file)
        job, restarts = this_job()
        own = Lock(*this_machine(), os.getpid(), job, restarts)
        try:
            with open(file, "x") as new:
                new.write(json.dumps(asdict(own), indent=2) + "\n")
        except FileExistsError:
            raise InUse("another run has just begun there; must be another folder") from None
    except BaseException:
        os.close(handle)
        raise
    return handle


def _hold(handle):
    """Lock a folder's handle; InUse where another run has. Who only looks (is_held) has it for a moment."""
    for _ in range(TRIES):
        with suppress(BlockingIOError):
            return fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        time.sleep(BETWEEN)
    raise InUse("another run is writing there; must be another folder")


def release(folder, handle):
    """Give a folder back that take() has taken."""
    with suppress(OSError):
        os.unlink(os.path.join(folder, LOCK_FILE))
    os.close(handle)


def under_way(folder):
    """Lock of the run that is under way in a folder (path), or None."""
    lock = read_lock(folder)
    if is_held(folder):
        return lock or Lock(*this_machine())
    return None if lock is None or _is_over(lock) else lock


def read_lock(folder):
    """Lock of a folder (path), or None; one that can't be read has the defaults.

    One that is empty is none: a run was killed as it made the file, or holds the folder and is about to write it."""
    file = Path(folder) / LOCK_FILE
    try:
        return Lock(**read_json(file))
    except (RunFolderError, TypeError):
        with suppress(OSError):
            return Lock() if os.path.getsize(file) else None


def is_held(folder):
    """Whether a process of this machine holds the kernel's lock on a folder (path)."""
    with suppress(OSError, AttributeError):  # without fcntl nothing is held
        handle = os.open(folder, os.O_RDONLY)
        try:
            fcntl.flock(handle, fcntl.LOCK_SH | fcntl.LOCK_NB)
        except BlockingIOError:
            return True
        finally:
            os.close(handle)
    return False


def this_machine():
    """(host, boot id) of this machine."""
    boot = ""
    with suppress(OSError):
        boot = Path("/proc/sys/kernel/random/boot_id").read_text().strip()
    return socket.gethostname(), boot


def _is_over(lock):
    """Whether a run has ended whose folder no process of this machine holds."""
    if lock.is_here:
        return True
    if not (lock.job and _JOB.fullmatch(lock.job)):
        return False
    job, restarts = this_job()
    if job == lock.job and restarts != lock.restarts:
        return True  # this is the job begun anew, which Slurm does when it has ended the former processes
    states, _ = states_of_job(lock.job.partition("_")[0])
    return states is not None and states.get(lock.job) not in ALIVE


def this_job():
    """(Slurm's job with its array task, how often it was begun anew), (None, 0) outside of Slurm."""
    array, task = os.environ.get("SLURM_ARRAY_JOB_ID"), os.environ.get("SLURM_ARRAY_TASK_ID")
    job = f"{array}_{task}" if array and task else os.environ.get("SLURM_JOB_ID", "")
    restarts = os.environ.get("SLURM_RESTART_COUNT", "")
    return (job, int(restarts) if restarts.isdecimal() else 0) if _JOB.fullmatch(job) else (None, 0)


def states_of_job(job):
    """({task, such as 12_3: state} of a job of Slurm (its number, text), why there is none). A job that is long over
    has no tasks; without an answer of squeue the first is None, and without squeue the second, too.

    squeue is called once for all tasks."""
    if job not in _ANSWERS or time.monotonic() - _ANSWERS[job][0] > SQUEUE_AGAIN:
        _ANSWERS[job] = time.monotonic(), _squeue(job)
    return _ANSWERS[job][1]


def _squeue(job):
    if not shutil.which("squeue"):
        return None, None
    command = ["squeue", "-h", "-r", "-j", job, "-o", "%i %T"]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=20, stdin=subprocess.DEVNULL)
    except (OSError, subprocess.TimeoutExpired) as error:
        return None, str(error)
    if done.returncode and "Invalid job id" in done.stderr:
        return {}, None
    if done.returncode:
        return None, " ".join(done.stderr.split())
    return dict(line.split() for line in done.stdout.splitlines() if line.count(" ") == 1), None
