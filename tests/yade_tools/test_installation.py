"""make install into a folder of its own: everything works from any folder, without the checkout; make uninstall."""

import hashlib
import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from running import small_disk, wait_for, waits_for_a_lock

TOP = Path(__file__).resolve().parents[2]
INSTALLER = str(TOP / "contact_law/installation.py")
COMMANDS = ("dust-analysis", "dust-collide", "dust-compress", "dust-packing", "dust-study")
SMALL = ("grains=30", "packing=bpca", "velocity=20", "duration=2e-9", "stepFraction=0.1")


def installation(action, prefix, base=None, within=()):
    """An installation or removal that ended; within: what Python is given before the installer."""
    command = [sys.executable, *within, INSTALLER, action, str(prefix)]
    environment = {**os.environ, "PYTHONUSERBASE": str(base or prefix)}
    return subprocess.run(command, capture_output=True, text=True, env=environment)


# installation.py with a function that sends the process a signal at a call, counted from 0.
SIGNALLED = """
import os, pathlib, runpy, shutil, sys
place, name, calls, number = {"copy2": shutil, "rmdir": os, "unlink": pathlib.Path}, sys.argv[1], *map(int, sys.argv[2:4])
own = getattr(place[name], name)
def signalled(*arguments, **more):
    global calls
    calls -= 1
    calls == -1 and os.kill(os.getpid(), number)
    return own(*arguments, **more)
setattr(place[name], name, signalled)
if name == "rmdir":
    pathlib.Path.rmdir = signalled
sys.argv = sys.argv[4:]
runpy.run_path(sys.argv[0], run_name="__main__")
"""


def signalled(function, calls, number):
    """What Python is given before the installer."""
    return "-c", SIGNALLED, function, str(calls), str(int(number))


def killed(action, prefix, function, calls):
    """An installation or removal that is killed at so many calls of a function."""
    done = installation(action, prefix, within=signalled(function, calls, signal.SIGKILL))
    assert done.returncode == -signal.SIGKILL, done.stderr


def refused(done, words):
    assert done.returncode == 2 and done.stderr.count("\n") == 1 and words in done.stderr


@pytest.fixture(scope="module")
def installed(tmp_path_factory):
    """(prefix, call): call(command, ...) runs in an empty folder with nothing but the installation to be found."""
    prefix, elsewhere = tmp_path_factory.mktemp("prefix with a space"), tmp_path_factory.mktemp("elsewhere")
    done = installation("install", prefix)
    assert done.returncode == 0, done.stderr
    paths = {"PATH": f"{prefix}/bin:/usr/bin:/bin", "HOME": str(elsewhere), "PYTHONUSERBASE": str(prefix)}
    how = dict(cwd=elsewhere, env={**paths, "LC_ALL": "C.UTF-8"}, capture_output=True, text=True, timeout=120)
    return prefix, lambda *command: subprocess.run(command, **how)


@pytest.mark.parametrize(
    "environment, told, place",
    [
        ((), "__file__", "lib/contact_law/contact_law/__init__.py"),
        # plain YADE finds it in the overlay
        (("YADE_PREFIX={}/lib/contact_law/build", "PYTHONUSERBASE=/nowhere"), "LIBRARY", "lib/contact_law/build/lib"),
    ],
    ids=["user's site", "overlay"],
)
def test_a_script_of_any_folder_imports_the_contact_law(installed, tmp_path, environment, told, place):
    prefix, call = installed
    script = tmp_path / "script.py"
    words = f"contact_law.{told}, JKRMat().young, contact_law.commit, contact_law.__version__"
    script.write_text(f"import contact_law\nprint('found', {words})\n")
    done = call("env", *(word.format(prefix) for word in environment), "yade", "-n", "-x", str(script))
    assert done.returncode == 0, done.stderr
    assert f"found {prefix}/{place}" in done.stdout


def test_any_python_imports_the_analysis_and_commands_tell_its_version_and_commit(installed):
    prefix, call = installed
    ask = "import analysis; print(analysis.__file__, analysis.__version__, analysis.commit)"
    file, version, commit = call("/usr/bin/python3", "-c", ask).stdout.rsplit(maxsplit=2)
    assert file == f"{prefix}/lib/contact_law/analysis/__init__.py"
    assert version == (TOP / "analysis/VERSION").read_text().strip() and commit
    told = set()
    for command in COMMANDS:
        done = call(command, "--version")
        assert done.returncode == 0, done.stderr
        told |= {line.split(" ", 1)[1] for line in done.stdout.splitlines() if ", commit " in line}
    assert len(told) == 1


