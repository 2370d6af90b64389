"""Fresh Debian systems, in each a clean clone, in it the README's commands. Run by `make test-debian`, as root.

    python3 tests/drivers/debian_systems.py bookworm trixie      [--commands 'make demo' ...]
    python3 tests/drivers/debian_systems.py bookworm-arm64       another processor, emulated (qemu-user-static)

A system is made by debootstrap with the mirror of this system's apt, and removed afterwards. What is tested is the last
commit. Writes build/debian.md; exit status 0 when every command of every system succeeded.
"""

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
CLONE = "/root/clone"
BASE = ("git", "make")  # what one has who has cloned a repository and calls make
VERSIONS = "dpkg-query -W -f '${Package} ${Version}, ' yade python3 g++ libboost-dev python3-numpy"
HEAD = """# Fresh Debian systems

Commit {commit}, {cores} cores. Each system has nothing but git and make at the start.

| system | command | result | time [s] | versions |
|---|---|---|---:|---|
"""


# ---- what other drivers use too ----


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
    """Print and write head and rows (pairs of a line and whether all was well) as they come: whether all was well."""
    text, good = head, True
    for line, well in rows:
        print(line, flush=True)
        text, good = f"{text}{line}\n", good and well
        path.write_text(text)
    return good


def archives():
    """[(address, code name, suite)] of Debian's archives that apt uses here."""
    options = ["--format", "$(REPO_URI) $(CODENAME) $(SUITE) $(ORIGIN)", "Created-By: Packages"]
    found = [line.split(" ") for line in run(["apt-get", "indextargets", *options]).stdout.splitlines()]
    return sorted({tuple(about) for *about, origin in found if origin == "Debian"})


# ---- systems ----


def make(name, folder, mirror):
    """A system (suite, or suite-architecture) in a folder: debootstrap, git and make, and a clone."""
    folder.mkdir()
    suite, _, architecture = name.partition("-")
    options = ["--variant=minbase"]
    if architecture:
        # the kernel forgets other processors' programs when the machine starts where no service tells it
        if not Path("/proc/sys/fs/binfmt_misc/status").exists():
            run(["mount", "-t", "binfmt_misc", "binfmt_misc", "/proc/sys/fs/binfmt_misc"])
        run(["update-binfmts", "--enable"])
        options.append(f"--arch={architecture}")
    known = Path("/usr/share/debootstrap/scripts", suite).exists()  # otherwise it is younger than debootstrap
    run(["debootstrap", *options, suite, str(folder), mirror, *([] if known else ["sid"])])
    (folder / "etc/dpkg/dpkg.cfg.d/fast").write_text("force-unsafe-io\n")
    # A copy of unstable on a mirror of one's own may be older than the archive lets it be.
    (folder / "etc/apt/apt.conf.d/80old-copy").write_text('Acquire::Check-Valid-Until "false";\n')
    inside(folder, f"apt-get -q update && apt-get -q -y --no-install-recommends install {' '.join(BASE)}", check=True)
    run(["git", "clone", "-q", "--no-hardlinks", str(TOP), str(folder / CLONE.lstrip("/"))])


def inside(folder, command, check=False):
    """CompletedProcess of a shell command within a system; of this one's environment it has proxies alone."""
    mounts = 'mount -t proc proc "$0/proc" && mount --rbind /dev "$0/dev" && mount -t tmpfs tmp "$0/tmp"'
    enter = ["unshare", "--mount", "--pid", "--fork", "--kill-child", "sh", "-c"]
    enter += [f'{mounts} && exec chroot "$0" /bin/sh -c "$1"', str(folder), command]
    kept = {name: value for name, value in os.environ.items() if name.lower().endswith("_proxy")}
    own = {"PATH": "/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin", "HOME": "/root", "TERM": "dumb"}
    return run(enter, check=check, env={**kept, **own, "LC_ALL": "C.UTF-8", "DEBIAN_FRONTEND": "noninteractive"})


def outcome(done):
    """What became of a command, with the last line that isn't make's own: of the tests their numbers."""
    lines = [line for line in (done.stdout + done.stderr).splitlines() if line and not line.startswith("make")]
    return f"{'failed' if done.returncode else 'passed'}: {lines[-1].strip('= ')[:150] if lines else done.returncode}"


def rows(names, commands):
    """(line of the table, whether it succeeded) of each command in each system; the next runs even if one fails."""
    mirror = next(address for address, _, suite in archives() if "-" not in suite)  # no update of another
    with tempfile.TemporaryDirectory(prefix="debian-", dir="/var/tmp") as scratch:
        for name in names:
            folder = Path(scratch, name)
            make(name, folder, mirror)
            for command in commands:
                begun = time.monotonic()
                done = inside(folder, f"cd {CLONE} && git config --global --add safe.directory {CLONE} && {command}")
                seconds = time.monotonic() - begun
                if done.returncode:
                    print((done.stdout + done.stderr)[-6000:], flush=True)
                versions = inside(folder, VERSIONS).stdout.strip(", ")
                yield f"| {name} | `{command}` | {outcome(done)} | {seconds:.0f} | {versions} |", not done.returncode


def commands_of_the_readme():
    """The first block of the README: what a new user calls, in order."""
    block = re.search(r"\n\n((?:    make .*\n)+)", (TOP / "README.md").read_text()).group(1)
    return [line.split("#")[0].strip() for line in block.strip().splitlines()]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="+", metavar="SUITE[-ARCHITECTURE]")
    parser.add_argument("--commands", nargs="+", metavar="COMMAND", help="instead of the README's")
    options = parser.parse_args()
    if os.geteuid() != 0 or not shutil.which("debootstrap"):
        sys.exit("debian_systems.py: must be run as root, with debootstrap installed (make test-debian)")
    (TOP / "build").mkdir(exist_ok=True)
    commit = run(["git", "-C", str(TOP), "rev-parse", "--short", "HEAD"]).stdout.strip()
    head = HEAD.format(commit=commit, cores=len(os.sched_getaffinity(0)))
    found = rows(options.names, options.commands or commands_of_the_readme())
    return 0 if write_page(TOP / "build/debian.md", head, found) else 1


if __name__ == "__main__":
    sys.exit(main())
