"""A run does not depend on the shell that it is started from: another Python's environment, bound threads, a terminal
that can't write a name, a reader that has gone."""

import sys

import pytest
from running import COLLIDE, PYTHON, TINY, TOP, call

from yade_scripts.runner.rows import failure, summary

SWEEP = "from yade_scripts import collide\ncollide(velocity=30, radius=4, duration=1e-9, threads=2, folder='my runs')"

PAIR = """
import contact_law
from yade import *

ice = O.materials.append(JKRMat(young=7e9, poisson=0.25, density=1000, surfaceEnergy=0.1, criticalRolling=0.8e-9))
O.bodies.append([utils.sphere((x, 0, 0), 1e-7, material=ice) for x in (0, 3e-7)])
O.engines, O.dt = [JKRWadaEngine(subSteps=2)], 1e-11
O.step()
print("threads", O.engines[0].statistics()["threads"])
"""


@pytest.fixture
def foreign(tmp_path):
    """Variables of a shell in which a virtual environment of other libraries is active, and threads are bound."""
    version = "python{}.{}".format(*sys.version_info)
    library = tmp_path / "environment/lib" / version / "site-packages/scipy"
    library.mkdir(parents=True)
    (library / "__init__.py").write_text("raise ImportError('of another numpy')")
    return dict(VIRTUAL_ENV=str(tmp_path / "environment"), OMP_PROC_BIND="true")


def test_a_run_sees_no_virtual_environment_and_all_cores(tmp_path, foreign):
    done = call(tmp_path, "yade", "-n", "-x", COLLIDE, *TINY, "threads=2", "out=run", **foreign)
    assert done.returncode == 0 and (tmp_path / "run/ended").exists(), done.stderr
    done = call(tmp_path, PYTHON, "-c", SWEEP, PYTHONPATH=TOP, **foreign)
    assert done.returncode == 0 and list(tmp_path.glob("my runs/*/ended")), done.stderr


def test_a_python_without_the_libraries_is_told_in_one_line(tmp_path):
    ask = "import analysis.startup as s; s.NEEDED += ('no_such',); from yade_scripts import collide"
    done = call(tmp_path, PYTHON, "-c", ask, PYTHONPATH=TOP)
    assert done.stderr.splitlines()[-1].startswith(f"ImportError: {PYTHON} has no no_such: must be a Python that has")


def test_a_name_that_the_terminal_cannot_write_and_a_reader_that_has_gone(tmp_path):
    done = call(tmp_path, "yade", "-n", "-x", COLLIDE, *TINY, "out=r\u00fcn", PYTHONIOENCODING="ascii")
    assert done.returncode == 0 and "run folder: r\\xfcn (completed" in done.stdout, done.stderr
    done = call(tmp_path, "bash", "-c", f"yade -n -x {COLLIDE} --help | head -5; exit ${{PIPESTATUS[0]}}")
    assert done.returncode == 0 and "Traceback" not in done.stderr


def test_a_run_that_ends_by_an_exception_is_named_with_it_and_its_log(tmp_path):
    log = tmp_path / "a.log"
    log.write_text("Traceback (most recent call last):\n  ...\nModuleNotFoundError: No module named 'x'\n" + summary(1))
    assert failure(log, "runs/a") == f"runs/a: ModuleNotFoundError: No module named 'x' (all of it in {log})"


def test_the_engine_of_a_script_has_the_threads_that_yade_was_started_with(tmp_path):
    (tmp_path / "pair.py").write_text(f"import sys\nsys.path.insert(0, {TOP!r})\n{PAIR}")
    for options, threads in ((), 1), (("-j2",), 2):
        done = call(tmp_path, "yade", *options, "-n", "-x", "pair.py")
        assert f"threads {threads}\n" in done.stdout, done.stderr
