"""What the scripts that write the tables of a study have in common."""

import os
import sys

from yade_scripts.run import table


def write(folder, study, head, tables):
    """Write STUDY-SIZE.table of each of {size: (rows, what it is)} into a folder; head: lines for all, in which {which} is what one is."""
    for size, (rows, which) in tables.items():
        lines = f"{head.format(which=which)} Written by yade_scripts/studies/{study}.py."
        table.write(os.path.join(folder, f"{study}-{size}.table"), rows, lines)


def main(write_tables, folder, description):
    """Write a study's tables (write_tables(folder)) as its script does: without arguments. --help prints the description; others are
    refused, exit status 2."""
    arguments = sys.argv[1:]
    if "--help" in arguments:
        print(description)
    elif arguments:
        print(f"{arguments[0]}: takes no arguments but --help", file=sys.stderr)
        sys.exit(2)
    else:
        write_tables(folder)
