"""A report for JSON."""

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