def test_a_collision_and_its_summary(installed, tmp_path):
    _, call = installed
    run = tmp_path / "run"
    done = call("dust-collide", *SMALL, f"out={run}")
    assert done.returncode == 0, done.stdout + done.stderr
    done = call("dust-analysis", "summary", str(run))
    assert done.returncode == 0 and "outcome" in done.stdout
    swept = call("/usr/bin/python3", "-c", "from yade_scripts import collide; collide(velocity=-1)")
    assert swept.stderr.splitlines()[-1].endswith("ParameterError: velocity = -1: must be > 0 [m/s]")


def test_a_study_by_the_name_of_its_table(installed):
    """Its rows name scripts of the suite, which are found from any folder."""
    _, call = installed
    for name in ("demo", "compression-desk"):
        done = call("dust-study", name, "--status")
        assert done.returncode == 0, done.stderr
        assert "no such script" not in done.stdout + done.stderr and "waiting" in done.stdout
    assert call("dust-study", "no-such-study").returncode == 2


def test_files_that_the_analysis_reads_are_installed(installed):
    prefix, call = installed
    ask = "from analysis.studies.study import GALLERY; print(GALLERY)"
    gallery = Path(call("/usr/bin/python3", "-c", ask).stdout.strip())
    assert gallery.is_relative_to(prefix)
    for pattern in "gallery/*/*.json gallery/*/snapshots/* studies/*.html studies/*/*.toml studies/*/*.csv".split():
        files = list((TOP / "analysis").glob(pattern))
        assert files
        for file in files:
            assert (gallery.parent / file.relative_to(TOP / "analysis")).read_bytes() == file.read_bytes()


def test_no_link_of_an_installation_leads_to_the_checkout(installed):
    prefix, call = installed
    links = {path: Path(os.path.realpath(path)) for path in prefix.rglob("*") if path.is_symlink()}
    assert [path for path, place in links.items() if place.is_relative_to(TOP)] == []
    assert prefix / "lib/contact_law/contact_law" in links.values()


def test_installing_again_and_removing_leave_nothing_behind(tmp_path):
    """Nor a command that a killed installation has half written."""
    (tmp_path / "bin").mkdir()
    (tmp_path / "bin/other").write_text("another program")
    for action in ("install", "install"):
        assert installation(action, tmp_path).returncode == 0
    assert {file.name for file in (tmp_path / "bin").iterdir()} == {*COMMANDS, "other"}
    (tmp_path / "bin/.dust-study.0123abcd.unfinished").write_text("#!/bin")
    assert installation("uninstall", tmp_path).returncode == 0
    assert [path for path in tmp_path.rglob("*") if path.is_file() or path.is_symlink()] == [tmp_path / "bin/other"]
    refused(installation("uninstall", tmp_path), "")


def test_only_what_was_installed_is_removed(tmp_path):
    """Others' files in the installation and outside of it, changed ones, and what leads out by a name or a link."""
    prefix, outside = tmp_path / "prefix", tmp_path / "outside"
    (outside / "__pycache__").mkdir(parents=True)
    assert installation("install", prefix).returncode == 0
    folder = prefix / "lib/contact_law"
    changed, mine = folder / "yade_scripts/studies/demo.table", folder / "yade_scripts/studies/mine.table"
    for file in (changed, mine, outside / "named", outside / "analysis.py", outside / "__pycache__/analysis.1"):
        file.write_text("mine")
    (folder / "analysis/theory").rename(outside / "theory")
    (folder / "analysis/theory").symlink_to(outside / "theory")
    listed = json.loads((folder / "installed.json").read_text())
    digest = hashlib.sha256(b"mine").hexdigest()
    listed += [[str(outside / "named"), digest], ["../outside/analysis.py", digest]]
    (folder / "installed.json").write_text(json.dumps(listed))
    kept = {file: file.read_bytes() for file in [changed, mine, *outside.rglob("*.*"), outside / "named"]}
    refused(installation("install", prefix), "must be moved away")
    done = installation("uninstall", prefix)
    assert done.returncode == 0 and f"{changed}: is not what was installed" in done.stdout
    assert {file: file.read_bytes() for file in kept} == kept
    assert {path for path in prefix.rglob("*") if path.is_file()} == {changed, mine}


@pytest.mark.parametrize("again", ["install", "uninstall"])
def test_a_killed_installation_is_cleaned_up_by_the_next_call(tmp_path, again):
    """What it has copied goes; files in, beside and below its folder that it did not make stay."""
    lib, mine = tmp_path / "lib", tmp_path / "lib/.contact_law.notes.unfinished/mine"
    mine.parent.mkdir(parents=True)
    mine.write_text("mine")
    for calls in (0, 20):
        killed("install", tmp_path, "copy2", calls)
    (left,) = set(lib.glob(".contact_law.*")) - {mine.parent}  # the second has removed the first's
    inside = next(left.rglob("*.py")).with_name("mine.py")
    inside.write_text("mine")
    done = installation(again, tmp_path)
    assert done.returncode == 0 if again == "install" else "no installation there" in done.stderr
    kept = [path for folder in lib.glob(".contact_law.*") for path in folder.rglob("*")]
    assert set(kept) == {mine, inside, *(path for path in inside.parents if left in path.parents)}
    assert mine.read_text() == inside.read_text() == "mine"
    assert (lib / "contact_law/installed.json").exists() == (again == "install")


