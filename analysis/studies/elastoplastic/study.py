"""The study of A24's collisions."""

from ...runs.collect import Scene
from ..definition import Study
from .comparison import remarks, sections
from .measure import COLUMNS, measure
from .results import make_results

STUDY = Study(
    title="Elastoplastic collisions beside A24",
    # Head-on collisions of CPE aggregates, without drag and bonds.
    scene=Scene(
        name="A24's scene",
        values={
            "packing": "cpe",
            "impact": 0.0,
            "viscoelasticTime": 0.0,
            "neck": 0.0,
            "planar": 0,
            "material": "ice",
        },
        numbers=("filling", "radius", "velocity", "seed"),
    ),
    columns=COLUMNS,
    measure=measure,
    results=make_results,
    sections=sections,
    remarks=remarks,
)
