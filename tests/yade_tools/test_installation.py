"""make install into a folder of its own: everything works from any folder, without the checkout; make uninstall."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

TOP = Path(__file__).resolve().parents[2]
INSTALLER = str(TOP / "contact_law/installation.py")
COMMANDS = ("dust-analysis", "dust-collide", "dust-compress", "dust-packing", "dust-study")


def installation(action, prefix, base=None):
    """An installation or removal that ended."""
    environment = {**os.environ, "PYTHONUSERBASE": str(base or prefix)}
    command = [sys.executable, INSTALLER, action, str(prefix)]
    return subprocess.run(command, capture_output=True, text=True, env=environment)


def files_in(folder):
    return {path for path in folder.rglob("*") if path.is_file() or path.is_symlink()}


@pytest.fixture(scope="module")
def installed(tmp_path_factory):
    """(prefix, call): call(command, ...) runs in an empty folder with nothing but the installation to be found."""
    prefix, elsewhere = tmp_path_factory.mktemp("prefix with a space"), tmp_path_factory.mktemp("elsewhere")
    done = installation("install", prefix)
    assert done.returncode == 0, done.stderr
    paths = {"PATH": f"{prefix}/bin:/usr/bin:/bin", "HOME": str(elsewhere), "PYTHONUSERBASE": str(prefix)}
    how = dict(cwd=elsewhere, env={**paths, "LC_ALL": "C.UTF-8"}, capture_output=True, text=True, timeout=300)
    return prefix, lambda *command: subprocess.run(command, **how)


def test_a_script_of_any_folder_imports_the_contact_law(installed, tmp_path):
    """From the user's site, and where plain YADE finds it in the overlay."""
    prefix, call = installed
    script = tmp_path / "script.py"
    script.write_text("import contact_law\nprint('found', contact_law.LIBRARY, JKRMat().young, contact_law.commit)\n")
    overlay = (f"YADE_PREFIX={prefix}/lib/contact_law/build", "PYTHONUSERBASE=/nowhere")
    for environment in ((), overlay):
        done = call("env", *environment, "yade", "-n", "-x", str(script))
        assert done.returncode == 0, done.stderr
        assert f"found {prefix}/lib/contact_law/build/lib" in done.stdout


def test_any_python_imports_the_analysis_and_all_commands_have_one_version_and_commit(installed):
    prefix, call = installed
    ask = "import analysis; print(analysis.__file__, analysis.__version__, analysis.commit)"
    file, version, commit = call("/usr/bin/python3", "-c", ask).stdout.rsplit(maxsplit=2)
    assert file == f"{prefix}/lib/contact_law/analysis/__init__.py"
    assert version == (TOP / "analysis/VERSION").read_text().strip() and commit
    versions = set()
    for command in COMMANDS:
        done = call(command, "--version")
        assert done.returncode == 0, done.stderr
        versions |= {line.split(" ", 1)[1] for line in done.stdout.splitlines() if ", commit " in line}
    assert len(versions) == 1


def test_a_collision_and_its_summary_without_a_link_to_the_checkout(installed, tmp_path):
    prefix, call = installed
    places = {Path(os.path.realpath(path)) for path in prefix.rglob("*") if path.is_symlink()}
    assert prefix / "lib/contact_law/contact_law" in places
    assert not any(place.is_relative_to(TOP) for place in places)
    run = tmp_path / "run"
    done = call("dust-collide", *"grains=30 packing=bpca velocity=20 duration=2e-9".split(), f"out={run}")
    assert done.returncode == 0, done.stdout + done.stderr
    done = call("dust-analysis", "summary", str(run))
    assert done.returncode == 0 and "outcome" in done.stdout


def test_installing_again_and_removing_leave_only_the_files_of_others(tmp_path):
    prefix = tmp_path / "prefix"
    other, mine = prefix / "bin/other", prefix / "lib/contact_law/yade_scripts/studies/mine.table"
    other.parent.mkdir(parents=True)
    other.write_text("another program")
    assert installation("install", prefix).returncode == 0
    mine.write_text("mine")
    assert installation("install", prefix).returncode == 0
    assert files_in(prefix) >= {other, mine, *(prefix / "bin" / name for name in COMMANDS)}
    assert installation("uninstall", prefix).returncode == 0
    assert files_in(prefix) == {other, mine}


def test_what_is_in_the_way_is_kept(tmp_path):
    file = tmp_path / "bin" / "dust-study"
    file.parent.mkdir()
    file.write_text("mine")
    done = installation("install", tmp_path)
    assert done.returncode == 2 and done.stderr.count("\n") == 1 and "must be moved away" in done.stderr
    assert files_in(tmp_path) == {file}


def test_a_yade_that_was_not_tried_is_compiled_against_its_own_source(tmp_path):
    """Or refused in one line, where no archive has it."""
    done = subprocess.run(["make", "-n", "YADE_VERSION=2027.1.0"], cwd=TOP, capture_output=True, text=True)
    assert "-isystem build/yade-source/2027.1.0" in done.stdout and "layouts.cpp" not in done.stdout
    assert "2027.1.0 has not been tried by us" in done.stdout.splitlines()[-1]
    fetch = [sys.executable, f"{TOP}/contact_law/yade_interface/source.py", tmp_path / "source"]
    done = subprocess.run(fetch, capture_output=True, text=True, env={"PATH": ""})
    assert done.returncode == 2 and done.stderr.count("\n") == 1 and "can't be had" in done.stderr