def test_an_installation_waits_for_another_one(tmp_path):
    """And doesn't take the other's half for one that was left."""
    stopped = signalled("copy2", 100, signal.SIGSTOP)
    command = [INSTALLER, "install", str(tmp_path)]
    first = subprocess.Popen([sys.executable, *stopped, *command], stdout=subprocess.DEVNULL)
    assert os.WIFSTOPPED(os.waitpid(first.pid, os.WUNTRACED)[1])
    second = subprocess.Popen([sys.executable, *command], stdout=subprocess.DEVNULL)
    wait_for(lambda: waits_for_a_lock(second.pid) or second.poll() is not None)
    first.send_signal(signal.SIGCONT)
    assert (first.wait(), second.wait()) == (0, 0)
    assert installation("uninstall", tmp_path).returncode == 0
    assert [path for path in tmp_path.rglob("*") if not path.is_dir()] == []


@pytest.mark.parametrize("function, calls", [("unlink", 30), ("rmdir", 3)])
def test_a_killed_removal_does_not_stand_in_the_way(tmp_path, function, calls):
    assert installation("install", tmp_path).returncode == 0
    killed("uninstall", tmp_path, function, calls)
    assert installation("install", tmp_path).returncode == 0
    killed("uninstall", tmp_path, function, calls)
    done = installation("uninstall", tmp_path)
    assert done.returncode == 0 or "no installation there" in done.stderr
    assert not list(tmp_path.rglob("contact_law*"))


def test_a_full_disk_is_told_in_a_line_and_leaves_nothing(tmp_path):
    with small_disk(tmp_path / "disk", "9m") as disk:
        refused(installation("install", disk), "No space left on device")
        assert [path for path in disk.rglob("*") if not path.is_dir()] == []


@pytest.mark.parametrize("listed", ['["{mine}"]', "no list", "{{}}"], ids=["of version 0.3", "no JSON", "no list"])
@pytest.mark.parametrize("action", ["install", "uninstall"])
def test_an_installation_without_its_list_is_left_as_it_is(tmp_path, listed, action):
    prefix, mine = tmp_path / "prefix", tmp_path / "mine"
    (prefix / "lib/contact_law").mkdir(parents=True)
    for file in (mine, prefix / "lib/contact_law/mine"):
        file.write_text("mine")
    (prefix / "lib/contact_law/installed.json").write_text(listed.format(mine=mine))
    refused(installation(action, prefix), "must be moved away")
    assert mine.exists() and sorted(os.listdir(prefix / "lib/contact_law")) == ["installed.json", "mine"]


@pytest.mark.parametrize("name", ["bin/dust-study", "lib/python3/site-packages/contact_law.pth"])
def test_what_is_in_the_way_is_kept(tmp_path, name):
    name = name.replace("python3", f"python3.{sys.version_info.minor}")
    (tmp_path / name).parent.mkdir(parents=True)
    (tmp_path / name).write_text("another program")
    refused(installation("install", tmp_path), f"{name}: exists and is not part of an installation")
    assert [path for path in tmp_path.rglob("*") if path.is_file()] == [tmp_path / name]
    assert (tmp_path / name).read_text() == "another program"


def test_a_prefix_that_cannot_be_is_refused_before_anything_is_written(tmp_path, monkeypatch):
    """An empty one, another user's home that is not known, and one whose lib/ is a link out of it."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "prefix").mkdir()
    (tmp_path / "prefix/lib").symlink_to(tmp_path)
    for prefix in ("", "~nobody-of-this-name/x", tmp_path / "prefix"):
        refused(installation("install", prefix), "must be")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["prefix"]


def test_all_users_can_read_an_installation(tmp_path):
    before = os.umask(0o077)
    try:
        assert installation("install", tmp_path / "prefix").returncode == 0
    finally:
        os.umask(before)
    installed = [file for file in (tmp_path / "prefix/lib/contact_law").rglob("*") if not file.is_symlink()]
    assert all(file.stat().st_mode & 0o044 == 0o044 for file in installed)


def test_a_folder_that_no_python_searches_is_named(tmp_path):
    done = installation("install", tmp_path, "/nowhere")
    assert done.returncode == 0
    assert f"PYTHONPATH={tmp_path}/lib/contact_law" in done.stdout
