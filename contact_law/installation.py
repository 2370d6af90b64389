"""Installs the suite so that it works without its checkout, and removes it: what make install and make uninstall call.

    python3 contact_law/installation.py install PREFIX       (after make)
    python3 contact_law/installation.py uninstall PREFIX

PREFIX/lib/contact_law holds the packages contact_law, analysis and yade_scripts, and the plugin in an overlay that
YADE_PREFIX may name. PREFIX/bin holds the commands. A line in a .pth file makes /usr/bin/python3 find the packages if
it looks for modules in PREFIX: ~/.local, /usr/local, or PYTHONUSERBASE.
PREFIX/lib/contact_law/installed.json lists all files, before the first is there: these go again, and no others.
Exit status: 0, or 2 with one line on stderr.
"""

import json
import os
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

PYTHON = "/usr/bin/python3"
# PYTHONPATH, not the folder that one stands in, says which packages these are.
_PYTHON = f"PYTHONPATH={{folder}} exec {PYTHON} -P "
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
    folder, modules = prefix / FOLDER, module_folder(prefix)
    if not list((TOP / "build").glob("lib/*/yade-double/libcontact_law.so")):
        raise CannotInstall(f"{TOP / 'build'}: holds no plugin; must be built before (make)")
    copied = {folder / file.relative_to(TOP): file for file in _plan()}
    written = {folder / "analysis/COMMIT": commit() + "\n"}
    if modules:
        written[modules / "contact_law.pth"] = f"{folder}\n"
    for name, line in COMMANDS.items():
        written[prefix / "bin" / name] = f'#!/bin/sh\n{line.format(folder=shell_line([folder]))} "$@"\n'

    earlier = _listed(prefix) if os.path.lexists(folder) else []
    for path in (*copied, *written):
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
        path.chmod(0o755 if path.name in COMMANDS else 0o644)

    lines = [f"contact_law {version_text()} is installed in {folder}"]
    lines.append(f"commands in {prefix / 'bin'}: {' '.join(COMMANDS)}")
    if str(prefix / "bin") not in os.environ.get("PATH", "").split(os.pathsep):
        lines.append(f"to call them by name: PATH={shell_line([prefix / 'bin'])}:$PATH")
    if not modules:
        lines.append(f"{PYTHON} looks for no modules in {prefix}: PYTHONPATH={shell_line([folder])} makes it find them")
    return lines


def uninstall(prefix):
    """Remove what install() has put there, what Python has made of it, and the folders that are empty then."""
    listed = _listed(prefix)
    for path in listed:
        for file in (path, *path.parent.glob(f"__pycache__/{path.stem}.*.pyc")):
            file.unlink(missing_ok=True)
    (prefix / FOLDER / LIST).unlink()
    folders = {folder for path in listed for folder in (path.parent / "__pycache__", *path.parents)}
    for folder in sorted(folders, reverse=True):
        if prefix in folder.parents and folder.is_dir() and not any(folder.iterdir()):
            folder.rmdir()
    return [f"contact_law is removed from {prefix}"]


def _listed(prefix):
    """The paths that were installed in the prefix. CannotInstall without a list of them."""
    file = prefix / FOLDER / LIST
    if not os.path.lexists(file.parent):
        raise CannotInstall(f"{file.parent}: no installation there")
    try:
        listed = json.loads(file.read_text())
        return [prefix / (entry if isinstance(entry, str) else entry[0]) for entry in listed]  # to 0.6 with a sum each
    except (OSError, ValueError, TypeError, LookupError):
        raise CannotInstall(f"{file}: is no list of installed files; {file.parent} must be moved away") from None


def module_folder(prefix):
    """The folder in PREFIX in which Debian's Python looks for modules (and reads .pth files), or None."""
    ask = "import json, site; print(json.dumps([site.getusersitepackages(), *site.getsitepackages()]))"
    folders = map(Path, json.loads(subprocess.run([PYTHON, "-c", ask], stdout=subprocess.PIPE, check=True).stdout))
    return next((folder for folder in folders if prefix in folder.parents), None)


def _plan():
    """What is copied of the checkout: files, and links to YADE's own files."""
    yield from (file for name, patterns in COPIED.items() for each in patterns for file in (TOP / name).glob(each))
    yield from (TOP / "build" / name for name in ("yade.list", "commit.list"))
    for part in ("lib", "bin"):
        for at, folders, names in os.walk(TOP / "build" / part):
            yield from (Path(at) / name for name in names)
            yield from (Path(at) / name for name in folders if (Path(at) / name).is_symlink())


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
