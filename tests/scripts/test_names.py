"""Names from outside are names: no shell, no expression and no terminal takes them for anything else."""

import os
import shlex
import subprocess

import pytest
from running import COLLIDE, PYTHON, TINY, TOP, call, study

from analysis.printable import printable, shell_line

NAME = "x;touch PWNED;y $n & `touch PWNED` $(touch PWNED) 50%s @ 'it' \"q\" <a>b \u00fc #h \\n -n "
NAME += "l" * (200 - len(NAME))
RED = "\x1b[31m"
TABLE = "description radius velocity duration states\na 4 30 1e-9 2\n"


def run_analysis(folder, *arguments):
    return call(folder, PYTHON, "-m", "analysis", *arguments, PYTHONPATH=TOP)


def test_a_table_a_run_and_the_suite_may_have_any_name(tmp_path):
    """They run to their ends, and the analysis reads them, behind a name that a shell would execute."""
    folder = tmp_path / "names" / NAME
    folder.mkdir(parents=True)
    (folder / f"{NAME}.table").write_text(TABLE)
    suite = NAME[:100]
    os.symlink(TOP, folder / suite)
    done = call(folder, PYTHON, f"{suite}/yade_scripts/study.py", f"{NAME}.table", "-j", "1")
    assert (done.returncode, done.stderr) == (0, ""), done.stdout + done.stderr
    assert os.listdir(folder / "runs/logs") == [NAME] and (folder / "runs/a/ended").exists()
    done = call(folder, "yade", "-n", "-x", f"{suite}/yade_scripts/collide.py", *TINY, "states=2", f"out={NAME}")
    assert done.returncode == 0, done.stderr
    done = run_analysis(folder, "film", NAME, "--out", f"{NAME}.mp4")
    assert done.returncode == 0 and done.stderr == ""
    assert [path for path in folder.parent.rglob("PWNED*")] == []


def test_threads_of_yade_batch_are_obeyed_or_refused(tmp_path):
    for rows, words in {
        "!THREADS threads\n2 1\n": "!THREADS = 2: threads are 1; must be the same",
        "!OMP_NUM_THREADS radius\nos.nice(1) 4\n": "!OMP_NUM_THREADS = os.nice(1): not a finite number; must be >= 1",
    }.items():
        (tmp_path / "rows.table").write_text(rows)
        assert words in study(tmp_path, "rows.table", "--status").stdout


def test_a_table_of_ours_is_run_by_yade_batch(tmp_path):
    """As users call it, who choose its names themselves."""
    (tmp_path / "rows.table").write_text("radius! velocity material duration seed!\n4 10 'ice' 5e-10 1\n= = ice = 2\n")
    options = ("--disable-pynotify", "--log", "@.log", "-j", "1", "-l", "2")
    done = call(tmp_path, "yade-batch", *options, "rows.table", COLLIDE)
    assert done.returncode == 0 and os.listdir(tmp_path / "runs") == ["radius=4,seed=1"], done.stdout


def test_no_escape_sequence_reaches_the_terminal(tmp_path):
    name = f"a{RED}b"
    (tmp_path / f"{name}.table").write_text(f"description radius {RED}\n{name} -1 2\n")
    for done in (study(tmp_path, f"{name}.table", "--status"), run_analysis(tmp_path, "status", name)):
        assert "\x1b" not in done.stdout + done.stderr and "\\x1b[31m" in done.stdout + done.stderr, done


@pytest.mark.parametrize("word", [NAME, f"a{RED}b", "\udcff"], ids=range(3))
def test_text_is_printable_and_commands_can_be_pasted(word):
    assert printable(word).isprintable()
    line = shell_line(["printf", "%s", word])
    assert line.isprintable() and (not word.isprintable() or shlex.split(line)[2] == word)
    done = subprocess.run(["bash", "-c", line], capture_output=True, env={"LC_ALL": "C.UTF-8", "PATH": "/usr/bin:/bin"})
    assert done.stdout == os.fsencode(word)


def test_a_prefix_is_a_name_for_make_and_the_shell(tmp_path):
    prefix = str(tmp_path / NAME)
    done = call(tmp_path, "make", "-s", "-f", f"{TOP}/Makefile", "-C", TOP, "uninstall", f"PREFIX={prefix}")
    assert done.stderr.splitlines()[0] == f"make uninstall: {prefix}/lib/contact_law: no installation there"
    assert os.listdir(tmp_path) == [] and not os.path.exists(f"{TOP}/PWNED")
