"""Fresh Debian systems, in each a clean clone, in it the README's commands. Run by `make test-debian`, as root.

    python3 tests/drivers/debian_systems.py bookworm trixie      [--commands 'make demo' ...]
    python3 tests/drivers/debian_systems.py bookworm-arm64       of another processor, emulated where this one is none
                                                                 (Debian's qemu-user-static and binfmt-support)

A system is made by debootstrap with the mirror of this system's apt, and removed afterwards. Each runs in mount and
process namespaces of its own.
What is tested is the last commit. Writes results/debian.md: system, versions, result and time of each command; systems
that are not tried keep their lines.
Exit status: 0 when every command of every system succeeded, otherwise 1.
"""

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass, field
from pathlib import Path

HERE = Path(__file__).resolve().parent
TOP = HERE.parents[1]
RESULTS = HERE / "results" / "debian.md"
CLONE = "/root/clone"
BASE = ("git", "make")  # what one has who has cloned a repository and calls make
VERSIONS = {
    "Debian": "cat /etc/debian_version",
    "YADE": "dpkg-query -W -f '${Version}' yade",
    "Python": "dpkg-query -W -f '${Version}' python3",
    "g++": "dpkg-query -W -f '${Version}' g++",
    "Boost": "dpkg-query -W -f '${Version}' libboost-dev",
    "numpy": "dpkg-query -W -f '${Version}' python3-numpy",
}


@dataclass
class System:
    """A Debian system in a folder; what has been found out about it."""

    name: str  # suite, or suite-architecture
    folder: Path
    commit: str = "unknown"
    versions: dict = field(default_factory=dict)
    results: list = field(default_factory=list)  # (command, what became of it, seconds)

    def make(self, mirror):
        """Debootstrap, packages that come before the clone, and the clone."""
        self.folder.mkdir()
        suite, _, architecture = self.name.partition("-")
        options = ["--variant=minbase"]
        if architecture:
            emulate()
            options.append(f"--arch={architecture}")
        known = Path("/usr/share/debootstrap/scripts", suite).exists()  # otherwise it is younger than debootstrap
        run(["debootstrap", *options, suite, str(self.folder), mirror, *([] if known else ["sid"])])
        (self.folder / "etc/dpkg/dpkg.cfg.d/fast").write_text("force-unsafe-io\n")
        # A copy of unstable on a mirror of one's own may be older than the archive lets it be.
        (self.folder / "etc/apt/apt.conf.d/80old-copy").write_text('Acquire::Check-Valid-Until "false";\n')
        self.inside(f"apt-get -q update && apt-get -q -y --no-install-recommends install {' '.join(BASE)}", check=True)
        clone = self.folder / CLONE.lstrip("/")
        run(["git", "clone", "-q", "--no-hardlinks", str(TOP), str(clone)])
        self.commit = run(["git", "-C", str(clone), "rev-parse", "--short", "HEAD"]).stdout.strip()

    def inside(self, command, check=False):
        """CompletedProcess of a shell command within the system, with processes, mounts and nothing of this one's
        environment but proxies."""
        mounts = 'mount -t proc proc "$0/proc" && mount --rbind /dev "$0/dev" && mount -t tmpfs tmp "$0/tmp"'
        enter = ["unshare", "--mount", "--pid", "--fork", "--kill-child", "sh", "-c"]
        enter += [f'{mounts} && exec chroot "$0" /bin/sh -c "$1"', str(self.folder), command]
        kept = {name: value for name, value in os.environ.items() if name.lower().endswith("_proxy")}
        own = {"PATH": "/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin", "HOME": "/root", "TERM": "dumb"}
        return run(enter, check=check, env={**kept, **own, "LC_ALL": "C.UTF-8", "DEBIAN_FRONTEND": "noninteractive"})

    def try_commands(self, commands):
        """Run them in the clone, the next even if one fails; yields after each."""
        for command in commands:
            begun = time.monotonic()
            done = self.inside(f"cd {CLONE} && git config --global --add safe.directory {CLONE} && {command}")
            seconds = time.monotonic() - begun
            self.results.append((command, outcome(done), seconds))
            print(f"{self.name}: {command}: {self.results[-1][1]}, {seconds:.0f} s", flush=True)
            if done.returncode:
                print((done.stdout + done.stderr)[-6000:], flush=True)
            for name, ask in VERSIONS.items():
                self.versions[name] = self.inside(ask).stdout.strip() or "not installed"
            yield


def run(command, check=True, **more):
    """CompletedProcess; ends the program with the command's last line when it fails."""
    done = subprocess.run(command, capture_output=True, text=True, stdin=subprocess.DEVNULL, **more)
    if check and done.returncode:
        lines = [line for line in (done.stdout + done.stderr).splitlines() if line.strip()]
        sys.exit(f"{' '.join(map(str, command[:4]))}: {lines[-1] if lines else done.returncode}")
    return done


