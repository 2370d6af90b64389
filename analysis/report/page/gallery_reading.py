"""What the gallery says of a study: its README as a part of the page."""

import json
import re

README, DATA = "README.md", "comparison.json"


def gallery_reading(folder, provenance):
    """(html, of_these_runs) of a gallery's folder (Path): its README without title, and whether it was written of runs with
    this provenance; None where there is none. Links to files beside it are left as words: the page is sent alone."""
    file = folder / README
    if not file.is_file():
        return None
    # slow to load, and the numbers do without it
    import markdown

    text = re.sub(r"\A# .*\n", "", file.read_text(encoding="utf-8")).replace("<", "&lt;")
    html = markdown.markdown(text, extensions=["tables", "sane_lists"])
    html = re.sub(r"<(/?)h([1-5])>", lambda tag: f"<{tag[1]}h{int(tag[2]) + 1}>", html)  # below the page's own
    html = re.sub(r'<a href="(?!https?:)[^"]*">(.*?)</a>', r"\1", html, flags=re.DOTALL)
    html = re.sub(r"<img [^>]*>", "", html)
    return html, _provenance(folder / DATA) == provenance


def _provenance(file):
    try:
        return json.loads(file.read_text(encoding="utf-8")).get("provenance")
    except (OSError, ValueError, AttributeError):
        return None
