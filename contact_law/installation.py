"""Installs the suite so that it works without its checkout, and removes it: what make install and make uninstall call.

    python3 contact_law/installation.py install PREFIX       (after make)
    python3 contact_law/installation.py uninstall PREFIX

PREFIX/lib/contact_law holds the packages contact_law, analysis and yade_scripts, and the plugin in an overlay that
YADE_PREFIX may name. PREFIX/bin holds the commands. A line in a .pth file makes every Python 3 of the system find the
packages whose folders of modules lie in PREFIX: ~/.local, /usr/local, or PYTHONUSERBASE.
PREFIX/lib/contact_law/installed.json lists all files, before the first is there: these go again, and no others.
Exit status: 0, or 2 with one line on stderr.
"""

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

TOP = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(TOP))
from analysis.printable import printable, printable_lines, shell_line
from analysis.version import commit, version_text

FOLDER, LIST = "lib/contact_law", "installed.json"
COPIED = {
    "contact_law": ("*.py",),
    "analysis": (
        "**/*.py",
        "VERSION",
        "**/*.html",
        "**/*.js",
        "gallery/atlas/outcomes*.txt",
        "atlas/adapters/*.f90",
        "gallery/*/snapshots/*",
    ),
    "yade_scripts": ("**/*.py", "**/*.table", "studies/*.txt"),
}

# PYTHONPATH, not the folder that one stands in, says which packages these are.
_PYTHON = "PYTHONPATH={folder} exec /usr/bin/python3 -P "
COMMANDS = {
    "dust-collide": "exec yade -n -x {folder}/yade_scripts/collide.py",
    "dust-compress": "exec yade -n -x {folder}/yade_scripts/compress.py",
    "dust-study": _PYTHON + "{folder}/yade_scripts/study.py",
    "dust-packing": _PYTHON + "{folder}/yade_scripts/make_packing.py",
    "dust-analysis": _PYTHON + "-m analysis",
}


class CannotInstall(Exception):
    """The message is one line: what is in the way."""


def install(prefix):
    """Copy everything, replacing an earlier installation; returns the lines that say what one has now."""
    folder, paths = prefix / FOLDER, module_folders(prefix)
    if not list((TOP / "build").glob("lib/*/yade-double/libcontact_law.so")):
        raise CannotInstall(f"{TOP / 'build'}: holds no plugin; must be built before (make)")
    copied = {folder / name: TOP / name for name in _plan()}
    written = {path / "contact_law.pth": f"{folder}\n" for path in paths}
    for name, line in COMMANDS.items():
        written[prefix / "bin" / name] = f'#!/bin/sh\n{line.format(folder=shell_line([folder]))} "$@"\n'
    written[folder / "analysis/COMMIT"] = commit() + "\n"

    earlier = _listed(prefix) if os.path.lexists(folder) else []
    for path in (*copied, *written):
        if not _is_within(prefix, path):
            raise CannotInstall(f"{path.parent}: leads out of {prefix}; must be within")
        if os.path.lexists(path) and path not in earlier:
            raise CannotInstall(f"{path}: exists and is not part of an installation of contact_law; must be moved away")
    if earlier:
        uninstall(prefix)
    folder.mkdir(parents=True, exist_ok=True)
    names = sorted(str(path.relative_to(prefix)) for path in (*copied, *written))
    (folder / LIST).write_text(json.dumps(names, indent=0) + "\n")
    for path, source in copied.items():
        path.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(source, path, follow_symlinks=False)
    for path, text in written.items():
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        if path.name in COMMANDS:
            path.chmod(0o755)

    lines = [
        f"contact_law {version_text()} is installed in {folder}",
        f"commands in {prefix / 'bin'}: {' '.join(COMMANDS)}",
    ]
    if str(prefix / "bin") not in os.environ.get("PATH", "").split(os.pathsep):
        lines.append(f"to call them by name: PATH={shell_line([prefix / 'bin'])}:$PATH")
    if not paths:
        lines.append(f"no Python looks for modules in {prefix}: PYTHONPATH={shell_line([folder])} makes it find them")
    return lines