def last_commit_in(clone):
    """Clone the repository, or bring the clone to its last commit."""
    if not clone.exists():
        run(["git", "clone", "-q", TOP, clone])
    run(["git", "fetch", "-q", TOP, "HEAD"], cwd=clone)
    run(["git", "checkout", "-q", "--detach", "FETCH_HEAD"], cwd=clone)


def write_page(path, head, rows):
    """Write head and rows (pairs of a line and whether all was well) as they come: whether all was well with each."""
    text, good = head, True
    for line, well in rows:
        text, good = f"{text}{line}\n", good and well
        path.write_text(text)
    return good


def emulate():
    """Have the kernel start other processors' programs by qemu, which it forgets when the machine starts where no service tells it."""
    if not Path("/proc/sys/fs/binfmt_misc/status").exists():
        run(["mount", "-t", "binfmt_misc", "binfmt_misc", "/proc/sys/fs/binfmt_misc"])
    run(["update-binfmts", "--enable"])


def outcome(done):
    """What became of a command: passed or failed, with pytest's last line or the line that make stopped with."""
    counts = re.findall(r"^=* ?((?:\d+ \w+,? ?)+) in [\d.]+s", done.stdout, re.MULTILINE)
    if done.returncode == 0:
        return counts[-1].strip() if counts else "succeeded"
    of_make = re.compile(r"make(\[\d+\])?: (\*\*\*|Entering|Leaving|Nothing)")
    lines = [line for line in (done.stdout + done.stderr).splitlines() if line and not of_make.match(line)]
    return f"failed: {counts[-1].strip() if counts else lines[-1][:150] if lines else done.returncode}"


def archives():
    """[(address, code name, suite)] of Debian's archives that apt uses here."""
    asked = ["--format", "$(REPO_URI) $(CODENAME) $(SUITE) $(ORIGIN)", "Created-By: Packages"]
    found = [line.split(" ") for line in run(["apt-get", "indextargets", *asked]).stdout.splitlines()]
    return sorted({tuple(about) for *about, origin in found if origin == "Debian"})


def mirror_of_this_system():
    """The address of that which is no update of another."""
    for address, _, suite in archives():
        if "-" not in suite:
            return address
    sys.exit("apt has no Debian archive among its sources")


def commands_of_the_readme():
    """The first block of the README: what a new user calls, in order."""
    block = re.search(r"\n\n((?:    make .*\n)+)", (TOP / "README.md").read_text()).group(1)
    return [line.split("#")[0].strip() for line in block.strip().splitlines()]


def table(systems, before):
    """The page that the repository keeps; before: the text that it was, of which lines of other systems stay."""
    cores = len(os.sched_getaffinity(0))
    about = f"{cores} cores, with other work beside. Each system was made by debootstrap with nothing but "
    about += f"{' and '.join(BASE)} added; the first command installs all other packages. "
    about += "Those of another processor than this machine's ran emulated."
    head = "| system | " + " | ".join(VERSIONS) + " | commit | command | result | time [s] |"
    lines = ["# Fresh Debian systems", "", about, "", head, "|---|" + "---|" * len(VERSIONS) + "---|---|---|---:|"]
    names = tuple(f"| {name} |" for name in ("system", *(system.name for system in systems)))
    lines += [line for line in before.splitlines() if line.startswith("| ") and not line.startswith(names)]
    for system in systems:
        for command, result, seconds in system.results:
            versions = " | ".join(system.versions.values())
            lines.append(f"| {system.name} | {versions} | {system.commit} | `{command}` | {result} | {seconds:.0f} |")
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="+", metavar="SUITE[-ARCHITECTURE]")
    parser.add_argument("--commands", nargs="+", metavar="COMMAND", help="instead of the README's")
    parser.add_argument("--out", type=Path, default=RESULTS, help="where the table goes (default: %(default)s)")
    options = parser.parse_args()
    if os.geteuid() != 0:
        sys.exit("must be run as root: debootstrap and chroot need it (sudo make test-debian)")
    if not shutil.which("debootstrap"):
        sys.exit("debootstrap: not installed; must be there (apt-get install debootstrap)")
    before = options.out.read_text() if options.out.exists() else ""
    mirror, commands, systems = mirror_of_this_system(), options.commands or commands_of_the_readme(), []
    with tempfile.TemporaryDirectory(prefix="debian-", dir="/var/tmp") as scratch:
        for name in options.names:
            systems.append(System(name, Path(scratch, name)))
            systems[-1].make(mirror)
            for _ in systems[-1].try_commands(commands):
                options.out.write_text(table(systems, before))
    return int(any(result.startswith("failed") for system in systems for _, result, _ in system.results))


if __name__ == "__main__":
    sys.exit(main())
