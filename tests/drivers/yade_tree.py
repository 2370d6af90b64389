"""The plugin compiled against YADE's own headers, and loaded. Run by `make yade-tree`.

Downloads the source of the YADE that is installed from Debian's archive (14 MB; Debian 13 has it), compiles the last
commit in build/yade-tree with YADE_INCLUDE, and runs an example and tests with the result.
"""

import os
import shutil
import sys
import time

from debian_systems import TOP, run

FOLDER = TOP / "build/yade-tree"
SOURCE, CLONE = FOLDER / "source", FOLDER / "clone"
FETCH = TOP / "contact_law/yade_interface/source.py"
CHECKS = (
    ["yade", "-n", "-x", "yade_scripts/examples/pair.py"],
    [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", "-q", "tests/physics/test_pairs.py"],
)


def main():
    version = run(["dpkg-query", "-W", "-f", "${Version}", "yade"]).stdout
    run([sys.executable, FETCH, SOURCE])
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
