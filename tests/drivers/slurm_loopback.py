"""Debian's Slurm on this machine alone: munged, slurmctld and slurmd of one node, in a temporary folder."""

import os
import socket
import subprocess
import time
from contextlib import ExitStack, suppress
from pathlib import Path

CONFIGURATION = """ClusterName=loopback
SlurmctldHost={host}(127.0.0.1)
SlurmUser=root
SlurmctldPort={ports[0]}
SlurmdPort={ports[1]}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket,cred_expire=5
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
SlurmdParameters=config_overrides
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
ReturnToService=2
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
KillWait=10
SchedulerParameters=sched_interval=2,batch_sched_delay=0
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
NodeName={host} NodeAddr=127.0.0.1 CPUs={cores} State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""
STARTING = 60  # s


class NoSlurm(SystemExit):
    """Slurm can't be run here: ends the program with one line."""


class Loopback:
    """With it the commands of Slurm find this node, by .environment. folder: an empty one, of a short path
    (sockets)."""

    def __init__(self, folder):
        self.folder, self._daemons = Path(folder), []
        self.environment = {**os.environ, "SLURM_CONF": str(self.folder / "slurm.conf")}

    def __enter__(self):
        host = socket.gethostname().partition(".")[0]
        settings = CONFIGURATION.format(host=host, folder=self.folder, ports=_free_ports(2), cores=os.cpu_count())
        (self.folder / "slurm.conf").write_text(settings)
        for name in ("state", "spool"):
            (self.folder / name).mkdir()
        (self.folder / "munge.key").write_bytes(os.urandom(1024))
        (self.folder / "munge.key").chmod(0o600)
        files = [f"--{name}={self.folder}/munge.{ending}" for name, ending in MUNGE_FILES.items()]
        try:
            self._start("munged", "--force", "--foreground", *files)
            self._wait("munge", "-n", "-S", str(self.folder / "munge.socket"))
            self._start("slurmctld", "-D")
            self._wait("scontrol", "ping")
            self._start("slurmd", "-D")
            self._wait("srun", "--immediate=1", "true")
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        with suppress(NoSlurm):
            self.ask("scancel", "--user=root")
            self._wait("sh", "-c", '[ -z "$(squeue -h -t R,CG,S)" ]')
        for daemon in reversed(self._daemons):
            daemon.terminate()
            with suppress(subprocess.TimeoutExpired):
                daemon.wait(timeout=20)
            daemon.kill()
            daemon.wait()

    def ask(self, *command):
        """What a command prints; raises NoSlurm when it fails."""
        done = subprocess.run(command, env=self.environment, capture_output=True, text=True, timeout=60)
        if done.returncode:
            raise NoSlurm(f"{' '.join(command)}: {' '.join(done.stderr.split())}")
        return done.stdout

    def job(self, task):
        """{property: text} of a task such as 12_3, by scontrol."""
        return dict(pair.partition("=")[::2] for pair in self.ask("scontrol", "-o", "show", "job", task).split())

    def _start(self, *command):
        with open(self.folder / f"{command[0]}.out", "wb") as output:
            daemon = subprocess.Popen(command, env=self.environment, stdout=output, stderr=output)
        self._daemons.append(daemon)

    def _wait(self, *command):
        """Until a command succeeds."""
        deadline = time.monotonic() + STARTING
        while True:
            try:
                return self.ask(*command)
            except NoSlurm:
                if time.monotonic() > deadline:
                    raise
                time.sleep(0.2)


MUNGE_FILES = {"key-file": "key", "socket": "socket", "pid-file": "pid", "log-file": "log", "seed-file": "seed"}


def _free_ports(number):
    with ExitStack() as stack:
        sockets = [stack.enter_context(socket.create_server(("127.0.0.1", 0))) for _ in range(number)]
        return [one.getsockname()[1] for one in sockets]
