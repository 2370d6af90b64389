"""Installs the suite so that it works without its checkout, and removes it: what make install and make uninstall call.

    python3 contact_law/installation.py install PREFIX       (after make)
    python3 contact_law/installation.py uninstall PREFIX

PREFIX/lib/contact_law holds the packages contact_law, analysis and yade_scripts with their tables, and the plugin in
an overlay that YADE_PREFIX may name. PREFIX/bin holds the commands. A line in a .pth file makes every Python 3 of the
system find the packages whose folders of modules lie in PREFIX: ~/.local, /usr/local, or PYTHONUSERBASE.
Exit status: 0, or 2 with one line on stderr.
"""

import glob
import json
import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

TOP = Path(__file__).resolve().parents[1]
FOLDER, LIST, PATH_FILE = "lib/contact_law", "installed.json", "contact_law.pth"
COPIED = {
    "contact_law": ("*.py", "VERSION"),
    "analysis": ("**/*.py", "**/*.html", "gallery/*/*.csv", "gallery/*/*.json", "gallery/*/README.md"),
    "yade_scripts": ("**/*.py", "**/*.table"),
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
    folder, new = prefix / FOLDER, prefix / (FOLDER + ".new")
    if not list((TOP / "build").glob("lib/*/yade-double/libcontact_law.so")):
        raise CannotInstall(f"{TOP / 'build'}: holds no plugin; must be built before (make)")
    _require_free(prefix)
    shutil.rmtree(new, ignore_errors=True)
    for package, patterns in COPIED.items():
        for file in {f for pattern in patterns for f in (TOP / package).glob(pattern)}:
            _copy(file, new / file.relative_to(TOP))
    for file in ("yade_version.list", "commit.list"):
        _copy(TOP / "build" / file, new / "build" / file)
    for part in ("lib", "bin"):  # links to YADE's own files, and the plugin
        shutil.copytree(TOP / "build" / part, new / "build" / part, symlinks=True)
    sys.path.insert(0, str(TOP))
    from analysis.version import commit, version_text

    (new / "contact_law/COMMIT").write_text(commit() + "\n")
    about = f"contact_law {version_text()}"
    uninstall(prefix, missing_ok=True)
    new.rename(folder)
    paths = module_folders(prefix)
    made = [*_write_commands(prefix / "bin", folder), *_write_path_files(paths, folder)]
    (folder / LIST).write_text(json.dumps([str(path) for path in made], indent=1))
    lines = [f"{about} is installed in {folder}", f"commands in {prefix / 'bin'}: {' '.join(COMMANDS)}"]
    if str(prefix / "bin") not in os.environ.get("PATH", "").split(os.pathsep):
        lines.append(f"to call them by name: PATH={prefix / 'bin'}:$PATH")
    if not paths:
        lines.append(f"no Python looks for modules in {prefix}: PYTHONPATH={folder} makes it find them")
    return lines


def _require_free(prefix):
    """CannotInstall where something is in the way that is not part of an earlier installation."""
    folder = prefix / FOLDER
    if folder.exists() and not (folder / LIST).is_file():
        raise CannotInstall(f"{folder}: exists and is not an installation of contact_law; must be moved away")
    own = set(json.loads((folder / LIST).read_text())) if folder.exists() else ()
    for file in (prefix / "bin" / name for name in COMMANDS):
        if os.path.lexists(file) and str(file) not in own:
            raise CannotInstall(f"{file}: exists and is not part of an installation of contact_law; must be moved away")


def uninstall(prefix, missing_ok=False):
    """Remove what install() made there; returns the lines that say so."""
    folder = prefix / FOLDER
    if not (folder / LIST).is_file():
        if missing_ok:
            return []
        raise CannotInstall(f"{folder}: no installation there")
    for path in map(Path, json.loads((folder / LIST).read_text())):
        path.unlink(missing_ok=True)
        _remove_empty(path.parent, prefix)
    shutil.rmtree(folder)
    _remove_empty(folder.parent, prefix)
    return [f"contact_law is removed from {prefix}"]


def module_folders(prefix):
    """The folders in PREFIX in which a Python 3 of this system looks for modules (and reads .pth files)."""
    ask = "import json, site; print(json.dumps([site.getusersitepackages(), *site.getsitepackages()]))"
    found = []
    for python in _pythons():
        answer = subprocess.run([python, "-c", ask], capture_output=True, text=True)
        if answer.returncode == 0:
            inside = [Path(path) for path in json.loads(answer.stdout) if prefix in Path(path).parents]
            found += [path for path in inside[:1] if path not in found]
    return found


def _pythons():
    """python3 of PATH and of Debian, and every python3.N beside them."""
    folders = dict.fromkeys([*os.environ.get("PATH", "").split(os.pathsep), "/usr/bin"])
    files = [file for folder in folders for file in glob.glob(f"{folder}/python3*")]
    files = {os.path.realpath(file) for file in files if re.fullmatch(r"python3(\.\d+)?", os.path.basename(file))}
    return sorted(file for file in files if os.access(file, os.X_OK))


def _write_commands(folder, target):
    for name, line in COMMANDS.items():
        file = folder / name
        folder.mkdir(parents=True, exist_ok=True)
        file.write_text(f'#!/bin/sh\n{line.format(folder=shlex.quote(str(target)))} "$@"\n')
        file.chmod(0o755)
        yield file


def _write_path_files(folders, target):
    for folder in folders:
        folder.mkdir(parents=True, exist_ok=True)
        file = folder / PATH_FILE
        file.write_text(f"{target}\n")
        yield file


def _copy(file, target):
    target.parent.mkdir(parents=True, exist_ok=True)
    shutil.copy2(file, target)


def _remove_empty(folder, prefix):
    """The folder and those above it, up to the prefix, as far as they are empty."""
    while folder != prefix and prefix in folder.parents and not any(folder.iterdir()):
        folder.rmdir()
        folder = folder.parent


def main(arguments):
    if len(arguments) != 2 or arguments[0] not in ("install", "uninstall"):
        print(__doc__)
        return 2
    action, prefix = arguments[0], Path(os.path.abspath(os.path.expanduser(arguments[1])))
    try:
        print("\n".join({"install": install, "uninstall": uninstall}[action](prefix)))
    except CannotInstall as error:
        print(f"make {action}: {error}", file=sys.stderr)
        return 2
    except OSError as error:
        print(f"make {action}: {error.filename}: {error.strerror}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
