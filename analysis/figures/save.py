"""Figures as PNG and PDF files."""

import io

import numpy as np
from matplotlib.colors import to_rgba_array
from PIL import Image  # what matplotlib itself writes PNGs with

from ..runs.files import replacing

DOTS_PER_INCH = 80  # a gallery of all of a study's figures stays below 1.5 MB
COLOURS = 256
KEPT = 192  # of them: colours that stay as they are


def save_small(figure, file):
    """Save a matplotlib Figure as a PNG with a palette, at less than half the size. The colours of its lines, markers and areas
    stay what they are; only shades between them (edges of lines and letters) are merged."""
    image = io.BytesIO()
    figure.savefig(image, dpi=DOTS_PER_INCH)
    small = _with_palette(Image.open(image).convert("RGB"), _drawn_with(figure))
    with replacing(file) as out:
        small.save(out, format="png", optimize=True)


def _drawn_with(figure):
    """Set of the opaque colours (red, green, blue: 0 to 255) that artists of a figure have."""
    colours = set()
    for artist in figure.findobj():
        for name in ("get_color", "get_facecolor", "get_edgecolor", "get_markerfacecolor"):
            own = to_rgba_array(getattr(artist, name)()) if hasattr(artist, name) else np.empty((0, 4))
            colours.update(tuple(colour) for colour in np.rint(255 * own[own[:, 3] == 1.0, :3]).astype(int).tolist())
    return colours


def _with_palette(picture, wanted):
    """The picture with at most COLOURS colours: those of `wanted` that it has, its commonest, and the others merged by median
    cut."""
    counts = picture.getcolors(picture.width * picture.height)
    kept = [colour for _, colour in sorted(counts, key=lambda own: (own[1] in wanted, own), reverse=True)[:KEPT]]
    merged = picture.quantize(COLOURS - KEPT, dither=Image.Dither.NONE).convert("RGB")
    palette = kept + [colour for _, colour in merged.getcolors(COLOURS)]
    shades, places = np.unique(np.asarray(picture).reshape(-1, 3), axis=0, return_inverse=True)
    distance = np.abs(shades[:, None].astype(np.int16) - np.array(palette, dtype=np.int16)).sum(axis=2)
    small = Image.fromarray(
        distance.argmin(axis=1).astype(np.uint8)[places.reshape(picture.height, picture.width)], "P"
    )
    small.putpalette([value for colour in palette for value in colour])
    return small


def save_vector(figure, file):
    """Save a matplotlib Figure as a PDF, the same bytes each time."""
    with replacing(file) as out:
        figure.savefig(out, format="pdf", metadata={"CreationDate": None})
