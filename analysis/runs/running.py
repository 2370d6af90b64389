"""Whether a run is under way, and on which machine: told here, and nowhere else.

A run holds a lock on its folder, which only its own machine sees, and while it is under way its folder has a
heartbeat.json, written anew every `interval` seconds (yade_scripts.run.heartbeat), which every machine of a shared disk
sees. In this order: the lock, when the heartbeat is of this machine, or there is none; Slurm, when a heartbeat names a
job that squeue knows; else the heartbeat, which must have changed since an earlier look, or be younger than three
intervals by the clock of the file server.
"""

import os
import re
import shutil
import socket
import subprocess
import tempfile
import time
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from .files import RunFolderError, read_json
from .format import HEARTBEAT_FILE

MISSED = 3  # intervals after which a heartbeat that hasn't changed is one of a run that was killed
INTERVAL = 30.0  # s
CLOCKS_AGREE = 60.0  # s that clocks may differ by, where the file server's cannot be read
SQUEUE_AGAIN = 10.0  # s for which an answer of squeue is kept
ALIVE = ("RUNNING", "COMPLETING", "SUSPENDED", "STOPPED", "SIGNALING", "RESIZING", "STAGE_OUT")
_JOB = re.compile(r"(\d+)(_\d+)?")
_ANSWERS = {}  # of squeue: {job: (when, {task: state} or None, why there is no answer or None)}


@dataclass(frozen=True)
class Heartbeat:
    """What heartbeat.json says. host, boot: the machine, and since which start of it; pid: the process; job: of Slurm, with
    the task of an array (12_3), None outside; restarts: how often Slurm had begun the job anew; start: number of the start
    in this folder; beat: counts up; interval [s]."""

    host: str = "an unknown machine"
    boot: str = ""
    pid: int = 0
    job: str = None
    restarts: int = 0
    start: int = 0
    beat: int = 0
    interval: float = INTERVAL


@dataclass(frozen=True)
class Place:
    """Where a run is under way: host, Slurm's job or None, whether it is this machine."""

    host: str
    job: str
    here: bool

    def __str__(self):
        return f"on {self.host}" + (f", Slurm job {self.job}" if self.job else "")


def place(folder):
    """Place where the run of a folder (path) is under way, or None when it isn't."""
    heartbeat = read_heartbeat(folder)
    if being_written(folder):
        ours = heartbeat is not None and is_here(heartbeat)
        return Place(socket.gethostname(), heartbeat.job if ours else None, True)
    if heartbeat is None or not beats(os.path.join(folder, HEARTBEAT_FILE), heartbeat):
        return None
    return Place(heartbeat.host, heartbeat.job, False)


def beats(file, heartbeat):
    """Whether the run of a heartbeat file (path), of which no process of this machine holds the lock, is under way."""
    if is_here(heartbeat):
        return False
    told = _slurm_says(heartbeat)
    return _LOOKS.beats(file, heartbeat) if told is None else told


def read_heartbeat(folder, name=HEARTBEAT_FILE):
    """Heartbeat in a run folder (path), None when there is none; what can't be read has the defaults."""
    file = Path(folder) / name
    try:
        found = read_json(file)
    except RunFolderError:
        return Heartbeat() if file.exists() else None
    if not isinstance(found, dict):
        return Heartbeat()
    known = {key: value for key, value in found.items() if _is_sound(key, value)}
    return Heartbeat(**known)


def this_machine():
    """(host, boot id) of this machine."""
    boot = ""
    with suppress(OSError):
        boot = Path("/proc/sys/kernel/random/boot_id").read_text().strip()
    return socket.gethostname(), boot


def this_job():
    """(Slurm's job with its array task, how often it was begun anew), (None, 0) outside of Slurm."""
    array, task = os.environ.get("SLURM_ARRAY_JOB_ID"), os.environ.get("SLURM_ARRAY_TASK_ID")
    job = f"{array}_{task}" if array and task else os.environ.get("SLURM_JOB_ID", "")
    restarts = os.environ.get("SLURM_RESTART_COUNT", "")
    return (job, int(restarts) if restarts.isdecimal() else 0) if _JOB.fullmatch(job) else (None, 0)


