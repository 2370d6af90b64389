"""What the figures show, read back from their artists and pixels."""

from dataclasses import replace

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from PIL import Image

from analysis.figures.collision import force_kinds, forces_figure, grains_figure, motion_figure
from analysis.figures.energy import energy_figure
from analysis.figures.sphere_raster import paint_spheres
from analysis.figures.style import new_figure, save_small
from analysis.measures.compression import maximum_compression
from analysis.runs.folder import open_run
from analysis.runs.format import COLOURS
from analysis.runs.ledger import fractions


@pytest.fixture(scope="module")
def run(cluster_folder):
    return open_run(cluster_folder)


def test_motion_is_in_nanoseconds_grain_radii_and_metres_per_second(run):
    upper, lower = motion_figure(run).axes
    time, d = upper.lines[0].get_data()
    assert time == pytest.approx(run.history["time"] * 1e9) and d == pytest.approx(run.history["d"] / 1e-7)
    assert lower.lines[0].get_ydata() == pytest.approx(run.history["v"])
    maximum = maximum_compression(run.history["time"], run.history["d"], run.history["v"])
    assert upper.texts[0].get_text().startswith(f"$d_{{max}}$ = {maximum.length / 1e-7:.3f}")


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


def test_force_lines_are_the_contacts_of_the_slab(run):
    figure = forces_figure(run)
    panels = [axes for axes in figure.axes if axes.collections]
    assert 1 <= len(panels) <= 4
    for axes in panels:
        time = float(axes.get_title(loc="left").split("=")[1].split()[0]) * 1e-9
        state = run.states[run.states.nearest(time)]
        inside = np.all(np.abs(state.position[state.contact_pairs][:, :, 2]) <= 2e-7, axis=1)
        kinds = force_kinds(state.contact_normal_force[inside], run.derived["pullOffForce"])
        counts = [len(collection.get_segments()) for collection in axes.collections]
        assert counts == [kinds[k].sum() for k in ("other", "tension", "compression")]
        assert to_rgb(axes.get_facecolor()) == (0.0, 0.0, 0.0)


def test_grains_are_shown_at_start_maximum_and_end(run):
    titles = [axes.get_title(loc="left") for axes in grains_figure(run).axes]
    assert titles[0] == "$t$ = 0.0 ns" and titles[-1] == f"$t$ = {run.last.time * 1e9:.1f} ns" and 2 <= len(titles) <= 3


def test_fluffy_aggregates_are_shown_whole(run):
    """Of the same grains, cut at z = 0 and not: more of the picture is covered."""
    covered = []
    for filling, said in ((0.4, "behind"), (0.1, "all grains")):
        figure = grains_figure(replace(run, parameters={**run.parameters, "filling": filling}))
        assert said in figure._suptitle.get_text()
        covered.append((figure.axes[0].images[0].get_array() < 1).any(axis=2).sum())
    assert covered[1] > covered[0]


def test_painted_spheres():
    """The nearer one hides the farther; the area is that of a disc; what is smaller than a pixel is seen."""
    position, colour = np.array([[0.0, 0.0, 5.0], [0.0, 0.0, 0.0], [3.0, 0.0, 0.0]]), np.eye(3)
    image = paint_spheres(position, np.ones(3), colour, (-1.5, 4.5, -1.5, 1.5), 0.05)
    assert image.shape == (60, 120, 3)
    assert np.argmax(image[30, 30]) == 0 and np.argmax(image[30, 90]) == 2
    assert not np.any((image[..., 1] > 0) & (image[..., 0] == 0) & (image[..., 2] == 0))
    assert np.all(image[0, 0] == 1.0)
    image = paint_spheres(np.zeros((1, 3)), np.ones(1), np.array([[1.0, 0.0, 0.0]]), (-2.0, 2.0, -2.0, 2.0), 0.02)
    assert np.sum(image[..., 1] == 0.0) * 0.02**2 == pytest.approx(np.pi, rel=0.01)
    image = paint_spheres(np.zeros((1, 3)), np.full(1, 0.01), np.array([[1.0, 0.0, 0.0]]), (-2.0, 2.0, -2.0, 2.0), 0.5)
    assert np.any(image[..., 1] == 0.0)
    position = np.array([[0, 0, 0.0], [2, 0, -1e4], [1e99, 0, 0]])  # one ten thousand times larger, one far away
    image = paint_spheres(position, np.array([1, 1e4, 1]), np.eye(3), (-2.0, 2.0, -2.0, 2.0), 0.02)
    assert np.argmax(image[100, 100]) == 0 and np.argmax(image[100, 10]) == 1


def test_colours_of_what_is_drawn_are_kept_in_a_small_picture(tmp_path):
    """Blues that differ by a few parts in 255, on a background of thousands of shades."""
    figure = new_figure(4, 3)
    axes = figure.subplots()
    axes.imshow(np.random.default_rng(1).random((60, 60, 3)), extent=(0, 5, -1, 1), aspect="auto")
    blues = [(32, 100 + 3 * k, 172) for k in range(5)]
    for k, colour in enumerate(blues):
        axes.plot([k + 0.5], [0.0], "s", markersize=9, color=np.array(colour) / 255.0)
    save_small(figure, tmp_path / "small.png")
    with Image.open(tmp_path / "small.png") as picture:
        pixels = {colour for _, colour in picture.convert("RGB").getcolors(10**6)}
    assert set(blues) <= pixels and len(pixels) <= 256
