"""What studies answer as JSON."""

import json

from analysis.__main__ import main
from analysis.studies.runs import alike


def quantities(text):
    """{quantity: [row]} of a comparison.json."""
    return {name: own["rows"] for name, own in json.loads(text)["quantities"].items()}


def answered(capsys, study, folder):
    """({quantity: [row]}, number of runs that count, what is said of others) of a folder or table of runs."""
    assert main(["study", str(study), str(folder), "--json"]) == 0
    out, err = capsys.readouterr()
    return quantities(out), json.loads(out)["provenance"]["runs"], err


def rows(found, **where):
    """Those with these values."""
    return [row for row in found if all(alike([row[name]], value)[0] for name, value in where.items())]
