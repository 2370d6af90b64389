"""The tables of the studies, which the modules beside this one make; study.py NAME writes the one it needs.

    python3 yade_scripts/studies/tables.py             write all that are not there (make tables)
    python3 yade_scripts/studies/tables.py NAME ...    write these anew

A module STUDY.py has tables(): {size: (rows, head)}; each becomes STUDY-SIZE.table in this folder.
"""

import os
import sys
from importlib import import_module

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(os.path.dirname(HERE)))
from yade_scripts.run import table

STUDIES = ("atlas", "compressed", "compression", "elastoplastic", "sintered", "viscous")


def of_study(study):
    """The tables of a study, {name: (rows, head)}; rows as yade_scripts.run.table.write() takes them."""
    found = import_module(f"yade_scripts.studies.{study}").tables()
    written_by = f"Written by yade_scripts/studies/{study}.py."
    return {f"{study}-{size}": (rows, f"{head} {written_by}") for size, (rows, head) in found.items()}


def names():
    """The names of all tables: those of the studies, and examples that no module makes."""
    made = [name for study in STUDIES for name in of_study(study)]
    there = [file.removesuffix(".table") for file in os.listdir(HERE) if file.endswith(".table")]
    return list(dict.fromkeys(made + there))


def write(name, folder=HERE):
    """Write the table of that name into a folder; its path. Raises KeyError for a name that no study has."""
    rows, head = of_study(name.partition("-")[0])[name]
    path = os.path.join(folder, f"{name}.table")
    table.write(path, rows, head)
    return path


def find(table):
    """Path of a table of this folder, by its name or path, written if it isn't there; None for any other."""
    folder, file = os.path.split(table)
    name = file.removesuffix(".table")
    path, study = os.path.join(HERE, f"{name}.table"), name.partition("-")[0]
    if folder and os.path.realpath(folder) != os.path.realpath(HERE):
        return None
    if os.path.isfile(path):
        return path
    return write(name) if study in STUDIES and name in of_study(study) else None


def main(arguments):
    known = names()
    wrong = [name for name in arguments if name not in known]
    if "--help" in arguments:
        print(__doc__)
    elif wrong:
        print(f"tables.py: {wrong[0]}: no such table; must be one of {', '.join(known)}", file=sys.stderr)
        return 2
    else:
        for name in arguments:
            write(name)
        for name in () if arguments else known:
            find(name)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
