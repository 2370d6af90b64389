"""A film of a run: a frame for each saved state, viewed along an axis, with a scale bar; encoded by ffmpeg."""

import os
import shutil
import subprocess
import tempfile
from functools import cache
from itertools import chain

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from ..figures.grain_colours import COLOURINGS, Range, on_scale
from ..figures.sphere_raster import paint_spheres
from ..figures.style import NANO
from ..printable import Refused
from ..progress import progress
from ..runs.files import replacing, require_output
from ..runs.folder import shown
from ..runs.format import value_text
from .fields import exported_states

ENDINGS = ".mp4", ".gif", ".mkv", ".mov"
AXES = {"x": (1, 2, 0), "y": (0, 2, 1), "z": (0, 1, 2)}  # to the right, up, towards the viewer (but y: away)
_NARROWEST = 480  # pixels, for the legend
_TALLEST = 9 / 8  # over the width
_MARGIN = 2.0  # grain radii
_H264 = ["-c:v", "libx264", "-pix_fmt", "yuv420p", "-crf", "18"]
_GIF = ["-vf", "split[a][b];[a]palettegen=64[p];[b][p]paletteuse=dither=none", "-loop", "0"]
_INK = (60, 60, 60)
_LARGEST_VIEW = 2.0  # sizes of the view at the start: what flies farther leaves it


def write_film(run, file, frames_per_second=10, width=960, along="z", colour="aggregate"):
    """Write the states of a RunFolder as a film, viewed from far along an axis; the file appears when it is complete.

    file : Path with one of ENDINGS, H.264 in that container, or a .gif that repeats. width : pixels; less where the
    film would be more than 9/8 as high. along : one of AXES; grains of a periodic cell are drawn within it. colour :
    one of grain_colours.COLOURINGS. Refused if ffmpeg is missing or fails, RunFolderError without a whole state."""
    if file.suffix not in ENDINGS:  # before the frames are drawn
        raise Refused(f"{file}: must end in {' or '.join(ENDINGS)}")
    require_output(file)
    axes = list(AXES[along])
    view = _view(run, axes)
    pixel = max((view[1] - view[0]) / width, (view[3] - view[2]) / (_TALLEST * width))
    more = max(0.0, min(width, _NARROWEST) * pixel - (view[1] - view[0])) / 2
    view = (view[0] - more, view[1] + more, *view[2:])
    of, way = Range(run), COLOURINGS[colour]
    frames = (
        _frame(exported, axes, way.colours(exported, of), way.legend(of), view, pixel, _grains(run))
        for exported in progress(exported_states(run), "drawing frames", len(run.states))
    )
    with replacing(file, ending=file.suffix) as part:
        _encode(frames, os.path.abspath(part.name), frames_per_second)
    return file


def _view(run, axes):
    """(x0, x1, y0, y1) [m] that holds the grains of all states but those that fly far off."""
    first, margin = run.start, _MARGIN * run.start.radius.max()
    states = progress(run.states, "finding the view")
    if first.cell_size is not None:
        edges = np.max([state.cell_size for state in states], axis=0)[axes]
        return -margin, edges[0] + margin, -margin, edges[1] + margin
    plane = axes[:2]
    low, high = first.position[:, plane].min(axis=0) - margin, first.position[:, plane].max(axis=0) + margin
    middle, half = (low + high) / 2, (high - low) / 2
    reach = np.max([np.abs(state.position[:, plane] - middle).max(axis=0) for state in states], axis=0) + margin
    half = np.minimum(reach, _LARGEST_VIEW * half.max())
    return middle[0] - half[0], middle[0] + half[0], middle[1] - half[1], middle[1] + half[1]


def _grains(run):
    """'ice, γ = 0.1 J/m²' of what a run's parameters say of its grains."""
    material, energy = str(run.parameters.get("material", "")), shown(run.parameters, run.derived, "surfaceEnergy")
    return material if energy is None else f"{material}, γ = {value_text(energy)} J/m²"


