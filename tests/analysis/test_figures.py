"""What figures and films show, read back from their artists and pixels; curves of a table of runs."""

import json
import shutil
import subprocess

import numpy as np
import pandas
import pytest
from matplotlib.colors import to_rgb
from written_runs import RADIUS, facing, losing, record, write_run

from analysis.__main__ import main
from analysis.figures.energy import energy_figure
from analysis.figures.grain_colours import AGGREGATE_COLOURS
from analysis.runs.folder import open_run
from analysis.runs.format import COLOURS
from analysis.runs.ledger import fractions
from analysis.studies.plot import plot


@pytest.fixture(scope="module")
def run(cluster_folder):
    return open_run(cluster_folder)


def test_energy_areas_are_the_fractions(run):
    upper, lower = energy_figure(run).axes
    parts = fractions(run.history)
    drawn = {name: 0.0 for name in parts}
    colours = {to_rgb(colour): name for name, colour in COLOURS.items()}
    time = run.history["time"] * 1e9
    for area in upper.collections:
        x, y = area.get_paths()[0].vertices.T
        name = colours[tuple(area.get_facecolor()[0][:3])]
        middle = np.searchsorted(time, 0.5 * time[-1])
        edges = np.unique(np.round(y[np.isclose(x, time[middle])], 12))
        drawn[name] += (edges.max() - edges.min()) if len(edges) else 0.0
    for name in parts:
        assert drawn[name] == pytest.approx(abs(parts[name][middle]), abs=1e-9)
    assert upper.lines[0].get_ydata() == pytest.approx(sum(parts.values()))


# ---- figures of a table of runs ----


@pytest.fixture
def runs():
    """A table of eight runs at two velocities, in the form of analysis.table."""
    ends = {1.0: ("sticking", "sticking", "bouncing", "undecided"), 3.0: ("fragmentation",) * 3 + ("sticking",)}
    cells = [(velocity, seed, outcome) for velocity, own in ends.items() for seed, outcome in enumerate(own)]
    found = pandas.DataFrame(cells, columns=["velocity", "seed", "outcome"])
    found = found.assign(run="", kind="collision", impact=0.5, ended=True)
    found = found.assign(largest_fraction=[0.9, 0.7, 0.5, 0.3, 0.4, 0.2, 0.2, 0.0])
    found.attrs.update(units={"velocity": "m/s", "largest_fraction": "1"}, parameters=["velocity", "seed", "impact"])
    return found


def drawn(figure):
    """([(x, y)], [(low, high)]) of the first curve, and all that is written."""
    (axes,) = figure.axes
    bars = axes.collections[0].get_segments()
    texts = [figure._suptitle.get_text(), axes.get_title(), axes.get_xlabel(), axes.get_ylabel()]
    text = " | ".join(texts).replace("\n", " ")
    return list(zip(*axes.lines[0].get_data())), [tuple(bar[:, 1]) for bar in bars], text


def test_undecided_runs_are_left_out_of_fractions_and_counted(runs):
    points, bars, text = drawn(plot("sticking", runs))
    assert points == [(1.0, pytest.approx(3 / 5)), (3.0, pytest.approx(2 / 6))]
    assert 0.5 * (bars[0][1] - bars[0][0]) == pytest.approx((0.6 * 0.4 / 3) ** 0.5)
    assert "runs: 7, pairs: 4, left out: 1" in text and "[m/s]" in text


def test_a_mean_has_the_standard_error_of_its_pairs(runs):
    points, bars, _ = drawn(plot("largest", runs))
    assert points == [(1.0, pytest.approx(0.6, rel=1e-12)), (3.0, pytest.approx(0.2, rel=1e-12))]
    assert 0.5 * (bars[0][1] - bars[0][0]) == pytest.approx(runs.largest_fraction[:4].std() / 2, rel=1e-12)


def test_averages_over_a_column_and_in_bins_are_of_pairs(runs):
    """Runs of a pair at several offsets count by their mean; a bin is drawn at the mean of its x."""
    spread = runs.assign(impact=np.linspace(0, 0.7, 8), seed=[0, 0, 1, 1, 0, 0, 1, 1])
    points, bars, _ = drawn(plot("largest", spread, over="impact"))
    assert points == [(1.0, pytest.approx(0.6)), (3.0, pytest.approx(0.2))]
    assert 0.5 * (bars[0][1] - bars[0][0]) == pytest.approx(0.2)  # of the means 0.8 and 0.4
    points, _, _ = drawn(
        plot("largest", runs.assign(impact=np.arange(8) / 8, seed=range(8)), "impact", bins=2, over="velocity")
    )
    assert points == [(pytest.approx(0.1875), pytest.approx(0.6)), (pytest.approx(0.6875), pytest.approx(0.2))]


def test_what_cannot_be_drawn_is_refused_in_one_line(runs):
    for how, words in (
        ({"what": "stiking"}, "did you mean sticking"),
        ({"where": {"velocity": 1000}}, "no run is left"),
        ({"runs": runs.assign(impact=[0.0] + [0.5] * 7)}, "the runs differ in impact too"),
    ):
        with pytest.raises(ValueError, match=f"^[^\n]*{words}[^\n]*$"):
            plot(**{"what": "sticking", "runs": runs, **how})


def test_the_command_writes_a_picture_and_prints_its_path_last(cluster_folder, tmp_path, capsys):
    file = tmp_path / "new" / "a.png"
    assert main(["plot", "energy", str(cluster_folder), "--where", "velocity=1", "--out", str(file)]) == 0
    assert capsys.readouterr().out.splitlines()[-1] == str(file) and file.read_bytes().startswith(b"\x89PNG")


# ---- films ----


needs_ffmpeg = pytest.mark.skipif(not shutil.which("ffmpeg"), reason="ffmpeg is not installed")


@pytest.fixture
def approaching(tmp_path):
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
def test_every_state_is_a_frame_with_the_grains_in_their_places(approaching):
    assert main(["film", str(approaching)]) == 0
    frames = _frames(approaching / "film.mp4")
    assert len(frames) == 4
    width = 2 * 10 * RADIUS  # 8 radii, and a margin of two
    for number, frame in enumerate(frames):
        x = (8 - 2 * number) * RADIUS
        assert _places(frame, AGGREGATE_COLOURS[0]) == pytest.approx(0.5 - x / width, abs=0.01)
        assert _places(frame, AGGREGATE_COLOURS[1]) == pytest.approx(0.5 + x / width, abs=0.01)


def test_a_film_that_cannot_be_encoded_is_one_line_and_leaves_no_file(approaching, capsys, monkeypatch):
    monkeypatch.setenv("PATH", "/nowhere")
    assert main(["film", str(approaching)]) == 2
    message = capsys.readouterr().err
    assert "ffmpeg: not installed" in message and message.count("\n") == 1 and not list(approaching.glob("*film*"))