def states_of_job(job):
    """{job with its array task, such as 12_3: state} of a job of Slurm (its number, text) by squeue, which is asked once for
    all tasks; None when it doesn't know the job, or isn't there."""
    if job not in _ANSWERS or time.monotonic() - _ANSWERS[job][0] > SQUEUE_AGAIN:
        _ANSWERS[job] = time.monotonic(), *_ask_squeue(job)
    return _ANSWERS[job][1]


def why_unknown(job):
    """Why squeue had no answer for a job when states_of_job() asked, in a few words; None where it had one, doesn't know the job, or isn't there."""
    return _ANSWERS[job][2]


def is_here(heartbeat):
    """Whether a heartbeat is of this machine, since its last start."""
    return (heartbeat.host, heartbeat.boot) == this_machine()


def being_written(path):
    """Whether a process of this machine holds the folder's lock (read from the kernel's list, without taking it)."""
    try:
        inode = os.stat(path).st_ino
        with open("/proc/locks") as locks:
            return inode in locked_inodes(locks)
    except OSError:
        return False


def locked_inodes(lines):
    """Inodes on which the lines of /proc/locks say that a process holds a flock; one that waits for it has '->'."""
    held = r"\d+: FLOCK +\S+ +\S+ +-?\d+ +[0-9a-f]+:[0-9a-f]+:(\d+) "
    return {int(found.group(1)) for found in (re.match(held, line) for line in lines) if found}


def age(file):
    """Seconds since a file was written, by the clock of the file server: that of a file made beside it now.

    Making a file also has an NFS client look at the folder anew. Where nothing can be written this machine's clock stands
    for the server's, CLOCKS_AGREE behind. Raises FileNotFoundError.
    """
    try:
        with tempfile.TemporaryFile(dir=os.path.dirname(file)) as clock:
            now = os.fstat(clock.fileno()).st_mtime
    except OSError:
        now = time.time() - CLOCKS_AGREE
    return now - os.stat(file).st_mtime


class _Looks:
    """Heartbeats seen earlier."""

    def __init__(self):
        self._seen = {}  # {file: (heartbeat, when it was written, on the clock of time.monotonic())}

    def beats(self, file, heartbeat):
        """Whether a heartbeat has changed since the last look, or is young enough."""
        now = time.monotonic()
        before, written = self._seen.get(file, (None, None))
        if before is None or not (before == heartbeat and now - written < MISSED * heartbeat.interval):
            written = now if before not in (None, heartbeat) else self._written(file, now)
        self._seen[file] = heartbeat, written
        return abs(now - written) < MISSED * heartbeat.interval  # of the future: copied from a clock that was wrong

    def _written(self, file, now):
        try:
            return now - age(file)
        except OSError:  # it has ended meanwhile
            return float("-inf")


_LOOKS = _Looks()


def _slurm_says(heartbeat):
    """Whether Slurm has a heartbeat's job running; None when it can't tell."""
    if not heartbeat.job:
        return None
    job, restarts = this_job()
    if job == heartbeat.job and restarts != heartbeat.restarts:
        return False  # this is the job begun anew, which Slurm does when it has ended the former processes
    states = states_of_job(_JOB.fullmatch(heartbeat.job).group(1))
    return None if states is None else states.get(heartbeat.job) in ALIVE


def _ask_squeue(job):
    if not shutil.which("squeue"):
        return None, None
    command = ["squeue", "-h", "-r", "-j", job, "-o", "%i %T"]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=20, stdin=subprocess.DEVNULL)
    except (OSError, subprocess.TimeoutExpired) as error:
        return None, str(error)
    if done.returncode:
        return None, None if "Invalid job id" in done.stderr else " ".join(done.stderr.split())
    return dict(line.split() for line in done.stdout.splitlines() if line.count(" ") == 1), None


def _is_sound(key, value):
    """Whether a value of heartbeat.json is one that a Heartbeat may have."""
    if key in ("host", "boot"):
        return isinstance(value, str) and value.isprintable()
    if key == "job":
        return value is None or (isinstance(value, str) and bool(_JOB.fullmatch(value)))
    if key == "interval":
        return isinstance(value, (int, float)) and 0 < value <= 3600
    return key in ("pid", "restarts", "start", "beat") and isinstance(value, int) and value >= 0
