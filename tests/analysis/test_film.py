"""A film of a run, read back frame by frame."""

import json
import shutil
import subprocess

import numpy as np
import pytest
from written_runs import RADIUS, facing, losing, record, write_run

from analysis.__main__ import main
from analysis.figures.grain_colours import AGGREGATE_COLOURS

needs_ffmpeg = pytest.mark.skipif(not shutil.which("ffmpeg"), reason="ffmpeg is not installed")


@pytest.fixture
def run(tmp_path):
    """Two grains, one of each aggregate, that draw near along x in four states."""
    time = np.arange(4) * 1e-9
    states = [facing(t, d, 0.0) for t, d in zip(time, (4 * np.arange(4) - 16) * RADIUS)]
    return write_run(tmp_path / "run", record(1e-6), losing(time), states)


def _frames(file):
    ask = ["ffprobe", "-v", "error", "-show_entries", "stream=width,height,nb_frames", "-of", "json", str(file)]
    stream = json.loads(subprocess.run(ask, capture_output=True, check=True).stdout)["streams"][0]
    read = ["ffmpeg", "-v", "error", "-i", str(file), "-f", "rawvideo", "-pix_fmt", "rgb24", "-"]
    data = subprocess.run(read, capture_output=True, check=True).stdout
    return np.frombuffer(data, dtype=np.uint8).reshape(-1, stream["height"], stream["width"], 3).astype(float) / 255


def _places(frame, colour):
    """Mean column, as a fraction of the width, of the pixels whose hue is the colour's."""
    colour = np.array(colour)
    frame = frame[:-40]  # without the legend
    same_hue = (frame @ colour) / np.linalg.norm(frame + 1e-9, axis=2) / np.linalg.norm(colour) > 0.985
    return np.argwhere(same_hue)[:, 1].mean() / frame.shape[1]


@needs_ffmpeg
def test_every_state_is_a_frame_with_the_grains_in_their_places(run):
    assert main(["film", str(run)]) == 0
    frames = _frames(run / "film.mp4")
    assert len(frames) == 4
    width = 2 * 10 * RADIUS  # 8 radii, and a margin of two
    for number, frame in enumerate(frames):
        x = (8 - 2 * number) * RADIUS
        assert _places(frame, AGGREGATE_COLOURS[0]) == pytest.approx(0.5 - x / width, abs=0.01)
        assert _places(frame, AGGREGATE_COLOURS[1]) == pytest.approx(0.5 + x / width, abs=0.01)


@pytest.mark.parametrize(
    "name, rate, words",
    [
        ("film.nonsense", 10, "film.nonsense: must end in .mp4 or .gif"),
        ("film.mp4", 60, "ffmpeg: not installed"),
        ("film.gif", 60, "60 frames a second; of a .gif must be 50 at most"),
    ],
)
def test_what_cannot_be_encoded_is_one_line_and_leaves_no_file(run, capsys, monkeypatch, name, rate, words):
    monkeypatch.setenv("PATH", "/nowhere")
    assert main(["film", str(run), "--rate", str(rate), "--out", str(run / name)]) == 2
    message = capsys.readouterr().err
    assert words in message and message.count("\n") == 1 and not list(run.glob("*film*"))
