"""A PDF of an HTML page, by a program that is there."""

import os
import shutil
import subprocess
from pathlib import Path

from ..runs.files import replacing

LONGEST = 300  # s


class NoPdf(Exception):
    """No PDF could be written; the message is one line."""


def write_pdf(page, file):
    """Write a PDF (Path) of an HTML file (Path), by weasyprint or Chromium; it appears when it is complete. NoPdf when
    neither is there, or it fails."""
    command = next((make for name, make in _CONVERTERS if shutil.which(name)), None)
    if command is None:
        raise NoPdf(
            "not written: needs weasyprint or chromium (apt-get install weasyprint), or print the page in a browser"
        )
    with replacing(file, ending=".pdf") as part:
        words = command(str(page.resolve()), os.path.abspath(part.name))
        try:
            run = subprocess.run(words, capture_output=True, text=True, timeout=LONGEST, errors="replace")
        except subprocess.TimeoutExpired:
            raise NoPdf(f"not written: {words[0]} took more than {LONGEST} s") from None
        if not os.path.exists(part.name) or not os.path.getsize(part.name):
            said = (run.stderr.strip().splitlines() or [f"exit status {run.returncode}"])[-1]
            raise NoPdf(f"not written: {words[0]}: {said}")
    return file


def _weasyprint(page, file):
    return ["weasyprint", "-q", page, file]


def _chromium(name):
    def command(page, file):
        sandbox = ["--no-sandbox"] if os.geteuid() == 0 else []  # which it refuses to start for root
        options = ["--headless", "--disable-gpu", "--no-pdf-header-footer", f"--print-to-pdf={file}"]
        return [name, *sandbox, *options, Path(page).as_uri()]

    return command


_CONVERTERS = (
    ("weasyprint", _weasyprint),
    *((name, _chromium(name)) for name in ("chromium", "chromium-headless-shell", "google-chrome")),
)