def uninstall(prefix):
    """Remove what install() has put there, what Python has made of it, and the folders that are empty then."""
    listed = [path for path in _listed(prefix) if _is_within(prefix, path)]
    for path in listed:
        path.unlink(missing_ok=True)
        for cache in path.parent.glob(f"__pycache__/{path.stem}.*.pyc"):
            if _is_within(prefix, cache):
                cache.unlink()
    (prefix / FOLDER / LIST).unlink()
    folders = {folder for path in listed for folder in (path.parent / "__pycache__", *path.parents)}
    for folder in sorted(folders, reverse=True):
        if prefix in folder.parents and _is_within(prefix, folder) and folder.is_dir() and not any(folder.iterdir()):
            folder.rmdir()
    return [f"contact_law is removed from {prefix}"]


def _listed(prefix):
    """The paths that were installed in the prefix. CannotInstall without a list of them."""
    file = prefix / FOLDER / LIST
    if not os.path.lexists(file.parent):
        raise CannotInstall(f"{file.parent}: no installation there")
    try:
        if not _is_within(prefix, file):
            raise ValueError
        listed = json.loads(file.read_text())
        return [
            prefix / (entry if isinstance(entry, str) else entry[0]) for entry in listed
        ]  # up to 0.6 each with a sum
    except (OSError, ValueError, TypeError, LookupError):
        raise CannotInstall(f"{file}: is no list of installed files; {file.parent} must be moved away") from None


def _is_within(prefix, path):
    """Whether a path leads to the prefix, not through .. or a link out of it."""
    return Path(os.path.realpath(path.parent)).is_relative_to(os.path.realpath(prefix)) and path.name not in ("", "..")


def module_folders(prefix):
    """The folders in PREFIX in which a Python 3 of PATH or of Debian looks for modules (and reads .pth files)."""
    folders = [*map(Path, os.environ.get("PATH", "").split(os.pathsep)), Path("/usr/bin")]
    pythons = {os.path.realpath(file) for folder in folders for file in folder.glob("python3*")}
    ask = "import json, site; print(json.dumps([site.getusersitepackages(), *site.getsitepackages()]))"
    found = []
    for python in sorted(python for python in pythons if re.fullmatch(r"python3(\.\d+)?", os.path.basename(python))):
        answer = subprocess.run([python, "-c", ask], capture_output=True, text=True)
        if answer.returncode == 0:
            inside = [Path(path) for path in json.loads(answer.stdout) if prefix in Path(path).parents]
            found += [path for path in inside[:1] if path not in found]
    return found


def _plan():
    """Paths from the checkout's top of what is copied: files, and links to YADE's own files."""
    files = [file for package, patterns in COPIED.items() for each in patterns for file in (TOP / package).glob(each)]
    files += [TOP / "build" / name for name in ("yade.list", "commit.list")]
    for part in ("lib", "bin"):
        for at, folders, names in os.walk(TOP / "build" / part):
            files += [Path(at) / name for name in names]
            files += [Path(at) / name for name in folders if (Path(at) / name).is_symlink()]
    return [str(file.relative_to(TOP)) for file in files]


def main(arguments):
    if len(arguments) != 2 or arguments[0] not in ("install", "uninstall"):
        print(__doc__)
        return 2
    action, prefix = arguments[0], Path(os.path.abspath(os.path.expanduser(arguments[1])))
    os.umask(0o022)  # all users may read an installation
    try:
        if not arguments[1] or not arguments[1].isprintable() or os.pathsep in arguments[1]:
            raise CannotInstall(f"PREFIX = {arguments[1]!r}: must be a folder, printable and without '{os.pathsep}'")
        print(printable_lines("\n".join({"install": install, "uninstall": uninstall}[action](prefix))))
    except (CannotInstall, OSError) as error:
        print(printable(f"make {action}: {error}"), file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
