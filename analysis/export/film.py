"""A film of a run: a frame for each saved state, seen along -z, grains coloured by aggregate; encoded by ffmpeg."""

import os
import subprocess
import tempfile

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from ..figures.sphere_raster import paint_spheres
from ..figures.style import AGGREGATE_COLOURS, NANO
from ..progress import progress
from ..runs.write import replacing, require_file

FRAMES_PER_SECOND = 10
WIDTH = 960  # pixels
_TALLEST = 1080  # pixels
_MARGIN = 2.0  # grain radii
_LARGEST_VIEW = 2.0  # sizes of the view at the start: what flies farther leaves it


class NoFilm(Exception):
    """The film could not be encoded; the message is one line."""


def write_film(run, file, frames_per_second=FRAMES_PER_SECOND, width=WIDTH):
    """Write the states of a RunFolder as a film (H.264 in the container that the file's ending names), `width` pixels
    wide. The file appears when it is complete. Grains of a periodic cell are drawn within it.

    NoFilm when ffmpeg is missing or fails, RunFolderError when a state is damaged or there is none."""
    require_file(file)  # before the frames are drawn
    view = _view(run)
    pixel = max((view[1] - view[0]) / width, (view[3] - view[2]) / _TALLEST)
    frames = (_frame(state, view, pixel) for state in progress(run.states, "drawing frames"))
    with replacing(file, ending=file.suffix) as part:
        _encode(frames, os.path.abspath(part.name), frames_per_second)
    return file


def _drawn(state):
    """Positions (N, 3) [m]: in a periodic cell the images inside it."""
    return state.position if state.cell_size is None else state.position % state.cell_size


def _view(run):
    """(x0, x1, y0, y1) [m] that holds the grains of all states but those that fly far off."""
    first, margin = run.start, _MARGIN * run.start.radius.max()
    states = progress(run.states, "finding the view")
    if first.cell_size is not None:
        edges = np.max([state.cell_size for state in states], axis=0)
        return -margin, edges[0] + margin, -margin, edges[1] + margin
    low, high = first.position[:, :2].min(axis=0) - margin, first.position[:, :2].max(axis=0) + margin
    middle, half = (low + high) / 2, (high - low) / 2
    reach = np.max([np.abs(state.position[:, :2] - middle).max(axis=0) for state in states], axis=0) + margin
    half = np.minimum(reach, _LARGEST_VIEW * half.max())
    return middle[0] - half[0], middle[0] + half[0], middle[1] - half[1], middle[1] + half[1]


def _frame(state, view, pixel):
    """RGB bytes (H, W, 3) of a state, H and W even, as the encoder wants them."""
    colours = np.array(AGGREGATE_COLOURS)[state.aggregate % len(AGGREGATE_COLOURS)]
    position = _drawn(state)
    fading = max(4.0, np.ptp(position[:, 2]) / state.radius.max())  # from front to back
    image = paint_spheres(position, state.radius, colours, view, pixel, fading=fading)[::-1]
    image = np.pad(image, [(0, image.shape[0] % 2), (0, image.shape[1] % 2), (0, 0)], mode="edge")
    picture = Image.fromarray(np.round(255 * image).astype(np.uint8))
    text = f"t = {state.time * NANO:.1f} ns"
    ImageDraw.Draw(picture).text((12, 10), text, fill=(60, 60, 60), font=_font())
    return np.asarray(picture)


def _font():
    """matplotlib's own, so that it is there wherever this is."""
    import matplotlib

    return ImageFont.truetype(os.path.join(matplotlib.get_data_path(), "fonts/ttf/DejaVuSans.ttf"), 20)


def _encode(frames, file, frames_per_second):
    """Through ffmpeg's input; NoFilm with its last line when it fails."""
    first = next(frames)
    size = f"{first.shape[1]}x{first.shape[0]}"
    command = ["ffmpeg", "-v", "error", "-y", "-f", "rawvideo", "-pix_fmt", "rgb24", "-s", size]
    command += ["-r", str(frames_per_second), "-i", "-", "-c:v", "libx264", "-pix_fmt", "yuv420p", "-crf", "18", file]
    with tempfile.TemporaryFile() as messages:
        try:
            encoder = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=messages)
        except FileNotFoundError:
            raise NoFilm("ffmpeg: not installed; must be there to write a film (apt-get install ffmpeg)") from None
        try:
            encoder.stdin.write(first.tobytes())
            for frame in frames:
                encoder.stdin.write(frame.tobytes())
        except BrokenPipeError:
            pass  # it says why below
        except BaseException:
            encoder.kill()
            raise
        finally:
            encoder.communicate()
        messages.seek(0)
        lines = messages.read().decode(errors="replace").strip().splitlines()
    if encoder.returncode:
        raise NoFilm(f"ffmpeg: {lines[-1] if lines else f'exit status {encoder.returncode}'}")
