"""From a report to the text of its page."""

import base64
from pathlib import Path

from ...runs.provenance import provenance_lines
from ...version import version_text
from .reading import CHANCE, COARSE, DIFFERS, FEWEST_SEEDS, VERDICTS, count, reading

TEMPLATE = "page.html"
_TYPES = {".png": "image/png", ".csv": "text/csv", ".json": "application/json", ".svg": "image/svg+xml"}
READING = "reading"


def page(report, figures, files, commands, gallery=None):
    """The page (str) of a section.Report. figures: (Path, caption) pairs of pictures, and files: Paths, both put into
    the page; commands: lines that say how to make all of it again; gallery: of gallery_reading()."""
    # slow to load, and the other formats do without it
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    environment = Environment(
        loader=FileSystemLoader(Path(__file__).parent),
        autoescape=True,
        trim_blocks=True,
        lstrip_blocks=True,
        undefined=StrictUndefined,
    )
    found = count([record for section in report.sections for record in section.records], report.seeds)
    return environment.get_template(TEMPLATE).render(
        report=report,
        sections=[_section(section, report.seeds) for section in report.sections],
        figures=[(data_address(file), caption) for file, caption in figures],
        files=[(file.name, data_address(file)) for file in files],
        counts=[(found[verdict], verdict) for verdict in VERDICTS],
        compared=sum(found.values()),
        rules={"differs": DIFFERS, "chance": CHANCE, "coarse": COARSE, "fewest": FEWEST_SEEDS},
        commands=commands,
        provenance=list(provenance_lines(report.provenance)),
        gallery=gallery,
        version=version_text(),
    )


def data_address(file):
    """A file as an address that holds it."""
    content = base64.b64encode(file.read_bytes()).decode("ascii")
    return f"data:{_TYPES[file.suffix]};base64,{content}"


def _section(section, seeds):
    """What the template needs of a Section: heading, intro, notes, head, rows of cells, and a reading beside the paper."""
    head, *rows = section.rows(long=True) if section.columns else [()]
    read = any("combined_difference" in record for record in section.records)
    if read:
        verdicts = [reading(record, seeds) for record in section.records]
        head = (*head, READING)
        rows = [(*row, f"{verdict}: {why}" if why else "") for row, (verdict, why) in zip(rows, verdicts, strict=True)]
    return {
        "heading": section.heading[0].upper() + section.heading[1:],
        "intro": section.intro,
        "head": head,
        "rows": rows,
        "read": read,
        "notes": section.notes,
    }
