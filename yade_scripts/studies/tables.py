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
from analysis.printable import meant
from yade_scripts.parameters import InputError
from yade_scripts.run.table import write as write_table

EXAMPLES = ("demo", "seeds")  # which no module makes


def of_studies():
    """{name: (rows, head, study)} of all tables; rows as yade_scripts.run.table.write() takes them."""
    from analysis.studies.study import NAMES  # loads pandas, which no table that is there needs

    tables_of = {study: import_module(f"yade_scripts.studies.{study}").tables() for study in NAMES}
    return {f"{study}-{size}": (*made, study) for study, tables in tables_of.items() for size, made in tables.items()}


def write(name, folder=HERE):
    """Write the table of that name into a folder; its path. Raises KeyError for a name that no study has."""
    rows, head, study = of_studies()[name]
    path = os.path.join(folder, f"{name}.table")
    write_table(path, rows, f"{head} Written by yade_scripts/studies/{study}.py.")
    return path


def find(table):
    """Path of a table of this folder, by its name or path, written if it isn't there. Raises InputError for others."""
    folder, file = os.path.split(table)
    name = file.removesuffix(".table")
    path = os.path.join(HERE, f"{name}.table")
    if not folder or os.path.realpath(folder) == os.path.realpath(HERE):
        if os.path.isfile(path):
            return path
        if name in of_studies():
            return write(name)
    raise InputError(f"{table}: no such file, nor table{meant(name, [*of_studies(), *EXAMPLES])}; must be one")


def main(arguments):
    wrong = [name for name in arguments if name not in of_studies()]
    if "--help" in arguments:
        print(__doc__)
    elif wrong:
        sys.exit(f"tables.py: {wrong[0]}: no such table; must be one of {', '.join(of_studies())}")
    else:
        for name in arguments:
            write(name)
        for name in () if arguments else of_studies():
            find(name)


if __name__ == "__main__":
    main(sys.argv[1:])
