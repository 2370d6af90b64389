"""The study of K13's compressions."""

from ...runs.collect import Scene
from ...runs.format import COMPRESSION
from ..definition import Study
from .comparison import remarks, sections
from .measure import COLUMNS, measure
from .results import make_results
from .scene import MEASURED, NUMBERS

STUDY = Study(
    question="Which pressure compresses a fluffy aggregate to a given filling factor, and on which properties of the grains does it "
    "depend? Kataoka et al. (2013, K13), Static compression of porous dust aggregates, A&A 554, A4.",
    title="Static compression of fluffy aggregates beside K13",
    # BCCA clusters in cells that shrink uniformly, without viscous drag.
    scene=Scene(
        name="K13's scene",
        values={"viscoelasticTime": 0.0, "packing": "bcca", "limit": "held"},
        numbers=NUMBERS,
        measured=MEASURED,
        kind=COMPRESSION.name,
    ),
    columns=COLUMNS,
    measure=measure,
    results=make_results,
    sections=sections,
    remarks=remarks,
)
