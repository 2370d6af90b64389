"""What studies answer as JSON."""

import json

from analysis.__main__ import main


def answered(capsys, study, *arguments):
    """({quantity: row}, number of runs that count, what is said of others) of folders or tables of runs."""
    assert main(["study", str(study), *map(str, arguments), "--json"]) == 0
    out, err = capsys.readouterr()
    answer = json.loads(out)
    return {row["quantity"]: row for row in answer["rows"]}, answer["runs"], err
