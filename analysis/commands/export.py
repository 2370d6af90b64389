"""python3 -m analysis export RUN [--format vtk | xyz | all] [--out FOLDER]"""

import argparse

from ..printable import printable

FORMATS = ("vtk", "xyz")


def add_parser(commands):
    """Add the command to argparse's subparsers."""
    parser = commands.add_parser(
        "export",
        help="write a run's states for ParaView, OVITO and others",
        formatter_class=argparse.RawDescriptionHelpFormatter,
        description="Write the states of a run as VTK files (run.pvd: open it in ParaView or OVITO) or as extended XYZ\n"
        "(run.xyz: OVITO, ASE), in SI units.\n\n" + _fields_text(),
    )
    parser.add_argument("run", metavar="RUN", help="run folder")
    parser.add_argument(
        "--format",
        choices=(*FORMATS, "all"),
        default="vtk",
        help="vtk (grains and contacts), xyz (grains in one file of text) or all; default: vtk",
    )
    parser.add_argument("--out", metavar="FOLDER", help="where to (default: RUN/export), made if it is missing")
    parser.set_defaults(command=run)


def run(options):
    """Exit status: 0, or 2 when the run could not be read or the files not be written."""
    from pathlib import Path

    from ..export.extended_xyz import write_xyz
    from ..export.vtk_series import write_vtk
    from ..runs.folder import open_run

    writers = dict(zip(FORMATS, (write_vtk, write_xyz), strict=True))
    folder = open_run(options.run)
    out = Path(options.out) if options.out else folder.path / "export"
    for name in FORMATS if options.format == "all" else (options.format,):
        print(printable(writers[name](folder, out)), flush=True)
    return 0


def _fields_text():
    from ..export.fields import CONTACTS, GRAINS

    lines = []
    for title, fields in (("grains (v is called velo in run.xyz)", GRAINS), ("contacts (VTK only)", CONTACTS)):
        lines += [f"{title}:"]
        lines += [f"  {f.name:<13} {f.meaning}{f' [{f.unit}]' if f.unit else ''}" for f in fields]
    return "\n".join(lines)
