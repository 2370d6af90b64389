"""A page on which a run's aggregates can be turned: one HTML file with the states and three.js in it, which needs no
network."""

import base64
import json
from pathlib import Path

import numpy as np
from jinja2 import Environment, FileSystemLoader

from ...figures.grain_colours import BONDED, COLOURINGS, SCALE, Range
from ...figures.style import run_title
from ...printable import Refused, printable
from ...progress import progress
from ...runs.files import require_output, write_file
from ..fields import exported_states

THREE = Path("/usr/share/javascript/three")  # of Debian's libjs-three
_SCRIPTS = ("build/three.min.js", "examples/js/controls/OrbitControls.js")
_HERE = Path(__file__).parent


def write_view(run, file, three=THREE):
    """Write the states of a RunFolder as a page of HTML; returns `file`.

    three: folder of three.js (r110 to r147) with build/three.min.js and examples/js/controls/OrbitControls.js.
    Refused when it lacks them, RunFolderError when a state is damaged or there is none, OSError."""
    require_output(file)
    scripts = _scripts(Path(three))
    page = Environment(loader=FileSystemLoader(_HERE), autoescape=True).get_template("page.html")
    data = json.dumps(_data(run)).replace("<", "\\u003c")  # no text in it can end the script
    viewer = (_HERE / "viewer.js").read_text(encoding="utf-8")
    head = {"title": printable(run.path.resolve().name), "ways": COLOURINGS, "chosen": _first_colouring(run.start)}
    write_file(file, page.render(**head, scripts=scripts, data=data, viewer=viewer))
    return file


def _scripts(three):
    try:
        return [(three / name).read_text(encoding="utf-8") for name in _SCRIPTS]
    except OSError as error:
        need = "three.js must be there (apt-get install libjs-three, or --three FOLDER)"
        raise Refused(f"{error.filename}: {error.strerror}; {need}") from None


def _first_colouring(state):
    """That by aggregate, and by material where there is one aggregate of several."""
    several = state.material is not None and np.ptp(state.material) > 0 and np.ptp(state.aggregate) == 0
    return "material" if several else "aggregate"


def _data(run):
    """What the page shows, for JSON: arrays in base64, little-endian. Lengths in grain radii about the middle of the
    start."""
    first = run.start
    unit, cell = float(first.radius.max()), first.cell_size
    origin = (first.position.min(axis=0) + first.position.max(axis=0)) / 2 if cell is None else cell / 2
    of = Range(run)
    states = progress(exported_states(run), "reading states", len(run.states))
    return {
        "title": run_title(run),
        "unit": unit,
        "radius": _packed(first.radius / unit, "<f4"),
        "legends": {name: way.legend(of) for name, way in COLOURINGS.items()},
        "scale": SCALE,
        "bond": BONDED,
        "states": [_state(exported, of, origin, unit) for exported in states],
    }


def _state(exported, of, origin, unit):
    state = exported.state
    planes = [] if state.plane_axis is None else zip(state.plane_axis, state.plane_position)
    return {
        "time": state.time,
        "position": _packed((exported.inside() - origin) / unit, "<f4"),
        "colours": {name: _packed(np.round(255 * way.colours(exported, of)), "u1") for name, way in COLOURINGS.items()},
        "first": _packed(exported.first, "<u4"),
        "between": _packed(exported.between / unit, "<f4"),
        "bonded": _packed(state.contact_bonded, "u1"),
        "planes": [[int(axis), float((place - origin[axis]) / unit)] for axis, place in planes],
        "cell": None
        if state.cell_size is None or state.cell_vectors is not None
        else [(state.cell_size / unit).tolist(), (-origin / unit).tolist()],
    }


def _packed(array, kind):
    return base64.b64encode(np.ascontiguousarray(array, dtype=kind).tobytes()).decode()
