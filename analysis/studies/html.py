"""The pages of a study as one HTML file that can be sent: figures, table of runs and data are inside it."""

import base64
import re
from pathlib import Path

from ..version import version_text

TEMPLATE = "page.html"
_TYPES = {".png": "image/png", ".csv": "text/csv", ".json": "application/json"}


def html_page(title, texts, folder, files, view=None):
    """The page (str) of texts in Markdown, one after the other, with the pictures they show from a folder (Path) and files (Paths).
    view: (file beside the page on which a run can be turned, the run's name), or None."""
    # slow to load, and the numbers do without them
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    environment = Environment(
        loader=FileSystemLoader(Path(__file__).parent), autoescape=True, undefined=StrictUndefined
    )
    return environment.get_template(TEMPLATE).render(
        title=title,
        parts=[_html(text, folder) for text in texts],
        files=[(file.name, _address(file)) for file in files],
        view=view,
        version=version_text(),
    )


def _html(text, folder):
    import markdown

    html = markdown.markdown(text.replace("<", "&lt;"), extensions=["tables", "sane_lists"])
    html = re.sub(r'<a href="(?!https?:)[^"]*">(.*?)</a>', r"\1", html, flags=re.DOTALL)  # the page is sent alone
    return re.sub(r'src="([^":]+)"', lambda found: f'src="{_address(folder / found[1])}"', html)


def _address(file):
    """A file as an address that holds it."""
    return f"data:{_TYPES[file.suffix]};base64,{base64.b64encode(file.read_bytes()).decode('ascii')}"
