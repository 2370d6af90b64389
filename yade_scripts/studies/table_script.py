"""What the scripts that write the tables of a study have in common."""

import sys


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
