"""A report for JSON."""

import json
import math


def data(report):
    """The whole section.Report (dict; null for what does not exist or is not finite)."""
    sections = [{"heading": s.heading, "rows": plain(s.records)} for s in report.sections if s.columns]
    return {
        "study": report.study,
        "title": report.title,
        "provenance": report.provenance,
        "notes": list(report.notes),
        "remarks": list(report.remarks),
        "sections": sections,
    }


def plain(value):
    """The value as JSON can hold it: numpy's numbers as Python's, null for NaN and infinity."""
    if isinstance(value, dict):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, (tuple, list)):
        return [plain(item) for item in value]
    if hasattr(value, "item"):
        value = value.item()
    return None if isinstance(value, float) and not math.isfinite(value) else value


def json_text(report):
    """data(report) as a JSON file (str) with one line a row of a table."""
    content = data(report)
    sections = [
        '  {"heading": ' + json.dumps(section["heading"]) + ', "rows": [\n' + _lines(section["rows"], "   ") + "\n  ]}"
        for section in content.pop("sections")
    ]
    head = json.dumps(content, indent=1, allow_nan=False).rstrip("\n}")
    return head + ',\n "sections": [\n' + ",\n".join(sections) + "\n ]\n}\n"


def _lines(rows, margin):
    return ",\n".join(margin + json.dumps(row, allow_nan=False) for row in rows)
