"""Version and commit of this suite: VERSION beside this file, and git in a checkout or COMMIT where it is installed
(make install).

With pip the commit is "unknown"."""

import subprocess
from functools import cache
from pathlib import Path

_HERE = Path(__file__).resolve().parent
_TOP = _HERE.parent
_PARTS = ("contact_law", "analysis", "yade_scripts", "Makefile")


@cache
def version():
    """The version, such as "0.2.0"."""
    return (_HERE / "VERSION").read_text(encoding="utf-8").strip()


@cache
def commit():
    """The commit of the sources, with "-changed" where they differ from it; "unknown" without git."""
    installed = _HERE / "COMMIT"
    if installed.exists():
        return installed.read_text(encoding="utf-8").strip()
    if not (_TOP / ".git").exists():
        return "unknown"
    try:
        head = _git("rev-parse", "HEAD").stdout.strip()
        changed = _git("diff", "--quiet", "HEAD", "--", *_PARTS).returncode != 0
    except OSError:  # without git
        head = ""
    return head + ("-changed" if changed else "") if head else "unknown"


def version_text():
    """Both in one line."""
    return f"{version()}, commit {commit()}"


def _git(*arguments):
    return subprocess.run(["git", "-C", str(_TOP), *arguments], capture_output=True, text=True)
