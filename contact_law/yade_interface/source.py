"""Fetches the source of the YADE that is installed from the archive that has it, for its headers; needs no root.

    python3 source.py FOLDER      which holds it afterwards (make yade-tree, and make with a YADE that is not described)

Exit status: 0, or 2 with one line on stderr."""

import re
import shutil
import subprocess
import sys
from pathlib import Path


def fetch(folder):
    """YADE's source in a folder, unless it is there. Lists and caches of apt's are its own, beside it."""
    if (folder / "core/Scene.hpp").exists():
        return
    apt, unpacked = folder.with_name("apt"), folder.with_name("unpacked")
    for part in ("lists/partial", "archives/partial"):
        (apt / part).mkdir(parents=True, exist_ok=True)
    version = _output("dpkg-query", "-W", "-f", "${source:Version}", "yade")
    places = [line.split("|")[2].split() for line in _output("apt-cache", "madison", "yade").splitlines()]
    sources = {f"deb-src {address} {release.replace('/', ' ')}\n" for address, release, *_ in places}
    (apt / "sources.list").write_text("".join(sorted(sources)))
    options = {"Etc::SourceList": "sources.list", "State::lists": "lists", "Cache": ".", "Cache::archives": "archives"}
    words = [word for name, place in options.items() for word in ("-o", f"Dir::{name}={(apt / place).absolute()}")]
    words += ["-o", "Dir::Etc::SourceParts=-", "-o", "APT::Sandbox::User="]
    _output("apt-get", *words, "-q", "update")
    # Where the distribution's own parts of the source package are missing, apt fails after it has kept YADE's.
    asked = ["apt-get", *words, "-q", "source", "--download-only", f"yade={version}"]
    done = subprocess.run(asked, cwd=apt, capture_output=True, text=True)
    upstream = re.sub(r"^\d+:|-[^-]*$", "", version)  # without epoch and the distribution's revision
    files = [file for file in apt.glob(f"yade_{upstream}.orig.tar.*") if file.suffix != ".asc"]
    if not files:
        raise OSError((done.stderr.strip() or "no such source package").splitlines()[0])
    shutil.rmtree(unpacked, ignore_errors=True)
    shutil.unpack_archive(files[0], unpacked)
    shutil.rmtree(folder, ignore_errors=True)
    next(unpacked.iterdir()).rename(folder)


def _output(*command):
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        raise OSError(f"{' '.join(command[:1])}: {(done.stderr.strip() or str(done.returncode)).splitlines()[-1]}")
    return done.stdout.strip()


if __name__ == "__main__":
    try:
        fetch(Path(sys.argv[1]))
    except OSError as error:
        print(f"make: the source of the YADE that is installed can't be had: {error}", file=sys.stderr)
        sys.exit(2)
