"""Installs the suite so that it works without its checkout, and removes it: what make install and make uninstall call.

    python3 contact_law/installation.py install PREFIX       (after make)
    python3 contact_law/installation.py uninstall PREFIX

PREFIX/lib/contact_law holds the packages contact_law, analysis and yade_scripts with their tables, and the plugin in
an overlay that YADE_PREFIX may name. PREFIX/bin holds the commands. A line in a .pth file makes every Python 3 of the
system find the packages whose folders of modules lie in PREFIX: ~/.local, /usr/local, or PYTHONUSERBASE.
PREFIX/lib/contact_law/installed.json lists every file with its SHA-256: these go again, where they still are what was
installed, and no others. Links are not followed. What a call that was killed has left, the next one removes.
Exit status: 0, or 2 with one line on stderr.
"""

import fcntl
import glob
import hashlib
import json
import os
import re
import secrets
import shutil
import subprocess
import sys
from contextlib import contextmanager, suppress
from pathlib import Path

TOP = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(TOP))
from analysis.printable import printable, printable_lines, shell_line
from analysis.runs.files import remove_unfinished, write_file
from analysis.version import commit, version_text

FOLDER, LIST, PATH_FILE = "lib/contact_law", "installed.json", "contact_law.pth"
TEMPORARY = ".contact_law.{}.unfinished"  # folders beside FOLDER
COMMIT_FILE = "analysis/COMMIT"
COPIED = {
    "contact_law": ("*.py",),
    "analysis": (
        "**/*.py",
        "VERSION",
        "**/*.html",
        "**/*.js",
        "studies/*/*.toml",
        "studies/*/*.csv",
        "gallery/*/*.json",
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
    beside = {**_commands(prefix / "bin", folder), **{path / PATH_FILE: f"{folder}\n" for path in paths}}
    for part in (folder, *beside):
        if not _is_within(prefix, part):
            raise CannotInstall(f"{part.parent}: leads out of {prefix}; must be within")
    folder.parent.mkdir(parents=True, exist_ok=True)
    with _alone(prefix):
        _require_free(prefix, beside)
        with _temporary(prefix) as temporary:
            new = temporary / FOLDER
            _fill(new, {str(path.relative_to(prefix)): _sha256(text.encode()) for path, text in beside.items()})
            if folder.exists():
                _remove(prefix, _listed(prefix))
            new.rename(folder)
        for path, text in beside.items():
            path.parent.mkdir(parents=True, exist_ok=True)
            write_file(path, text)
            path.chmod(0o755 if path.name in COMMANDS else 0o644)
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
    """Remove what install() made there; returns the lines that say so, and what was left."""
    with _alone(prefix):
        left = _remove(prefix, _listed(prefix))
    return [f"contact_law is removed from {prefix}", *left]


def _remove(prefix, listed, whole=True):
    """Remove listed files and the folders that are empty then; a line for each that is left. whole: only those that are what was
    installed."""
    folder, left = prefix / FOLDER, []
    for path, digest in listed.items():
        if _is_as_installed(prefix, path, digest) or not whole and _is_within(prefix, path) and path.is_file():
            path.unlink()
        elif os.path.lexists(path):
            left.append(f"{path}: is not what was installed in {prefix}; is left there")
    for path in {cache for path in listed if _is_within(prefix, path) for cache in _caches(path)}:
        path.unlink()
    ours = {path.parent for path in listed} | {path.parent / "__pycache__" for path in listed} | {folder}
    for path in ours:
        if _is_within(prefix, path / LIST):
            remove_unfinished(path)
    (folder / LIST).unlink()
    for path in sorted(ours, key=lambda path: len(path.parts), reverse=True):
        _remove_empty(path, prefix)
    return left


@contextmanager
def _alone(prefix):
    """Once nobody else installs or removes anything in the prefix; what killed calls have left there is gone then."""
    folder = (prefix / FOLDER).parent
    if not folder.is_dir():
        raise CannotInstall(f"{prefix / FOLDER}: no installation there")
    handle = os.open(folder, os.O_RDONLY)
    try:
        with suppress(OSError):  # of a file system without locks
            fcntl.flock(handle, fcntl.LOCK_EX)
        for left in folder.glob(TEMPORARY.format("*")):
            _remove_temporary(left)
        _remove_empty_below(prefix / FOLDER)  # uninstall was killed among its last calls
        yield
    finally:
        os.close(handle)


@contextmanager
def _temporary(prefix):
    """A folder beside the installation's place, which goes again, for an installation that takes this place when it is whole."""
    made = (prefix / FOLDER).parent / TEMPORARY.format(
        secrets.token_hex(4)
    )  # a name that runs.files.is_unfinished() knows
    made.mkdir(0o700)
    try:
        yield made
    finally:
        _remove_temporary(made)


def _remove_temporary(folder):
    """Remove what _fill() has listed, and nothing else."""
    if folder.is_symlink():
        return
    with suppress(CannotInstall):  # killed before there was a list
        _remove(folder, _listed(folder), whole=False)
    remove_unfinished(folder / FOLDER)
    _remove_empty_below(folder)


def _remove_empty_below(folder):
    """Remove the folder and those in it, if there is nothing else in it."""
    if not folder.is_symlink() and not any(_files(folder)):
        for at, *_ in os.walk(folder, topdown=False):
            os.rmdir(at)


def _require_free(prefix, beside):
    """CannotInstall where something is in the way that is not part of an earlier installation. beside: paths that are written
    outside of its folder."""
    folder = prefix / FOLDER
    listed = _listed(prefix) if os.path.lexists(folder) else {}
    own = {path for path, digest in listed.items() if _is_as_installed(prefix, path, digest)}
    own |= {cache for path in own for cache in _caches(path)} | {folder / LIST}
    for path in (*_files(folder), *filter(os.path.lexists, beside)):
        if path not in own:
            raise CannotInstall(f"{path}: exists and is not part of an installation of contact_law; must be moved away")


def _listed(prefix):
    """{path: digest} of what was installed in the prefix. CannotInstall where there is no list, or another one."""
    file = prefix / FOLDER / LIST
    if not _is_within(prefix, file) or not os.path.lexists(file.parent):
        raise CannotInstall(f"{file.parent}: no installation there")
    try:
        listed = {prefix / path: digest for path, digest in json.loads(file.read_text())}
        if not listed:
            raise ValueError
    except (OSError, ValueError, TypeError):
        raise CannotInstall(
            f"{file}: is no list of files with their SHA-256; {file.parent} must be moved away (and what an earlier version has put "
            f"into {prefix / 'bin'})"
        ) from None
    return listed


def _is_as_installed(prefix, path, digest):
    return _is_within(prefix, path) and _digest(path) == digest


def _is_within(prefix, path):
    """Whether a path leads to the prefix, not through a link out of it."""
    return Path(os.path.realpath(path.parent)).is_relative_to(os.path.realpath(prefix)) and path.name not in ("", "..")


def _digest(path):
    """SHA-256 of a file, where a link leads; None for anything else."""
    if path.is_symlink():
        return f"link to {os.readlink(path)}"
    return _sha256(path.read_bytes()) if path.is_file() else None


def _sha256(content):
    return hashlib.sha256(content).hexdigest()


def _files(folder):
    """Paths of everything below a folder but folders; links are not followed."""
    for at, folders, files in os.walk(folder):
        yield from (Path(at) / name for name in files)
        yield from (path for name in folders if (path := Path(at) / name).is_symlink())


def _caches(path):
    """Files that Python has made of a module."""
    folder = path.parent / "__pycache__"
    found = folder.glob(f"{path.stem}.*") if path.suffix == ".py" and not folder.is_symlink() else ()
    return [file for file in found if file.is_file() and not file.is_symlink()]


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
    files = [file for folder in folders for file in glob.glob(f"{glob.escape(folder)}/python3*")]
    files = {os.path.realpath(file) for file in files if re.fullmatch(r"python3(\.\d+)?", os.path.basename(file))}
    return sorted(file for file in files if os.access(file, os.X_OK))


def _commands(folder, target):
    """{path: text} of the commands in a folder, of an installation in `target`."""
    return {
        folder / name: f'#!/bin/sh\n{line.format(folder=shell_line([target]))} "$@"\n'
        for name, line in COMMANDS.items()
    }


def _fill(new, beside):
    """Make an installation in the folder `new`, its list first. beside: {path: digest} of files outside of it."""
    plan, told = _plan(), commit() + "\n"
    listed = {f"{FOLDER}/{name}": _digest(file) for name, file in plan.items()}
    listed |= {f"{FOLDER}/{COMMIT_FILE}": _sha256(told.encode()), **beside}
    new.mkdir(parents=True)
    write_file(new / LIST, json.dumps(sorted(listed.items()), indent=0) + "\n")
    for name, file in plan.items():
        (new / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(file, new / name, follow_symlinks=False)
    write_file(new / COMMIT_FILE, told)
    for at, _, names in os.walk(new):  # for all users, whatever the umask is
        os.chmod(at, 0o755)
        for file in (Path(at) / name for name in names):
            if not file.is_symlink():
                file.chmod(0o755 if file.stat().st_mode & 0o100 else 0o644)


def _plan():
    """{path in the installation: file or link that is copied there}."""
    files = [file for package, patterns in COPIED.items() for each in patterns for file in (TOP / package).glob(each)]
    files += [TOP / "build" / name for name in ("yade.list", "commit.list")]
    for part in ("lib", "bin"):  # links to YADE's own files, and the plugin
        files += _files(TOP / "build" / part)
    return {str(file.relative_to(TOP)): file for file in files}


def _remove_empty(folder, prefix):
    """The folder and those above it, up to the prefix, as far as they are empty."""
    while prefix in folder.parents and _is_within(prefix, folder) and folder.is_dir() and not any(folder.iterdir()):
        folder.rmdir()
        folder = folder.parent


def main(arguments):
    if len(arguments) != 2 or arguments[0] not in ("install", "uninstall"):
        print(__doc__)
        return 2
    action, prefix = arguments[0], Path(os.path.abspath(os.path.expanduser(arguments[1])))
    try:
        if not arguments[1] or arguments[1].startswith("~") and str(prefix).startswith(os.path.abspath("~")):
            raise CannotInstall(f"PREFIX = {arguments[1]!r}: must be a folder")
        if not str(prefix).isprintable() or os.pathsep in str(prefix):
            raise CannotInstall(f"{prefix}: must be of printable characters, without '{os.pathsep}'")
        print(printable_lines("\n".join({"install": install, "uninstall": uninstall}[action](prefix))))
    except CannotInstall as error:
        print(printable(f"make {action}: {error}"), file=sys.stderr)
        return 2
    except OSError as error:
        file = error.filename2 or error.filename or prefix  # of a copy the place, not the source
        print(printable(f"make {action}: {file}: {error.strerror}"), file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
