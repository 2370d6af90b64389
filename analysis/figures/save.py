"""Figures as PNG and PDF files."""

import io

from PIL import Image  # what matplotlib itself writes PNGs with

DOTS_PER_INCH = 80  # a gallery of all of a study's figures stays below 1.5 MB
COLOURS = 128


def save_small(figure, file):
    """Save a matplotlib Figure as a PNG with a palette: few colours lose nothing that one sees, at a third of the
    size."""
    image = io.BytesIO()
    figure.savefig(image, dpi=DOTS_PER_INCH)
    Image.open(image).convert("RGB").quantize(COLOURS, dither=Image.Dither.NONE).save(file, optimize=True)


def save_vector(figure, file):
    """Save a matplotlib Figure as a PDF, the same bytes each time."""
    figure.savefig(file, format="pdf", metadata={"CreationDate": None})
