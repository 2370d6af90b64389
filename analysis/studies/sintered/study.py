"""The study of S17's collisions."""

from ...runs.collect import Scene
from ..definition import Study
from .comparison import remarks, sections
from .measure import COLUMNS, measure
from .results import make_results

STUDY = Study(
    title="Sintered aggregates beside S17",
    question="Do sintered aggregates still grow when they collide, at which velocity do they bounce and break, and which modes break their "
    "necks (Sirono & Ueno 2017)? And does their bouncing survive the third dimension?",
    # Head-on collisions of equal aggregates of equal ice grains: BCCA ones, and those that collisions have compacted.
    scene=Scene(
        name="S17's scene",
        values={"material": "ice", "impact": 0.0, "sizes": "equal"},
        numbers=("velocity", "neck", "planar", "viscoelasticTime"),
        measured=("criticalRolling", "growth_velocity", "cut", "sliding_factor", "grains", "packing_seed"),
    ),
    columns=COLUMNS,
    measure=measure,
    results=make_results,
    sections=sections,
    remarks=remarks,
)
