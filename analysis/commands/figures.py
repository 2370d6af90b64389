"""python3 -m analysis figures RUN [--out FOLDER]"""


def add_parser(commands):
    """Add the command to argparse's subparsers."""
    parser = commands.add_parser(
        "figures",
        help="draw a run's figures",
        description="Write motion.png (d and v against time, of equal aggregates), energy.png (the channels), grains.png (the grains, dense aggregates cut through the "
        "middle) and forces.png (contact forces); of a compression compression.png alone.",
    )
    parser.add_argument("run", metavar="RUN", help="run folder")
    parser.add_argument("--out", metavar="FOLDER", help="where to (default: RUN/figures), made if it is missing")
    parser.set_defaults(command=run)


def run(options):
    """Exit status: 0, or 2 when the run could not be read or the figures not be written."""
    # matplotlib is slow to load, and `summary` does without it.
    from ..figures.draw import draw_all
    from ..progress import line_beside_bars
    from ..runs.folder import open_run

    folder = open_run(options.run)
    for file in draw_all(folder, options.out or folder.path / "figures"):
        line_beside_bars(file)
    return 0