def _frame(exported, axes, colours, legend, view, pixel, grains):
    """RGB bytes (H, W, 3) of a state, H and W even, as the encoder wants them."""
    state = exported.state
    position = exported.inside()[:, axes] * (1, 1, -1 if axes[2] == 1 else 1)  # to the right, up, towards the viewer
    fading = max(4.0, np.ptp(position[:, 2]) / state.radius.max())  # from front to back
    image = paint_spheres(position, state.radius, colours, view, pixel, fading=fading)[::-1]
    image = np.pad(image, [(0, image.shape[0] % 2), (0, image.shape[1] % 2), (0, 0)], mode="edge")
    picture = Image.fromarray(np.round(255 * image).astype(np.uint8))
    canvas = ImageDraw.Draw(picture)
    canvas.text((12, 10), f"t = {state.time * NANO:.1f} ns", fill=_INK, font=_font())
    canvas.text((12, 36), grains, fill=_INK, font=_font(16))
    _draw_legend(canvas, legend, 12, picture.height - 28)
    _draw_length(canvas, pixel, picture.width - 12, 16)
    return np.asarray(picture)


def _draw_legend(canvas, legend, x, y):
    """Patches or a scale in a row, from (x, y) [pixels] on."""
    for entry in legend:
        if "colour" in entry:
            canvas.ellipse((x, y + 4, x + 12, y + 16), fill=_rgb(entry["colour"]))
            x = _write(canvas, entry["text"], x + 18, y)
        else:
            x = _write(canvas, entry["low"], x, y) - 8
            for k, colour in enumerate(on_scale(np.linspace(0, 1, 120))):
                canvas.line((x + k, y + 4, x + k, y + 16), fill=_rgb(colour))
            x = _write(canvas, entry["high"], x + 128, y)


def _write(canvas, text, x, y):
    canvas.text((x, y), text, fill=_INK, font=_font(16))
    return x + int(canvas.textlength(text, font=_font(16))) + 16


def _draw_length(canvas, pixel, right, y):
    """A bar of a round length, up to a sixth of the width."""
    most = canvas.im.size[0] / 6 * pixel
    power = 10.0 ** np.floor(np.log10(most))
    length = power * next(digit for digit in (5, 2, 1) if digit * power <= most)
    text = f"{length * 1e9:.0f} nm" if length < 0.999e-6 else f"{length * 1e6:.0f} µm"
    left = right - length / pixel
    canvas.line((left, y + 24, right, y + 24), fill=_INK, width=3)
    canvas.text(((left + right) / 2 - canvas.textlength(text, font=_font(16)) / 2, y), text, fill=_INK, font=_font(16))


def _rgb(colour):
    return tuple(round(255 * value) for value in colour)


@cache
def _font(size=20):
    """matplotlib's own, so that it is there wherever this is."""
    import matplotlib

    return ImageFont.truetype(os.path.join(matplotlib.get_data_path(), "fonts/ttf/DejaVuSans.ttf"), size)


def _encode(frames, file, frames_per_second):
    """Through ffmpeg; Refused with its last line when it complains: on a full disk its status may be 0."""
    if not shutil.which("ffmpeg"):
        raise Refused("ffmpeg: not installed; must be there to write a film (apt-get install ffmpeg)")
    first = next(frames)
    size = f"{first.shape[1]}x{first.shape[0]}"
    command = ["ffmpeg", "-v", "error", "-y", "-f", "rawvideo", "-pix_fmt", "rgb24", "-s", size]
    command += ["-r", str(frames_per_second), "-i", "-", *(_GIF if file.endswith(".gif") else _H264), file]
    with tempfile.TemporaryFile() as messages:
        encoder = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=messages)
        try:
            for frame in chain([first], frames):
                encoder.stdin.write(frame.tobytes())
        except BrokenPipeError:
            pass  # its last line is raised below
        except BaseException:
            encoder.kill()
            raise
        finally:
            encoder.communicate()
        messages.seek(0)
        lines = messages.read().decode(errors="replace").strip().splitlines()
    if encoder.returncode or lines:
        raise Refused(f"ffmpeg: {lines[-1] if lines else f'exit status {encoder.returncode}'}")
