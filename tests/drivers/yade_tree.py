"""The plugin compiled against YADE's own headers, and loaded. Run by `make yade-tree`.

Downloads the source of the YADE that is installed from Debian's archive (14 MB; Debian 13 has it), compiles the last
commit in build/yade-tree with YADE_INCLUDE, and runs an example and tests with the result.
"""

import os
import re
import shutil
import subprocess
import sys
import time

from debian_systems import TOP, archives, run

FOLDER = TOP / "build/yade-tree"
SOURCE, CLONE = FOLDER / "source", FOLDER / "clone"
CHECKS = (
    ["yade", "-n", "-x", "yade_scripts/examples/pair.py"],
    [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", "-q", "tests/physics/test_pairs.py"],
)


def installed_version():
    """Of Debian's package yade, without Debian's own revision."""
    return re.sub(r"^\d+:|-[^-]*$", "", run(["dpkg-query", "-W", "-f", "${Version}", "yade"]).stdout)


def fetch(version):
    """YADE's source in SOURCE. Lists and caches of apt's are its own, so that it needs no root."""
    if (SOURCE / "core/Scene.hpp").exists():
        return
    apt = FOLDER / "apt"
    for part in ("lists/partial", "archives/partial"):
        (apt / part).mkdir(parents=True, exist_ok=True)
    sources = [f"deb-src {address} {name} main\n" for address, name, _ in archives()]
    (apt / "sources.list").write_text("".join(sources))
    places = {"Etc::SourceList": "sources.list", "State::lists": "lists", "Cache": ".", "Cache::archives": "archives"}
    options = [word for name, place in places.items() for word in ("-o", f"Dir::{name}={apt / place}")]
    options += ["-o", "Dir::Etc::SourceParts=-", "-o", "APT::Sandbox::User="]
    run(["apt-get", *options, "-q", "update"])
    # Where Debian's own parts of the source package are missing, apt fails after it has checked and kept YADE's.
    subprocess.run(["apt-get", *options, "-q", "source", "--download-only", "yade"], cwd=apt, capture_output=True)
    files = [file for file in apt.glob(f"yade_{version}.orig.tar.*") if file.suffix != ".asc"]
    if not files:
        sys.exit(f"yade {version}: Debian's archive has no source of it")
    unpacked = FOLDER / "unpacked"
    shutil.rmtree(unpacked, ignore_errors=True)
    unpacked.mkdir()
    run(["tar", "-xf", files[0], "-C", unpacked])
    next(unpacked.iterdir()).rename(SOURCE)


def main():
    version = installed_version()
    FOLDER.mkdir(parents=True, exist_ok=True)
    fetch(version)
    shutil.rmtree(CLONE, ignore_errors=True)
    run(["git", "clone", "-q", TOP, CLONE])
    begun = time.monotonic()
    run(["make", f"YADE_INCLUDE={SOURCE}"], cwd=CLONE)
    print(f"compiled against the headers of YADE {version}: {time.monotonic() - begun:.0f} s", flush=True)
    environment = {name: value for name, value in os.environ.items() if name != "YADE_PREFIX"}
    for command in CHECKS:
        print(run(command, cwd=CLONE, env=environment).stdout.strip().splitlines()[-1], flush=True)


if __name__ == "__main__":
    main()
