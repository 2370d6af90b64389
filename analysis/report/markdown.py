"""A report as a page of Markdown."""

from ..runs.provenance import provenance_lines


def markdown(report, figures=()):
    """The whole section.Report (str) with figures: (file name, caption) pairs."""
    lines = (*provenance_lines(report.provenance), *report.remarks, *report.notes)
    parts = [f"# {report.title}", "", *(f"- {line}" for line in lines)]
    for section in report.sections:
        parts += ["", f"## {section.heading[0].upper()}{section.heading[1:]}", ""]
        if section.intro:
            parts += [section.intro, ""]
        parts += _table(section)
        if section.notes:
            parts += [""] * bool(section.columns) + [f"- {note}" for note in section.notes]
    for name, caption in figures:
        parts += ["", f"![{caption}]({name})", "", caption]
    return "\n".join(parts) + "\n"


def _table(section):
    if not section.columns:
        return []
    rows = [" | ".join(cell.replace("|", "\\|") for cell in row) for row in section.rows(long=True)]
    rule = "|" + "---|" * len(section.columns)
    return [f"| {rows[0]} |", rule, *(f"| {row} |" for row in rows[1:])]
