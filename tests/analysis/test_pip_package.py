"""What pip installs of the repository works by itself: the command and its data files."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

import analysis

TOP = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def call(tmp_path_factory):
    """call(*command) runs in an empty folder with the installed package beside this Python's libraries: what it
    prints."""
    target, elsewhere = tmp_path_factory.mktemp("pip"), tmp_path_factory.mktemp("elsewhere")
    pip = [sys.executable, "-m", "pip", "-q", "install", "--no-deps", f"--target={target}", str(TOP)]
    patience = {"PIP_RETRIES": "0", "PIP_DEFAULT_TIMEOUT": "15"}
    done = subprocess.run(pip, capture_output=True, text=True, env=os.environ | patience)
    if "No module named pip" in done.stderr or "No matching distribution found for hatchling" in done.stderr:
        pytest.skip("pip is missing, or has no network")
    assert done.returncode == 0, done.stderr
    environment = {"PATH": f"{target}/bin:/usr/bin:/bin", "PYTHONPATH": str(target), "HOME": str(elsewhere)}

    def call(*command):
        done = subprocess.run(command, cwd=elsewhere, env=environment, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        return done.stdout.replace(str(target), "TARGET")

    return call


def test_the_package_needs_no_checkout(call, cluster_folder):
    assert call(sys.executable, "-c", "import analysis; print(analysis.__file__)") == "TARGET/analysis/__init__.py\n"
    assert call("dust-analysis", "--version") == f"analysis {analysis.__version__}, commit unknown\n"
    assert "sticking" in call("dust-analysis", "summary", str(cluster_folder))
