"""A report for a terminal."""

import textwrap

from ..runs.provenance import provenance_lines


def text(report):
    """The whole section.Report (str)."""
    parts = list(provenance_lines(report.provenance))
    for section in report.sections:
        parts += ["", section.heading]
        parts += textwrap.wrap(section.intro, 120, initial_indent="  ", subsequent_indent="  ")
        parts += _table(section)
        parts += section.notes
    parts += ["", *report.remarks] if report.remarks else []
    return "\n".join(parts)


def _table(section):
    if not section.columns:
        return
    rows = list(section.rows())
    beside = [i for i, column in enumerate(section.columns) if column.beside]
    shown = [i for i in range(len(section.columns)) if i not in beside]
    widths = {i: max(len(row[i]) for row in rows) for i in shown}
    for number, row in enumerate(rows):
        # The first column to the left where it is the name of the row, as in tables with remarks.
        cells = [row[i].ljust(widths[i]) if beside and i == shown[0] else row[i].rjust(widths[i]) for i in shown]
        remark = "".join(f"   [{row[i]}]" for i in beside if row[i] and number)
        yield "  " + "  ".join(cells).rstrip() + remark
