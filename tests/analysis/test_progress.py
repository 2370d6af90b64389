"""Commands that take long show a bar with the time left on a terminal, and nothing elsewhere."""

import io
import shutil
import sys

import pytest
from made_collisions import made_run
from running import Terminal

from analysis.__main__ import main

COMMANDS = {
    "figures": ("drawing", ("figures",)),
    "vtk": ("writing states", ("export",)),
    "xyz": ("writing states", ("export", "--format", "xyz")),
    "film": ("drawing frames", ("film",)),
}


@pytest.mark.parametrize("name", COMMANDS)
def test_a_bar_is_drawn_on_a_terminal_alone(tmp_path, monkeypatch, capsys, name):
    if name == "film" and not shutil.which("ffmpeg"):
        pytest.skip("ffmpeg is not installed")
    what, (command, *options) = COMMANDS[name]
    made_run(tmp_path / "run", 40.0, 3.0, 1)
    for stream, shown in ((Terminal(), True), (io.StringIO(), False)):
        monkeypatch.setattr(sys, "stderr", stream)
        assert main([command, str(tmp_path / "run"), *options]) == 0
        drawn = stream.getvalue()
        whole = what in drawn and "%" in drawn and "<" in drawn and drawn.endswith("\r")  # nothing of it stays
        assert whole if shown else not drawn
        files = capsys.readouterr().out.splitlines()
        assert files and all(str(tmp_path) in line for line in files)
