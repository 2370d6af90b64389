"""python3 -m analysis plot, figures, view, film, export: pictures of runs, and their states for other programs."""

import argparse
from pathlib import Path

from ..figures.grain_colours import COLOURINGS
from ..printable import printable
from . import FAILED, RUNS, add_command, complain, number, with_ending

FORMATS = "vtk", "xyz"
OPTICS = "mstm", "ddscat"  # input of codes that scatter light


def add_parsers(commands):
    """Add the commands to argparse's subparsers."""
    _add_plot(commands)
    about = "Write the figures that a run of its kind has as NAME.png, and print their paths."
    _of_one_run(commands, figures, "draw a run's figures", about, "FOLDER", "RUN/figures")
    about = "Write the saved states as one HTML file for a browser: turn, zoom, go through the states, colour by "
    about += "aggregate, material, contacts, speed, fragment or sintered bonds. RUN may be FILE.npz, a packing or a "
    about += "saved state. It needs no network. Made with three.js (Debian: libjs-three)."
    short = "write a page on which the aggregates can be turned"
    parser = _of_one_run(commands, view, short, about, "FILE", "RUN/view.html", type=with_ending(".html"))
    parser.add_argument("--three", metavar="FOLDER", help="three.js, r110 to r147 (default: Debian's)")
    about = "Write a film with a frame for each saved state. Needs ffmpeg."
    place = "FILE", "RUN/film.mp4; .gif: repeats"
    parser = _of_one_run(commands, film, "write a film of a run's states", about, *place)
    rate = number(lambda rate: 0.1 <= rate <= 120, "from 0.1 to 120")
    parser.add_argument("--rate", metavar="FRAMES", type=rate, default=10.0, help="states a second (default: 10)")
    parser.add_argument("--along", choices=tuple("xyz"), default="z", help="axis along which it is viewed (default: z)")
    parser.add_argument("--colour", choices=COLOURINGS, default="aggregate", help="of the grains (default: aggregate)")
    width = number(lambda width: 160 <= width <= 3840 and width == int(width), "a whole number from 160 to 3840")
    parser.add_argument("--width", metavar="PIXELS", type=width, default=960, help="from 160 to 3840 (default: 960)")
    _add_export(commands)


def _of_one_run(commands, command, short, about, place, default, type=Path, **more):
    """The parser of a command that writes something of one run."""
    parser = add_command(commands, command, short, about, **more)
    parser.add_argument("run", metavar="RUN", help="run folder")
    parser.add_argument("--out", metavar=place, type=type, help=f"where to (default: {default})")
    return parser


def figures(options):
    from ..figures.draw import draw_all
    from ..progress import line_beside_bars
    from ..runs.folder import open_run

    folder = open_run(options.run)
    for file in draw_all(folder, options.out or folder.path / "figures"):
        line_beside_bars(file)
    return 0


def view(options):
    from ..export.viewer import THREE, write_view

    run, place = _run_or_file(options.run, "view", ".html")
    print(printable(write_view(run, options.out or place, options.three or THREE)))
    return 0


def _run_or_file(path, name, ending=""):
    """The RunFolder of a run, or of a packing or state (.npz) alone; and where NAME is written if nothing else is
    given."""
    from ..runs.folder import open_alone, open_run

    path = Path(path)
    if path.is_file() and path.suffix == ".npz":
        return open_alone(path), path.with_name(f"{path.stem}-{name}{ending}")
    return open_run(path), path / f"{name}{ending}"


def film(options):
    from ..export.film import write_film
    from ..runs.folder import open_run

    folder, how = open_run(options.run), (options.rate, int(options.width), options.along, options.colour)
    print(printable(write_film(folder, options.out or folder.path / "film.mp4", *how)))
    return 0


def _add_plot(commands):
    parser = add_command(
        commands,
        plot,
        "draw a quantity of many runs against one of their parameters",
        "Draw sticking (fraction of the decided runs that stick), largest (mass of the largest piece), energy (where "
        "it went, by channel), or any column of analysis.table against another, with standard errors over the pairs "
        "of aggregates; write a PNG and print its path.",
    )
    parser.add_argument("what", metavar="WHAT", help="sticking, largest, energy, or a column")
    parser.add_argument("runs", nargs="+", metavar="RUNS", help=RUNS)
    parser.add_argument("--x", metavar="COLUMN", default="velocity", help="on the axis (default: velocity)")
    parser.add_argument("--by", metavar="COLUMN", default="", help="tells curves apart; panels of energy")
    parser.add_argument(
        "--where", metavar="COLUMN=VALUE", type=_condition, action="append", default=[], help="draw these runs only"
    )
    parser.add_argument("--over", metavar="COLUMN", default="", help="average over its values (impact)")
    parser.add_argument("--bins", metavar="N", type=int, default=0, help="average in so many bins of the axis")
    parser.add_argument("--log", choices=("x", "y", "xy", "none"), help="logarithmic axes (default: x over a decade)")
    parser.add_argument("--out", metavar="FILE", type=with_ending(".png"), help="the PNG (default: WHAT-COLUMN.png)")


