"""Run by a Python that has ovito: FILE... -> JSON, for each file a list of frames {object: {property: values}}."""

import json
import sys

from ovito.io import import_file


def frames(file):
    pipeline = import_file(file)
    for number in range(pipeline.source.num_frames):
        data = pipeline.compute(number)
        found = {"time": data.attributes.get("Time"), "cell": None if data.cell is None else data.cell[...].tolist()}
        found["grains"] = {name: array[...].tolist() for name, array in (data.particles or {}).items()}
        lines = dict(data.lines.items()).get("particle-particle-contacts", {})
        yield {**found, "contacts": {name: array[...].tolist() for name, array in lines.items()}}


print(json.dumps({file: list(frames(file)) for file in sys.argv[1:]}))