def _condition(text):
    name, equals, value = text.partition("=")
    if not equals:
        raise argparse.ArgumentTypeError(f"{text}: must be COLUMN=VALUE")
    if value in ("True", "False"):
        return name, value == "True"
    try:
        return name, float(value)
    except ValueError:
        return name, value


def plot(options):
    from ..report.rows import frame, measure, row
    from ..runs.files import replacing
    from ..studies.plot import plot

    file = options.out or Path(f"{options.what}-{options.x}.png")
    where, logarithmic = dict(options.where), "" if options.log == "none" else options.log
    structure = any("largest_" in name for name in (options.what, options.x, options.by, options.over, *where))
    measured, problems = measure(options.runs, lambda run: row(run, structure))
    for problem in problems:
        complain(problem)
    if not measured:
        return FAILED
    figure = plot(options.what, frame(measured), options.x, options.by, where, logarithmic, options.over, options.bins)
    file.parent.mkdir(parents=True, exist_ok=True)
    with replacing(file) as out:
        figure.savefig(out, format="png", dpi=150)
    print(printable(file))
    return FAILED if problems else 0


def _add_export(commands):
    from ..export.fields import CONTACTS, GRAINS, UNITS

    about = "Write the states of a run as VTK files (run.pvd: open it in ParaView or OVITO) or as extended XYZ\n"
    about += "(run.xyz: OVITO, ASE), in SI units but for --unit.\n"
    for title, fields in (("grains (v is called velo in run.xyz)", GRAINS), ("contacts (VTK only)", CONTACTS)):
        about += f"\n{title}:"
        about += "".join(f"\n  {f.name:<13} {f.meaning}{f' [{f.unit}]' if f.unit else ''}" for f in fields)
    text, form = "write a run's states for ParaView, OVITO and others", argparse.RawDescriptionHelpFormatter
    parser = _of_one_run(commands, export, text, about, "FOLDER", "RUN/export", formatter_class=form)
    of_format = (
        "vtk (grains and contacts; default), xyz (grains, text), all (both), mstm (x y z radius), ddscat (dipoles)"
    )
    parser.add_argument("--format", choices=(*FORMATS, "all", *OPTICS), default="vtk", help=of_format)
    parser.add_argument("--state", metavar="K", type=_state, help="of the states only this one, from 0, or last")
    of_fragment = number(lambda fragment: fragment >= 0 and fragment == int(fragment), "a whole number >= 0")
    parser.add_argument("--fragment", metavar="K", type=of_fragment, help="only the grains of this fragment")
    of_unit = "of lengths in xyz, mstm and ddscat (default: m)"
    parser.add_argument("--unit", choices=tuple(UNITS), default="m", help=of_unit)


def _state(text):
    if text != "last" and not text.isdecimal():
        raise argparse.ArgumentTypeError(f"{text}: must be a whole number >= 0, or last")
    return text


def export(options):
    from ..export.formats import write_vtk, write_xyz
    from ..export.optics import chosen, write_ddscat, write_mstm

    run, place = _run_or_file(options.run, "export")
    (run, first), unit, folder = chosen(run, options.state, options.fragment), options.unit, options.out or place
    if unit != "m" and options.format in ("vtk", "all"):
        complain(f"--unit {unit}: vtk is in SI units; must be left out, or with xyz, {' or '.join(OPTICS)}")
        return FAILED
    writers = {
        "vtk": lambda: write_vtk(run, folder, first),
        "xyz": lambda: write_xyz(run, folder, unit),
        "mstm": lambda: write_mstm(run, folder, unit, first),
        "ddscat": lambda: write_ddscat(run, folder, unit, first),
    }
    for name in FORMATS if options.format == "all" else (options.format,):
        print(printable(writers[name]()), flush=True)
    return 0
